//! Images for the unit tests.

use furrow_model::GreyImage;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// White noise.
pub(crate) fn noise(width: usize, height: usize, seed: u64) -> GreyImage {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let pixels = (0..width * height).map(|_| rng.next_u32() as u8).collect();
    GreyImage { width, height, pixels }
}
