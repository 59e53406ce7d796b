//! An eye is one camera of the pair, at the finer size at which pictures are rendered.

use crate::vector::{V3, v3};
use furrow_model::{Se3, StereoRig};

/// Rendered pixels per finished pixel, along each side, as a fraction.
pub const FINER: (u32, u32) = (3, 2);

/// One camera of the pair, at the finer size at which it is rendered.
#[derive(Debug, Clone)]
pub struct Eye {
    /// Fine columns.
    pub width: u32,
    /// Fine rows.
    pub height: u32,
    /// Fine focal length in pixels.
    pub focal: f32,
    /// Position in the world.
    pub position: V3,
    /// The camera's axes in the world.
    pub right: V3,
    /// Down.
    pub down: V3,
    /// Forward.
    pub forward: V3,
    /// When.
    pub time_s: f32,
    /// d.x = x0 + column * step.
    pub x0: f32,
    /// d.y = y0 + row * step.
    pub y0: f32,
    /// Change of d per fine pixel.
    pub step: f32,
}

impl Eye {
    /// The camera `shift_m` to the right of the left one. Pixel centres are integers at the finished size.
    pub fn new(rig: &StereoRig, world_from_left: &Se3, shift_m: f64, time_s: f32) -> Eye {
        let finer = f64::from(FINER.0) / f64::from(FINER.1);
        let r = &world_from_left.rotation;
        let axis = |k: usize| v3(r[0][k] as f32, r[1][k] as f32, r[2][k] as f32);
        // The centre of fine pixel j lies at (j + 0.5) / finer - 0.5.
        let first = 0.5 / finer - 0.5;
        Eye {
            width: rig.width * FINER.0 / FINER.1,
            height: rig.height * FINER.0 / FINER.1,
            focal: (rig.focal_px * finer) as f32,
            position: single(world_from_left.apply([shift_m, 0.0, 0.0])),
            right: axis(0),
            down: axis(1),
            forward: axis(2),
            time_s,
            x0: ((first - rig.cu_px) / rig.focal_px) as f32,
            y0: ((first - rig.cv_px) / rig.focal_px) as f32,
            step: (1.0 / (rig.focal_px * finer)) as f32,
        }
    }

    /// A world vector in camera axes.
    #[inline(always)]
    pub fn seen(&self, v: V3) -> V3 {
        v3(self.right.dot(v), self.down.dot(v), self.forward.dot(v))
    }

    /// The world direction of a camera vector.
    #[inline(always)]
    pub fn shown(&self, v: V3) -> V3 {
        self.right * v.x + self.down * v.y + self.forward * v.z
    }

    /// From the eye through a place in fine pixels, one metre ahead.
    #[inline(always)]
    pub fn away(&self, x: f32, y: f32) -> V3 {
        self.shown(v3(self.x0 + self.step * x, self.y0 + self.step * y, 1.0))
    }
}

/// A linear form over the fine pixels: constant, per column, per row.
#[derive(Debug, Clone, Copy)]
pub struct Form {
    /// At column 0, row 0.
    pub base: f32,
    /// Per column.
    pub dx: f32,
    /// Per row.
    pub dy: f32,
}

impl Form {
    /// Its value at a place in fine pixels.
    #[inline(always)]
    pub fn at(&self, x: f32, y: f32) -> f32 {
        self.base + self.dx * x + self.dy * y
    }
}

/// The point of an `[f64; 3]` as single precision.
fn single(p: [f64; 3]) -> V3 {
    v3(p[0] as f32, p[1] as f32, p[2] as f32)
}
