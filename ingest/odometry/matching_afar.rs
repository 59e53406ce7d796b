//! Mutual best matches where windows hold a good part of the image: thousands of candidates a point. Only distances are kept while all pairs
//! are compared, sixteen at a time with AVX2; who it was is looked up for the few points that stand out. Integers: the same matches on every machine.

#[cfg(target_arch = "x86_64")]
mod avx2;
#[cfg(target_arch = "x86_64")]
mod blocks;

use crate::index::{Index, Window};
use crate::matching::{Match, mutual_best};

/// Points laid out for wide windows.
#[derive(Debug, Clone)]
pub(crate) enum Wide<const N: usize> {
    /// For machines with AVX2.
    #[cfg(target_arch = "x86_64")]
    Blocks(blocks::Blocks<N>),
    /// For all others, as they were.
    Plain(Index<N>),
}

impl<const N: usize> Wide<N> {
    /// The points of an image of `size` columns and rows.
    pub fn of(index: &Index<N>, size: (usize, usize)) -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            return Self::Blocks(blocks::Blocks::of(index, size));
        }
        let _ = size;
        Self::Plain(index.clone())
    }
}

/// As [`mutual_best`], for a `ratio` below 1: what is tied with others is no match.
pub(crate) fn mutual_best_afar<const N: usize>(
    a: &Index<N>,
    b: &Wide<N>,
    ratio: f64,
    window: impl Fn(usize) -> Option<Window>,
) -> Vec<Match> {
    match b {
        // SAFETY: blocks are made where the machine has AVX2.
        #[cfg(target_arch = "x86_64")]
        Wide::Blocks(b) => unsafe { avx2::distinct_pairs(a, b, ratio, window) },
        Wide::Plain(b) => mutual_best(a, b, ratio, window),
    }
}
