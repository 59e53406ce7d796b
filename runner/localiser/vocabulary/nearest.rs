//! Exact nearest words. A fast pass in single precision, or in integers where the processor is faster with them,
//! screens all words; the few whose score lies within its rounding error of the best are compared in double precision.
//! So the answer is the true nearest word, whatever instructions screened.

use super::dimensions::Descriptor;
use super::floats::FloatWords;
use super::integers::{self, IntegerDescriptor, IntegerWords};
use super::search::{LANES, Search, score_slack, squared_norm};
use rayon::prelude::*;

/// Descriptors that share one walk over the words: their tiles stay in the first cache, each block is fetched once.
const GROUP: usize = 60;

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
    /// For processors that multiply integers faster.
    Integers(IntegerWords),
    /// For all others.
    Floats(FloatWords),
}

impl PackedWords {
    pub(super) fn new(words: &[Descriptor]) -> Self {
        let layout = match integers::are_fast() {
            true => Layout::Integers(IntegerWords::default()),
            false => Layout::Floats(FloatWords::default()),
        };
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
            Layout::Integers(words) => words.push(word, len),
            Layout::Floats(words) => words.push(word, len),
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
            Layout::Integers(words) => {
                let integers: Vec<IntegerDescriptor> = group.iter().map(IntegerDescriptor::of).collect();
                for ((search, descriptor), integer) in searches.iter_mut().zip(group).zip(&integers) {
                    let rounding = 2.0 * words.error(integer, self.largest_norm);
                    // Rounded to single precision, it must not become less.
                    search.restart((rounding * (1.0 + 1e-6)) as f32 + score_slack(descriptor, self.largest_norm));
                }
                words.screen(&self.half_norms, &integers, searches);
            }
            Layout::Floats(words) => {
                for (search, descriptor) in searches.iter_mut().zip(group) {
                    search.restart(score_slack(descriptor, self.largest_norm));
                }
                words.screen(&self.half_norms, group, searches);
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
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vocabulary::dimensions::DIMENSIONS;
    use crate::vocabulary::floats::tests::rows;
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

    proptest! {
        #[test]
        fn the_nearest_word_is_the_brute_force_one(words in rows(1..40), descriptors in rows(0..9)) {
            let expected: Vec<_> = descriptors.iter().map(|d| brute_force(&words, d)).collect();
            prop_assert_eq!(&PackedWords::new(&words).nearest(&descriptors), &expected);
            let floats = PackedWords::laid_out(&words, Layout::Floats(FloatWords::default()));
            prop_assert_eq!(floats.nearest(&descriptors), expected);
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
