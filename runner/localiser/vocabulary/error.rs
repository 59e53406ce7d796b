//! What can be wrong with descriptors and words.

use super::dimensions::DIMENSIONS;

/// What can be wrong with descriptors and words.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum VocabularyError {
    /// Training was asked for no words.
    #[error("training a vocabulary: 0 words were asked for, expected at least 1")]
    NoWords,
    /// Nothing to train on.
    #[error("training a vocabulary: no descriptors came; use images with features, or a lower Hessian threshold")]
    NoDescriptors,
    /// Fewer different descriptors than words.
    #[error(
        "training a vocabulary of {words} words: only {distinct} different descriptors came; \
         ask for at most {distinct} words, or add images to the vocabulary's recording"
    )]
    TooFewDescriptors {
        /// Words asked for.
        words: usize,
        /// Different descriptors found.
        distinct: usize,
    },
    /// A number that is not finite, or absurdly large.
    #[error(
        "{what} {index} holds {value} at position {position}: expected finite numbers of at most 1e9 in magnitude; \
         check the image or the table it comes from"
    )]
    NotFinite {
        /// `descriptor` or `word`.
        what: &'static str,
        /// Its index.
        index: usize,
        /// Which of the 64 numbers.
        position: usize,
        /// The number.
        value: f32,
    },
    /// A flat table of words whose length is no multiple of 64.
    #[error("reading a vocabulary: {numbers} numbers came, expected a positive multiple of 64")]
    Ragged {
        /// Numbers in the table.
        numbers: usize,
    },
    /// A checkpoint of another training.
    #[error(
        "resuming the training of {words} words: the checkpoint holds {numbers} numbers, expected {}; remove it and train anew",
        words * DIMENSIONS
    )]
    WrongCheckpoint {
        /// Numbers in the checkpoint's words.
        numbers: usize,
        /// Words that are trained.
        words: usize,
    },
    /// A cluster radius that is not a positive number.
    #[error("clustering descriptors: the radius is {radius}, expected a positive number such as 0.4")]
    BadRadius {
        /// The radius.
        radius: f64,
    },
}

impl VocabularyError {
    /// The same error, its index counted in rows that `before` others precede.
    pub(super) fn counted_from(self, before: usize) -> Self {
        match self {
            Self::NotFinite { what, index, position, value } => {
                Self::NotFinite { what, index: before + index, position, value }
            }
            other => other,
        }
    }
}
