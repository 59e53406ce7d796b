//! Exact nearest words. A fast pass in single precision, or in whole numbers where the processor is faster with them, screens all words; the
//! few whose score lies within its rounding error of the best are compared in double precision. So the answer is the true nearest word,
//! whatever instructions screened.

use super::whole::{self, WholeDescriptor, WholeWords};
use super::{DIMENSIONS, Descriptor};
use rayon::prelude::*;

/// Words in a block: two AVX registers side by side.
pub(super) const LANES: usize = 16;
/// Descriptors scored against a block at once: twelve registers of sums leave room for the words.
const TILE: usize = 6;
/// Descriptors that share one walk over the words: their tiles stay in the first cache, each block is fetched once.
const GROUP: usize = 60;

/// Sixteen words, dimension by dimension.
type Block = [[f32; LANES]; DIMENSIONS];

/// A descriptor's nearest word.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The word's index.
    pub word: u32,
    /// The squared Euclidean distance to it.
    pub squared_distance: f64,
}

/// Words laid out for the screening pass.
#[derive(Debug, Clone)]
pub(super) struct PackedWords {
    rows: Vec<Descriptor>,
    layout: Layout,
    /// Half the squared norm of each word; infinite for the lanes that hold none.
    half_norms: Vec<[f32; LANES]>,
    largest_norm: f64,
}

#[derive(Debug, Clone)]
enum Layout {
    /// For processors that multiply whole numbers faster.
    Whole(WholeWords),
    /// For all others.
    Floats(Vec<Block>),
}

impl PackedWords {
    pub(super) fn new(words: &[Descriptor]) -> Self {
        let layout = if whole::can() { Layout::Whole(WholeWords::default()) } else { Layout::Floats(Vec::new()) };
        Self::laid_out(words, layout)
    }

    fn laid_out(words: &[Descriptor], layout: Layout) -> Self {
        let mut packed = Self { rows: Vec::new(), layout, half_norms: Vec::new(), largest_norm: 0.0 };
        words.iter().for_each(|word| packed.push(word));
        packed
    }

    /// The words.
    pub(super) fn rows(&self) -> &[Descriptor] {
        &self.rows
    }

    /// Adds a word behind the others.
    pub(super) fn push(&mut self, word: &Descriptor) {
        let (len, squared) = (self.rows.len(), squared_norm(word));
        let (block, lane) = (len / LANES, len % LANES);
        if lane == 0 {
            self.half_norms.push([f32::INFINITY; LANES]);
        }
        match &mut self.layout {
            Layout::Whole(words) => words.push(word, len),
            Layout::Floats(blocks) => {
                blocks.resize(block + 1, [[0.0; LANES]; DIMENSIONS]);
                blocks[block].iter_mut().zip(word).for_each(|(row, &value)| row[lane] = value);
            }
        }
        self.half_norms[block][lane] = (0.5 * squared) as f32;
        self.largest_norm = self.largest_norm.max(squared.sqrt());
        self.rows.push(*word);
    }

    /// The nearest word of each descriptor. There must be at least one word, and all numbers must be finite.
    pub(super) fn nearest(&self, descriptors: &[Descriptor]) -> Vec<Nearest> {
        let mut found = vec![Nearest { word: 0, squared_distance: 0.0 }; descriptors.len()];
        let groups = found.par_chunks_mut(GROUP).zip(descriptors.par_chunks(GROUP));
        groups.for_each_init(Vec::new, |searches, (found, group)| {
            searches.resize_with(GROUP, Search::default);
            self.screen(group, searches);
            for ((found, descriptor), search) in found.iter_mut().zip(group).zip(searches) {
                *found = self.settle(descriptor, search);
            }
        });
        found
    }

