//! The localiser against brute force.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod chow_liu;
mod codebook;
mod fabmap;
mod hub;
mod recognisers;
mod vocabulary;

use furrow_localiser::Presence;
use furrow_localiser::vocabulary::Descriptor;
use proptest::prelude::*;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;

/// Images over `words` words, some of them empty, some words never or always present.
fn presences(words: u32, count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Presence>> {
    let image = proptest::collection::vec(0..words, 0..2 * words as usize).prop_map(Presence::from);
    proptest::collection::vec(image, count)
}

/// `count` descriptors of unit length around `centres` random directions.
fn descriptors(count: usize, centres: usize, noise: f32, seed: u64) -> Vec<Descriptor> {
    let mut rng = ChaCha12Rng::seed_from_u64(seed);
    let mut row = |scale: f32| -> Descriptor { std::array::from_fn(|_| (rng.random::<f32>() - 0.5) * scale) };
    let directions: Vec<Descriptor> = (0..centres).map(|_| row(1.0)).collect();
    let around = |index: usize| {
        let offset = row(noise);
        let sum: Descriptor = std::array::from_fn(|k| directions[index % centres][k] + offset[k]);
        let norm = sum.iter().map(|value| value * value).sum::<f32>().sqrt();
        sum.map(|value| value / norm)
    };
    (0..count).map(around).collect()
}

/// `f` run by one, two and five threads.
fn on_thread_counts<T: Send>(f: impl Fn() -> T + Sync) -> Vec<T> {
    [1, 2, 5].map(|n| rayon::ThreadPoolBuilder::new().num_threads(n).build().unwrap().install(&f)).into()
}
