//! The entry: blocks where the machine has AVX2, plain mutual matching elsewhere. Both give equal matches.

use crate::features::{Index, WholeImage, Window};
use crate::matching::best::Match;
use crate::matching::mutual::match_mutually;

#[cfg(target_arch = "x86_64")]
use super::distinct::match_distinct;

/// As [`match_mutually`], for a `ratio` below 1.
pub(crate) fn match_whole_image<const N: usize>(
    a: &Index<N>,
    b: &WholeImage<N>,
    ratio: f64,
    window: impl Fn(usize) -> Option<Window>,
) -> Vec<Match> {
    match b {
        // SAFETY: blocks are made only where the machine has AVX2.
        #[cfg(target_arch = "x86_64")]
        WholeImage::Blocks(b) => unsafe { match_distinct(a, b, ratio, window) },
        WholeImage::Plain(b) => match_mutually(a, b, ratio, window),
    }
}
