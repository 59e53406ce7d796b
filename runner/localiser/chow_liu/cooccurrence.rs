//! How often words occur and occur together: each word's images as a row of bits, so that a pair costs one AND and
//! popcount per 64 images.

use super::smoothing::smoothed;
use crate::presence::Presence;

/// The bits of all words, and the tables that turn counts into information.
pub(super) struct Cooccurrence {
    images: u32,
    /// 64-bit blocks in a word's row.
    blocks: usize,
    rows: Vec<u64>,
    counts: Vec<u32>,
    /// `(c / images) ln(c / images)` for each count c.
    entropy_terms: Vec<f64>,
    /// For each word f ln p + (1 - f) ln(1 - p), with f its frequency and p the smoothed one.
    marginal_terms: Vec<f64>,
}

impl Cooccurrence {
    /// `images` must not be empty and must hold words below `words` only.
    pub(super) fn new(images: &[Presence], words: usize) -> Self {
        let blocks = images.len().div_ceil(64);
        let mut rows = vec![0_u64; words * blocks];
        let mut counts = vec![0_u32; words];
        for (image, presence) in images.iter().enumerate() {
            for &word in presence.words() {
                rows[word as usize * blocks + image / 64] |= 1 << (image % 64);
                counts[word as usize] += 1;
            }
        }
        let total = images.len() as u32;
        let share = |count: u32| f64::from(count) / f64::from(total);
        let entropy_term = |count| if count == 0 { 0.0 } else { share(count) * libm::log(share(count)) };
        let marginal_term = |&count: &u32| {
            let p = smoothed(count, total);
            share(count) * libm::log(p) + (1.0 - share(count)) * libm::log(1.0 - p)
        };
        let marginal_terms = counts.iter().map(marginal_term).collect();
        Self {
            images: total,
            blocks,
            rows,
            counts,
            entropy_terms: (0..=total).map(entropy_term).collect(),
            marginal_terms,
        }
    }

    pub(super) fn words(&self) -> usize {
        self.counts.len()
    }

    pub(super) fn images(&self) -> u32 {
        self.images
    }

    /// Images that show `word`.
    pub(super) fn count(&self, word: usize) -> u32 {
        self.counts[word]
    }

    /// Images that show both words.
    pub(super) fn both(&self, a: usize, b: usize) -> u32 {
        common_bits(self.row(a), self.row(b))
    }

    /// openFABMAP's score of each pair (`word`, other), in nats, into `scores`: the sum over both states of both words
    /// of P(a, b) ln(P(a, b) / (P(a) P(b))), joint raw, marginals smoothed. Written with the marginals taken out of the
    /// sum, so that it is two looked-up numbers for the words and four for the counts. It is a Kullback-Leibler
    /// divergence, hence not negative.
    pub(super) fn scores(&self, word: usize, others: &[u32], scores: &mut [f64]) {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("popcnt") && is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has popcnt and AVX2, and the function's body is safe code.
            return unsafe { self.scores_popcnt(word, others, scores) };
        }
        self.scores_plain(word, others, scores);
    }

    /// The same code with the popcnt instruction; counts are whole numbers, so nothing else changes.
    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "popcnt,avx2")]
    unsafe fn scores_popcnt(&self, word: usize, others: &[u32], scores: &mut [f64]) {
        self.scores_plain(word, others, scores);
    }

    #[inline(always)]
    fn scores_plain(&self, word: usize, others: &[u32], scores: &mut [f64]) {
        let (row, own) = (self.row(word), self.counts[word]);
        for (score, &other) in scores.iter_mut().zip(others) {
            let both = common_bits(row, self.row(other as usize));
            let count = self.counts[other as usize];
            let term = |count: u32| self.entropy_terms[count as usize];
            // Sums are paired so that (a, b) and (b, a) give the same bits.
            let joint = (term(both) + term(self.images + both - own - count)) + (term(own - both) + term(count - both));
            let marginals = self.marginal_terms[word] + self.marginal_terms[other as usize];
            *score = (joint - marginals).max(0.0);
        }
    }

    #[inline(always)]
    fn row(&self, word: usize) -> &[u64] {
        &self.rows[word * self.blocks..(word + 1) * self.blocks]
    }
}

#[inline(always)]
fn common_bits(a: &[u64], b: &[u64]) -> u32 {
    a.iter().zip(b).map(|(a, b)| (a & b).count_ones()).sum()
}
