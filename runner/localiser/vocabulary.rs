//! The vocabulary: cluster centres of descriptors. An image's words are the centres nearest to its descriptors.

mod kmeans;
mod nearest;
mod sample;
mod seeding;
mod sequential;
mod whole;

use crate::presence::Presence;
use nearest::PackedWords;

pub use kmeans::{KMeans, KMeansCheckpoint, KMeansProgress, TrainingRecord, train_kmeans};
pub use nearest::Nearest;
pub use sample::TrainingSample;
pub use sequential::train_sequential;

/// Numbers in a descriptor.
pub const DIMENSIONS: usize = 64;

/// A SURF descriptor, usually of unit length.
pub use crate::surf::Descriptor;

/// The largest magnitude of a descriptor's number: keeps squared distances far inside `f32`.
const LARGEST: f32 = 1e9;

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
    fn counted_from(self, before: usize) -> Self {
        match self {
            Self::NotFinite { what, index, position, value } => {
                Self::NotFinite { what, index: before + index, position, value }
            }
            other => other,
        }
    }
}

/// `len` words of 64 numbers each.
#[derive(Debug, Clone)]
pub struct Vocabulary {
    packed: PackedWords,
}

impl PartialEq for Vocabulary {
    fn eq(&self, other: &Self) -> bool {
        self.words() == other.words()
    }
}

impl Vocabulary {
    /// From `len * 64` numbers, word by word. Errors: [`VocabularyError::Ragged`], [`VocabularyError::NotFinite`].
    pub fn from_flat(flat: Vec<f32>) -> Result<Self, VocabularyError> {
        let (words, rest) = flat.as_chunks::<DIMENSIONS>();
        if words.is_empty() || !rest.is_empty() {
            return Err(VocabularyError::Ragged { numbers: flat.len() });
        }
        check_finite("word", words)?;
        Ok(Self::from_words(words))
    }

    /// Number of words.
    pub fn len(&self) -> usize {
        self.words().len()
    }

    /// Never true: a vocabulary has at least one word.
    pub fn is_empty(&self) -> bool {
        self.words().is_empty()
    }

    /// All words, `len * 64` numbers, word by word; what [`Vocabulary::from_flat`] takes.
    pub fn flat(&self) -> &[f32] {
        self.words().as_flattened()
    }

    /// The words one by one.
    pub fn words(&self) -> &[Descriptor] {
        self.packed.rows()
    }

    /// The nearest word (Euclidean, exact) of each descriptor, ties to the lowest index. There is no distance cutoff, as in
    /// openFABMAP. Error: [`VocabularyError::NotFinite`].
    pub fn nearest(&self, descriptors: &[Descriptor]) -> Result<Vec<Nearest>, VocabularyError> {
        check_finite("descriptor", descriptors)?;
        Ok(self.packed.nearest(descriptors))
    }

    /// The words of an image, from its descriptors. An image without descriptors has no words, which is no error.
    /// Error: [`VocabularyError::NotFinite`].
    pub fn presence(&self, descriptors: &[Descriptor]) -> Result<Presence, VocabularyError> {
        Ok(self.nearest(descriptors)?.iter().map(|nearest| nearest.word).collect())
    }

    /// From words that are known to be finite and at least one.
    fn from_words(words: &[Descriptor]) -> Self {
        Self { packed: PackedWords::new(words) }
    }
}

fn check_finite(what: &'static str, rows: &[Descriptor]) -> Result<(), VocabularyError> {
    for (index, row) in rows.iter().enumerate() {
        let is_bad = |value: f32| value.is_nan() || value.abs() > LARGEST;
        if let Some((position, &value)) = row.iter().enumerate().find(|(_, value)| is_bad(**value)) {
            return Err(VocabularyError::NotFinite { what, index, position, value });
        }
    }
    Ok(())
}
