//! First words for k-means: descriptors that lie far apart.

use super::dimensions::Descriptor;
use super::nearest::{Nearest, PackedWords};
use rand::RngExt;
use rand_chacha::ChaCha12Rng;

/// Rounds of choosing: the first is uniform, each later one favours what is far from all words chosen before it. Up to
/// so many words this is k-means++ itself.
const ROUNDS: usize = 64;

/// `words` of the descriptors in `pool`, which must be different and no fewer. Spread as k-means++ spreads them (Arthur
/// and Vassilvitskii 2007), but drawn in a few rounds as in k-means|| (Bahmani et al. 2012), so that all the distances
/// cost as much as one round of k-means.
pub(super) fn spread(pool: &[Descriptor], words: usize, rng: &mut ChaCha12Rng) -> Vec<Descriptor> {
    let mut squared_distances = vec![1.0; pool.len()];
    let mut chosen = Vec::with_capacity(words);
    for round in 0..ROUNDS {
        let wanted = words * (round + 1) / ROUNDS - chosen.len();
        if wanted == 0 {
            continue;
        }
        let drawn = draw(&mut squared_distances, wanted, rng);
        let new_words: Vec<Descriptor> = drawn.iter().map(|&index| pool[index]).collect();
        let nearest = PackedWords::new(&new_words).nearest(pool);
        let first = chosen.is_empty();
        for (distance, Nearest { squared_distance, .. }) in squared_distances.iter_mut().zip(nearest) {
            *distance = if first { squared_distance } else { squared_distance.min(*distance) };
        }
        chosen.extend(new_words);
    }
    chosen
}

/// Draws `wanted` different indices, each with a chance in proportion to its weight; their weights become 0.
fn draw(weights: &mut [f64], wanted: usize, rng: &mut ChaCha12Rng) -> Vec<usize> {
    let mut drawn = Vec::with_capacity(wanted);
    while drawn.len() < wanted {
        let mut sums = Vec::with_capacity(weights.len());
        let mut total = 0.0;
        for &weight in weights.iter() {
            total += weight;
            sums.push(total);
        }
        // Draws that hit an index a second time are dropped and drawn anew with that weight gone.
        for _ in drawn.len()..wanted {
            let target = rng.random::<f64>() * total;
            let hit = sums.partition_point(|&sum| sum <= target);
            let hit = if hit < weights.len() && weights[hit] > 0.0 { Some(hit) } else { None };
            if let Some(index) = hit {
                weights[index] = 0.0;
                drawn.push(index);
            }
        }
    }
    drawn
}
