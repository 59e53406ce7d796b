//! The search for a descriptor's nearest word: what the screening of all words leaves over.

use super::dimensions::Descriptor;

/// Words in a block: two AVX registers side by side.
pub(super) const LANES: usize = 16;

/// The words that may be nearest to one descriptor, with their scores, by rising index.
#[derive(Default)]
pub(super) struct Search {
    best: f32,
    slack: f32,
    pub(super) candidates: Vec<(f32, u32)>,
}

impl Search {
    pub(super) fn restart(&mut self, slack: f32) {
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

/// How far apart the computed scores of two words may lie although the true order is the other way round: twice the
/// error of one score, which is at most gamma_64 |d||w| for the dot product (Higham 2002, eq. 3.5; gamma_64 = 3.82e-6
/// in single precision) plus two roundings of numbers below |w|(|d| + |w|). The small addend covers underflow, of the
/// units of integers too: their product errs by up to 2^-150, times a sum below 2^31, in both scores.
pub(super) fn score_slack(descriptor: &Descriptor, largest_norm: f64) -> f32 {
    let norm = squared_norm(descriptor).sqrt();
    (2.0 * 4.0e-6 * largest_norm * (norm + largest_norm) + 1e-35) as f32
}

/// The squared length of a descriptor.
pub(super) fn squared_norm(row: &Descriptor) -> f64 {
    row.iter().map(|&value| f64::from(value).powi(2)).sum()
}
