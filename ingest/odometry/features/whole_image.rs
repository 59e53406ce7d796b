//! An index for windows that cover a good part of the image, with thousands of candidates per point.

use super::index::Index;

#[cfg(target_arch = "x86_64")]
use super::blocks::Blocks;

/// Points indexed for whole-image windows.
#[derive(Debug, Clone)]
pub(crate) enum WholeImage<const N: usize> {
    /// For machines with AVX2.
    #[cfg(target_arch = "x86_64")]
    Blocks(Blocks<N>),
    /// For all others: the index as it is.
    Plain(Index<N>),
}

impl<const N: usize> WholeImage<N> {
    /// The points of an image of `size` columns and rows.
    pub fn new(index: &Index<N>, size: (usize, usize)) -> Self {
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            return Self::Blocks(Blocks::new(index, size));
        }
        // Only blocks need the size.
        let _ = size;
        Self::Plain(index.clone())
    }
}
