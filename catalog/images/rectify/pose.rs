//! Where one camera sits as seen from another.

use crate::images::matrix::{IDENTITY, product};

/// R times its transpose may differ from the identity by this much.
const ROTATION_TOLERANCE: f64 = 1e-2;

/// A rigid transform: x' = rotation · x + translation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// 3x3 by rows.
    pub rotation: [f64; 9],
    /// Metres.
    pub translation: [f64; 3],
}

impl Pose {
    /// The transform that moves nothing.
    pub const IDENTITY: Self = Self { rotation: IDENTITY, translation: [0.0; 3] };

    /// Whether the numbers are finite and the rotation rotates: no reflection, no scale.
    pub fn is_rigid(&self) -> bool {
        let r = &self.rotation;
        let error = product(r, &transposed(r)).iter().zip(IDENTITY).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        let determinant = r[0] * (r[4] * r[8] - r[5] * r[7]) - r[1] * (r[3] * r[8] - r[5] * r[6])
            + r[2] * (r[3] * r[7] - r[4] * r[6]);
        let finite = r.iter().chain(&self.translation).all(|value| value.is_finite());
        finite && error <= ROTATION_TOLERANCE && determinant > 0.0
    }

    /// First `before`, then this.
    pub fn after(&self, before: &Self) -> Self {
        let moved = rotated(&self.rotation, before.translation);
        Self {
            rotation: product(&self.rotation, &before.rotation),
            translation: std::array::from_fn(|i| moved[i] + self.translation[i]),
        }
    }

    /// The way back.
    pub fn inverse(&self) -> Self {
        let rotation = transposed(&self.rotation);
        Self { rotation, translation: rotated(&rotation, self.translation).map(|value| 0.0 - value) }
    }
}

/// m · v.
pub fn rotated(m: &[f64; 9], v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|row| (0..3).map(|i| m[3 * row + i] * v[i]).sum())
}

/// The transpose, which is a rotation's inverse.
pub fn transposed(m: &[f64; 9]) -> [f64; 9] {
    std::array::from_fn(|i| m[i % 3 * 3 + i / 3])
}
