//! Motions of eight triples.

use super::lanes::Lanes;
use furrow_model::Se3;

/// A motion of each triple; see [`Se3`].
pub(super) struct Motions {
    rotation: [[Lanes; 3]; 3],
    translation_m: [Lanes; 3],
}

impl Motions {
    /// The same motion in all lanes.
    pub fn all(motion: &Se3) -> Self {
        Self {
            rotation: motion.rotation.map(|row| row.map(Lanes::all)),
            translation_m: motion.translation_m.map(Lanes::all),
        }
    }

    /// The motion of one lane.
    #[inline]
    pub fn lane(&self, lane: usize) -> Se3 {
        Se3 {
            rotation: self.rotation.map(|row| row.map(|value| value.0[lane])),
            translation_m: self.translation_m.map(|value| value.0[lane]),
        }
    }

    /// As [`motion_from_step`](crate::se3::motion_from_step).
    #[inline(always)]
    pub fn from_steps(step: &[Lanes; 6]) -> Self {
        let (one, two) = (Lanes::all(1.0), Lanes::all(2.0));
        let [x, y, z] = [step[0] / two, step[1] / two, step[2] / two];
        let norm = (x * x + y * y + z * z + one).sqrt();
        let [x, y, z, w] = [x / norm, y / norm, z / norm, one / norm];
        let rotation = [
            [one - two * (y * y + z * z), two * (x * y - z * w), two * (x * z + y * w)],
            [two * (x * y + z * w), one - two * (x * x + z * z), two * (y * z - x * w)],
            [two * (x * z - y * w), two * (y * z + x * w), one - two * (x * x + y * y)],
        ];
        Self { rotation, translation_m: [step[3], step[4], step[5]] }
    }

    /// As [`Se3::apply`].
    #[inline(always)]
    pub fn apply(&self, [x, y, z]: [Lanes; 3]) -> [Lanes; 3] {
        let row = |i: usize| {
            let [a, b, c] = self.rotation[i];
            a * x + b * y + c * z + self.translation_m[i]
        };
        [row(0), row(1), row(2)]
    }

    /// As [`Se3::compose`].
    #[inline(always)]
    pub fn compose(&self, other: &Self) -> Self {
        let column = |j: usize| other.rotation.map(|row| row[j]);
        let turned = |row: [Lanes; 3], [x, y, z]: [Lanes; 3]| row[0] * x + row[1] * y + row[2] * z;
        let rotation =
            self.rotation.map(|row| [turned(row, column(0)), turned(row, column(1)), turned(row, column(2))]);
        Self { rotation, translation_m: self.apply(other.translation_m) }
    }
}
