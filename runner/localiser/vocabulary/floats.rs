//! The screening of all words in single precision, a block of words and a tile of descriptors at a time.

use super::dimensions::{DIMENSIONS, Descriptor};
use super::search::{LANES, Search};

/// Descriptors scored against a block at once: twelve registers of sums leave room for the words.
const TILE: usize = 6;

/// Sixteen words, dimension by dimension.
type Block = [[f32; LANES]; DIMENSIONS];

/// Words in single precision.
#[derive(Debug, Clone, Default)]
pub(super) struct FloatWords {
    blocks: Vec<Block>,
}

impl FloatWords {
    /// Adds a word behind `len` others.
    pub fn push(&mut self, word: &Descriptor, len: usize) {
        let (block, lane) = (len / LANES, len % LANES);
        self.blocks.resize(block + 1, [[0.0; LANES]; DIMENSIONS]);
        self.blocks[block].iter_mut().zip(word).for_each(|(row, &value)| row[lane] = value);
    }

    /// Collects in `searches` every word that may be nearest to one of the descriptors.
    pub fn screen(&self, half_norms: &[[f32; LANES]], group: &[Descriptor], searches: &mut [Search]) {
        for (index, (block, half_norms)) in self.blocks.iter().zip(half_norms).enumerate() {
            let first_word = (index * LANES) as u32;
            for (tile, searches) in group.chunks(TILE).zip(searches.chunks_mut(TILE)) {
                let rows: [&Descriptor; TILE] = std::array::from_fn(|i| &tile[i.min(tile.len() - 1)]);
                let limits = std::array::from_fn(|i| searches[i].limit());
                if let Some(scores) = score_tile(block, half_norms, &rows, &limits) {
                    searches
                        .iter_mut()
                        .zip(&scores)
                        .take(tile.len())
                        .for_each(|(s, scores)| s.note(first_word, scores));
                }
            }
        }
    }
}

/// The scores |w|^2/2 - d.w, which order words as their distances to d do; `None` when no score reaches its
/// descriptor's limit.
fn score_tile(
    block: &Block,
    half_norms: &[f32; LANES],
    tile: &[&Descriptor; TILE],
    limits: &[f32; TILE],
) -> Option<[[f32; LANES]; TILE]> {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
        // SAFETY: the processor has both, and the function's body is safe code.
        return unsafe { score_tile_fused(block, half_norms, tile, limits) };
    }
    score_tile_by(|a, b, sum| a * b + sum, block, half_norms, tile, limits)
}

/// Compiled for eight lanes and fused multiplication and addition. It rounds less often than the plain code, so other
/// words may be left over, and of them the same one is nearest.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma")]
fn score_tile_fused(
    block: &Block,
    half_norms: &[f32; LANES],
    tile: &[&Descriptor; TILE],
    limits: &[f32; TILE],
) -> Option<[[f32; LANES]; TILE]> {
    score_tile_by(f32::mul_add, block, half_norms, tile, limits)
}

#[inline(always)]
fn score_tile_by(
    multiplied_added: impl Fn(f32, f32, f32) -> f32,
    block: &Block,
    half_norms: &[f32; LANES],
    tile: &[&Descriptor; TILE],
    limits: &[f32; TILE],
) -> Option<[[f32; LANES]; TILE]> {
    let mut scores = [[0.0_f32; LANES]; TILE];
    for (k, words) in block.iter().enumerate() {
        for (scores, row) in scores.iter_mut().zip(tile) {
            for (score, word) in scores.iter_mut().zip(words) {
                *score = multiplied_added(row[k], *word, *score);
            }
        }
    }
    let mut reached = false;
    for (scores, limit) in scores.iter_mut().zip(limits) {
        for (score, half_norm) in scores.iter_mut().zip(half_norms) {
            *score = half_norm - *score;
            reached |= *score <= *limit;
        }
    }
    reached.then_some(scores)
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::vocabulary::search::{score_slack, squared_norm};
    use proptest::prelude::*;

    /// Few levels, so that exact ties and equal words are common; sometimes far from the origin, where single precision
    /// cancels.
    pub(crate) fn rows(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Descriptor>> {
        let number = prop_oneof![(-2i8..3).prop_map(|v| f32::from(v) * 0.125), (-1.0f32..1.0)];
        let row = proptest::collection::vec(number, DIMENSIONS);
        (proptest::collection::vec(row, count), prop_oneof![Just(0.0f32), Just(1000.0)])
            .prop_map(|(rows, offset)| rows.iter().map(|row| std::array::from_fn(|k| row[k] + offset)).collect())
    }

    proptest! {
        #[test]
        fn scores_err_by_less_than_half_the_slack(words in rows(16..17), tile in rows(TILE..TILE + 1)) {
            let mut packed = FloatWords::default();
            words.iter().enumerate().for_each(|(len, word)| packed.push(word, len));
            let norms: [f32; LANES] = std::array::from_fn(|lane| (0.5 * squared_norm(&words[lane])) as f32);
            let largest_norm = words.iter().map(|word| squared_norm(word).sqrt()).fold(0.0, f64::max);
            let tile: [&Descriptor; TILE] = std::array::from_fn(|i| &tile[i]);
            let (block, norms, limits) = (&packed.blocks[0], &norms, [f32::INFINITY; TILE]);
            let plain = |a: f32, b: f32, sum: f32| a * b + sum;
            for scores in [score_tile(block, norms, &tile, &limits), score_tile_by(plain, block, norms, &tile, &limits)] {
                for (scores, descriptor) in scores.unwrap().iter().zip(tile) {
                    let product = |word: &Descriptor| -> f64 {
                        word.iter().zip(descriptor).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
                    };
                    for (score, word) in scores.iter().zip(&words) {
                        let exact = 0.5 * squared_norm(word) - product(word);
                        let error = (f64::from(*score) - exact).abs();
                        prop_assert!(error <= 0.5 * f64::from(score_slack(descriptor, largest_norm)), "{error}");
                    }
                }
            }
        }
    }
}
