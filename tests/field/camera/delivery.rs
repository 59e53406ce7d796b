//! From the shutter to the recording: what the stamps say, and which images get lost on the way.

use super::settings::CameraSettings;
use crate::chance::{Dice, derive};
use crate::traversal::Traversal;

/// Standard deviation of the right stamps' tremble in milliseconds, where the eyes are stamped apart.
const TREMBLE_MS: f64 = 0.2;

/// The clock and the cable of one traversal's camera.
#[derive(Debug, Clone)]
pub struct Delivery {
    settings: CameraSettings,
    start_ns: i64,
    seed: u64,
}

impl Delivery {
    /// Of the camera of `traversal`.
    pub fn of(traversal: &Traversal) -> Delivery {
        Delivery {
            settings: traversal.camera,
            start_ns: traversal.start_ns(),
            seed: derive(traversal.traversal_seed(), 8),
        }
    }

    fn elapsed_ns(&self, index: u64) -> f64 {
        index as f64 * 1e9 / self.settings.rate_hz
    }

    /// When frame `index` is taken: nanoseconds of true time since 1970, UTC. Both eyes expose at once; this is their
    /// middle.
    pub fn true_ns(&self, index: u64) -> i64 {
        self.start_ns + self.elapsed_ns(index) as i64
    }

    /// The stamps of the left and the right image of frame `index`: nanoseconds since 1970 by the camera's own clock.
    pub fn stamps_ns(&self, index: u64) -> [i64; 2] {
        let left = self.start_ns + (self.elapsed_ns(index) * (1.0 + 1e-6 * self.settings.clock_skew_ppm)) as i64;
        if self.settings.clock_offset_ms == 0.0 {
            return [left; 2];
        }
        let tremble_ms = TREMBLE_MS * f64::from(Dice::of(derive(self.seed, 1), index).normal());
        [left, left + ((self.settings.clock_offset_ms + tremble_ms) * 1e6) as i64]
    }

    /// Whether the left and the right image of frame `index` reach the recording. Of the frames that lose something,
    /// half lose both images, a quarter the left, a quarter the right. A recording begins with a pair.
    pub fn arrives(&self, index: u64) -> [bool; 2] {
        let mut dice = Dice::of(derive(self.seed, 2), index);
        if index == 0 || f64::from(dice.unit()) >= self.settings.dropped {
            return [true; 2];
        }
        [[false, false], [false, false], [false, true], [true, false]][dice.below(4)]
    }
}