    /// Collects in `searches` every word that may be nearest.
    fn screen(&self, group: &[Descriptor], searches: &mut [Search]) {
        match &self.layout {
            Layout::Whole(words) => {
                let whole: Vec<WholeDescriptor> = group.iter().map(WholeDescriptor::of).collect();
                for ((search, descriptor), whole) in searches.iter_mut().zip(group).zip(&whole) {
                    let rounding = 2.0 * words.error(whole, self.largest_norm);
                    // Rounded to single precision, it must not become less.
                    search.restart((rounding * (1.0 + 1e-6)) as f32 + self.score_slack(descriptor));
                }
                words.screen(&self.half_norms, &whole, searches);
            }
            Layout::Floats(blocks) => {
                for (search, descriptor) in searches.iter_mut().zip(group) {
                    search.restart(self.score_slack(descriptor));
                }
                self.screen_floats(blocks, group, searches);
            }
        }
    }

    fn screen_floats(&self, blocks: &[Block], group: &[Descriptor], searches: &mut [Search]) {
        for (index, (block, half_norms)) in blocks.iter().zip(&self.half_norms).enumerate() {
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

    /// The nearest of the words that the screening left over, lowest index first.
    fn settle(&self, descriptor: &Descriptor, search: &Search) -> Nearest {
        let mut nearest = Nearest { word: 0, squared_distance: f64::INFINITY };
        for &(score, word) in &search.candidates {
            if score <= search.limit() {
                let squared_distance = self.squared_distance(descriptor, word as usize);
                if squared_distance < nearest.squared_distance {
                    nearest = Nearest { word, squared_distance };
                }
            }
        }
        nearest
    }

    fn squared_distance(&self, descriptor: &Descriptor, word: usize) -> f64 {
        let differences =
            self.rows[word].iter().zip(descriptor).map(|(word, &value)| f64::from(value) - f64::from(*word));
        differences.map(|difference| difference.powi(2)).sum()
    }

    /// How far apart the computed scores of two words may lie although the true order is the other way round: twice the error of one
    /// score, which is at most gamma_64 |d||w| for the dot product (Higham 2002, eq. 3.5; gamma_64 = 3.82e-6 in single precision) plus
    /// two roundings of numbers below |w|(|d| + |w|). The small addend covers underflow, of the units of whole numbers too: their product errs by
    /// up to 2^-150, times a sum below 2^31, in both scores.
    fn score_slack(&self, descriptor: &Descriptor) -> f32 {
        let norm = squared_norm(descriptor).sqrt();
        (2.0 * 4.0e-6 * self.largest_norm * (norm + self.largest_norm) + 1e-35) as f32
    }
}

fn squared_norm(row: &Descriptor) -> f64 {
    row.iter().map(|&value| f64::from(value).powi(2)).sum()
}

/// The words that may be nearest to one descriptor, with their scores, by rising index.
#[derive(Default)]
pub(super) struct Search {
    best: f32,
    slack: f32,
    candidates: Vec<(f32, u32)>,
}

impl Search {
    fn restart(&mut self, slack: f32) {
        self.best = f32::INFINITY;
        self.slack = slack;
        self.candidates.clear();
    }

    /// The greatest score that may belong to the nearest word.
    #[inline(always)]
    pub(super) fn limit(&self) -> f32 {
        self.best + self.slack
    }

    pub(super) fn note(&mut self, first_word: u32, scores: &[f32; LANES]) {
        for (&score, word) in scores.iter().zip(first_word..) {
            if score < f32::INFINITY && score <= self.limit() {
                self.candidates.push((score, word));
                self.best = self.best.min(score);
            }
        }
    }
}

/// The scores |w|^2/2 - d.w, which order words as their distances to d do; `None` when no score reaches its descriptor's limit.
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

/// Compiled for eight lanes and fused multiplication and addition. It rounds less often than the plain code, so other words may be left over,
/// and of them the same one is nearest.
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
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn brute_force(words: &[Descriptor], descriptor: &Descriptor) -> Nearest {
        let mut best = Nearest { word: 0, squared_distance: f64::INFINITY };
        for (word, row) in (0..).zip(words) {
            let squared_distance =
                row.iter().zip(descriptor).map(|(a, b)| (f64::from(*b) - f64::from(*a)).powi(2)).sum();
            if squared_distance < best.squared_distance {
                best = Nearest { word, squared_distance };
            }
        }
        best
    }

    /// Few levels, so that exact ties and equal words are common; sometimes far from the origin, where single precision cancels.
    fn rows(count: std::ops::Range<usize>) -> impl Strategy<Value = Vec<Descriptor>> {
        let number = prop_oneof![(-2i8..3).prop_map(|v| f32::from(v) * 0.125), (-1.0f32..1.0)];
        let row = proptest::collection::vec(number, DIMENSIONS);
        (proptest::collection::vec(row, count), prop_oneof![Just(0.0f32), Just(1000.0)])
            .prop_map(|(rows, offset)| rows.iter().map(|row| std::array::from_fn(|k| row[k] + offset)).collect())
    }

    proptest! {
        #[test]
        fn the_nearest_word_is_the_brute_force_one(words in rows(1..40), descriptors in rows(0..9)) {
            let expected: Vec<_> = descriptors.iter().map(|d| brute_force(&words, d)).collect();
            prop_assert_eq!(&PackedWords::new(&words).nearest(&descriptors), &expected);
            let floats = PackedWords::laid_out(&words, Layout::Floats(Vec::new()));
            prop_assert_eq!(floats.nearest(&descriptors), expected);
        }

        #[test]
        fn scores_err_by_less_than_half_the_slack(words in rows(16..17), tile in rows(TILE..TILE + 1)) {
            let packed = PackedWords::laid_out(&words, Layout::Floats(Vec::new()));
            let Layout::Floats(blocks) = &packed.layout else { unreachable!("laid out so") };
            let tile: [&Descriptor; TILE] = std::array::from_fn(|i| &tile[i]);
            let (block, norms, limits) = (&blocks[0], &packed.half_norms[0], [f32::INFINITY; TILE]);
            let plain = |a: f32, b: f32, sum: f32| a * b + sum;
            for scores in [score_tile(block, norms, &tile, &limits), score_tile_by(plain, block, norms, &tile, &limits)] {
                for (scores, descriptor) in scores.unwrap().iter().zip(tile) {
                    let product = |word: &Descriptor| -> f64 {
                        word.iter().zip(descriptor).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
                    };
                    for (score, word) in scores.iter().zip(&words) {
                        let exact = 0.5 * squared_norm(word) - product(word);
                        let error = (f64::from(*score) - exact).abs();
                        prop_assert!(error <= 0.5 * f64::from(packed.score_slack(descriptor)), "{error}");
                    }
                }
            }
        }
    }

    #[test]
    fn words_so_small_that_products_underflow_are_told_apart() {
        for exponent in -21..-14 {
            let row = |i: usize| [(1.0 + i as f32 / 997.0) * 10f32.powi(exponent); DIMENSIONS];
            let words: Vec<Descriptor> = (0..600).map(|i| row(i * 7919 % 600)).collect();
            let descriptors: Vec<Descriptor> = (0..200).map(|i| row(i * 3)).collect();
            let expected: Vec<_> = descriptors.iter().map(|d| brute_force(&words, d)).collect();
            assert_eq!(PackedWords::new(&words).nearest(&descriptors), expected, "1e{exponent}");
        }
    }

    #[test]
    fn equal_words_give_the_lowest_index_and_words_nudged_by_one_bit_are_told_apart() {
        let row: Descriptor = std::array::from_fn(|k| (k as f32 * 0.37).sin() * 0.2);
        let mut nudged = row;
        nudged[63] = f32::from_bits(nudged[63].to_bits() + 1);
        let packed = PackedWords::new(&[nudged, row, row]);
        assert_eq!(packed.nearest(&[row, nudged]).iter().map(|n| n.word).collect::<Vec<_>>(), [1, 0]);
    }
}
