//! What can be wrong with parameters, samples, places and queries.

use super::params::FabMapParams;

/// What can be wrong with a localiser's parameters, samples, places and queries.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FabMapError {
    /// Parameters outside their ranges.
    #[error(
        "making a FAB-MAP localiser: {0:?}; expected 0 <= p_detect_absent < p_detect_present < 1 and 0 <= smoothing <= 1 \
         (openFABMAP: 0, 0.39, 0.99)"
    )]
    BadParams(FabMapParams),
    /// The new place is to be sampled, but there are no samples.
    #[error("making a FAB-MAP localiser: no sample images came; give the codebook's, or use the mean-field new place")]
    NoSamples,
    /// A presence of another vocabulary.
    #[error(
        "{what} shows word {word} of a codebook of {words} words; compute its words with this codebook's vocabulary"
    )]
    WordOutOfRange {
        /// `sample`, `place` or `query`.
        what: &'static str,
        /// The word.
        word: u32,
        /// Words in the codebook.
        words: usize,
    },
}
