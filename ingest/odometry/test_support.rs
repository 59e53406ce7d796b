//! Random images and numbers for the unit tests.

use furrow_model::GreyImage;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// White noise.
pub(crate) fn noise_image(width: usize, height: usize, seed: u64) -> GreyImage {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let pixels = (0..width * height).map(|_| rng.next_u32() as u8).collect();
    GreyImage { width, height, pixels }
}

/// A uniformly distributed number.
pub(crate) fn uniform(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * f64::from(rng.next_u32()) / f64::from(u32::MAX)
}
