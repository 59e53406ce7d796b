//! Vectors of three `f32`: enough for a scene of some hundred metres (the step is under 0.01 mm there).

use std::ops::{Add, AddAssign, Mul, Neg, Sub};

/// A point or direction in metres; the frame is named where it is used.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct V3 {
    /// East, or the camera's right.
    pub x: f32,
    /// North, or the camera's down.
    pub y: f32,
    /// Up, or the camera's forward.
    pub z: f32,
}

/// The vector (x, y, z).
#[inline(always)]
pub const fn v3(x: f32, y: f32, z: f32) -> V3 {
    V3 { x, y, z }
}

impl V3 {
    /// Straight up in the world.
    pub const UP: V3 = v3(0.0, 0.0, 1.0);

    /// The inner product.
    #[inline(always)]
    pub fn dot(self, o: V3) -> f32 {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// The vector product.
    #[inline(always)]
    pub fn cross(self, o: V3) -> V3 {
        v3(self.y * o.z - self.z * o.y, self.z * o.x - self.x * o.z, self.x * o.y - self.y * o.x)
    }

    /// The length.
    #[inline(always)]
    pub fn length(self) -> f32 {
        self.dot(self).sqrt()
    }

    /// The direction at length 1; straight up for a vector without direction.
    #[inline(always)]
    pub fn unit(self) -> V3 {
        let square = self.dot(self);
        if square > 1e-20 { self * (1.0 / square.sqrt()) } else { V3::UP }
    }

    /// Component by component product, as for colours.
    #[inline(always)]
    pub fn times(self, o: V3) -> V3 {
        v3(self.x * o.x, self.y * o.y, self.z * o.z)
    }

    /// `self` at 0, `o` at 1.
    #[inline(always)]
    pub fn mix(self, o: V3, share: f32) -> V3 {
        self + (o - self) * share
    }

    /// The vector turned about the vertical axis by the angle with this cosine and sine.
    #[inline(always)]
    pub fn turned(self, (cos, sin): (f32, f32)) -> V3 {
        v3(cos * self.x - sin * self.y, sin * self.x + cos * self.y, self.z)
    }

    /// The components.
    pub fn array(self) -> [f32; 3] {
        [self.x, self.y, self.z]
    }
}

impl Add for V3 {
    type Output = V3;
    #[inline(always)]
    fn add(self, o: V3) -> V3 {
        v3(self.x + o.x, self.y + o.y, self.z + o.z)
    }
}

impl AddAssign for V3 {
    #[inline(always)]
    fn add_assign(&mut self, o: V3) {
        *self = *self + o;
    }
}

impl Sub for V3 {
    type Output = V3;
    #[inline(always)]
    fn sub(self, o: V3) -> V3 {
        v3(self.x - o.x, self.y - o.y, self.z - o.z)
    }
}

impl Neg for V3 {
    type Output = V3;
    #[inline(always)]
    fn neg(self) -> V3 {
        v3(-self.x, -self.y, -self.z)
    }
}

impl Mul<f32> for V3 {
    type Output = V3;
    #[inline(always)]
    fn mul(self, k: f32) -> V3 {
        v3(self.x * k, self.y * k, self.z * k)
    }
}

/// The cosine and sine of an angle in radians, the same bits on every machine.
pub fn cos_sin(angle_rad: f32) -> (f32, f32) {
    (libm::cosf(angle_rad), libm::sinf(angle_rad))
}

/// The integer at or below `x`, modulo 2^22; any number where `x` is out of the range +-2^22. Unlike a cast, which
/// looks for such numbers, it becomes a few vector instructions in a loop.
#[inline(always)]
pub fn whole(x: f32) -> u32 {
    // Steps of 1 between the floats of this size: the low bits of the sum are those of the integer.
    (x.floor() + 12_582_912.0).to_bits() & 0x3f_ffff
}

/// 0 below `from`, 1 above `to`, smooth between.
#[inline(always)]
pub fn smoothstep(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
