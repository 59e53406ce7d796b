//! Numbers and vectors of many points at once: loops over them, without branches, become vector instructions.

use crate::vector::{V3, v3};

/// Points worked on at once.
pub const LANES: usize = 64;

/// A number of each point.
pub type Lanes = [f32; LANES];

/// A vector of each point.
#[derive(Clone)]
pub struct Vectors {
    /// First components.
    pub x: Lanes,
    /// Second components.
    pub y: Lanes,
    /// Third components.
    pub z: Lanes,
}

impl Vectors {
    /// Zero for all points.
    pub const ZERO: Vectors = Vectors { x: [0.0; LANES], y: [0.0; LANES], z: [0.0; LANES] };

    /// The vector of a point.
    #[inline(always)]
    pub fn at(&self, lane: usize) -> V3 {
        v3(self.x[lane], self.y[lane], self.z[lane])
    }

    /// Sets the vector of a point.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, v: V3) {
        (self.x[lane], self.y[lane], self.z[lane]) = (v.x, v.y, v.z);
    }
}

/// Eight bytes of each point, as they are stored in cells and texels.
pub struct Octets {
    low: [u32; LANES],
    high: [u32; LANES],
}

impl Octets {
    /// Zeros for all points.
    pub const ZERO: Octets = Octets { low: [0; LANES], high: [0; LANES] };

    /// Sets the bytes of a point, the first one lowest.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, bytes: u64) {
        (self.low[lane], self.high[lane]) = (bytes as u32, (bytes >> 32) as u32);
    }

    /// Byte number `byte` of a point.
    #[inline(always)]
    pub fn at(&self, byte: usize, lane: usize) -> f32 {
        let four = if byte < 4 { self.low[lane] } else { self.high[lane] };
        (four >> (8 * (byte % 4)) & 255) as i32 as f32
    }
}
