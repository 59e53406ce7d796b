//! The optional `sensor` stage: the camera's noise in both domains, and an image's noise moved towards the target's.

use crate::chance::bell;
use furrow_model::ColourImage;
use serde::{Deserialize, Serialize};

/// Noise in both domains: standard deviations in grey levels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Of the source's camera.
    pub source: f64,
    /// Of the target's.
    pub target: f64,
}

impl Noise {
    pub(crate) fn between(source: &NoiseCounts, target: &NoiseCounts) -> Self {
        Self { source: source.deviation(), target: target.deviation() }
    }

    /// Where the target has less noise: what the finest band is multiplied by at `reach` = z times strength.
    pub(crate) fn finest_gain(&self, reach: f64) -> f32 {
        if self.target < self.source {
            (1.0 - reach * (1.0 - self.target / self.source)).clamp(0.0, 2.0) as f32
        } else {
            1.0
        }
    }

    /// Where the target has more noise: the deviation of what is added at `reach`.
    pub(crate) fn added(&self, reach: f64) -> f64 {
        reach.max(0.0) * (self.target * self.target - self.source * self.source).max(0.0).sqrt()
    }
}

/// Adds noise of this deviation to every value, the same for the same seed.
pub(crate) fn add_noise(rgb: &mut [u8], deviation: f64, seed: u64) {
    let deviation = deviation as f32;
    for (place, value) in (0..).zip(rgb) {
        *value = (f32::from(*value) + deviation * bell(seed, place) + 0.5).clamp(0.0, 255.0) as u8;
    }
}

/// Differences counted: larger ones are edges, whatever they are.
const STEPS: usize = 128;

/// How often each size of a diagonal difference a - b - c + d of neighbouring greens occurred. Textures and edges are
/// few among them, so their median tells the noise (Donoho and Johnstone 1994).
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct NoiseCounts([u64; STEPS]);

impl Default for NoiseCounts {
    fn default() -> Self {
        Self([0; STEPS])
    }
}

impl NoiseCounts {
    pub fn count(&mut self, image: &ColourImage) {
        let rows: Vec<&[u8]> = image.rgb.chunks_exact(3 * image.width).collect();
        for pair in rows.as_chunks::<2>().0 {
            let [above, below] = pair;
            for (top, bottom) in above.as_chunks::<6>().0.iter().zip(below.as_chunks::<6>().0) {
                let [a, b, c, d] = [top[1], top[4], bottom[1], bottom[4]].map(i32::from);
                let difference = (a - b - c + d).unsigned_abs() as usize;
                self.0[difference.min(STEPS - 1)] += 1;
            }
        }
    }

    pub fn merge(&mut self, other: &Self) {
        self.0.iter_mut().zip(other.0).for_each(|(count, other)| *count += other);
    }

    /// The noise of one value: a difference of four has twice its deviation, and the median of a normal size is 0.6745
    /// deviations.
    fn deviation(&self) -> f64 {
        let half = self.0.iter().sum::<u64>() as f64 / 2.0;
        let mut below = 0.0;
        for (size, count) in self.0.iter().enumerate() {
            let count = *count as f64;
            if count > 0.0 && below + count >= half {
                // Sizes spread over their step: 0 over [0, 0.5), 1 over [0.5, 1.5) ...
                let (low, width) = if size == 0 { (0.0, 0.5) } else { (size as f64 - 0.5, 1.0) };
                return (low + width * (half - below) / count) / 2.0 / 0.6745;
            }
            below += count;
        }
        0.0
    }
}
