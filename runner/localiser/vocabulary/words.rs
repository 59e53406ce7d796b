//! The words themselves.

use super::check::check_finite;
use super::dimensions::{DIMENSIONS, Descriptor};
use super::error::VocabularyError;
use super::nearest::{Nearest, PackedWords};
use crate::presence::Presence;

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

    /// The nearest word (Euclidean, exact) of each descriptor, ties to the lowest index. There is no distance cutoff,
    /// as in openFABMAP. Error: [`VocabularyError::NotFinite`].
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
    pub(super) fn from_words(words: &[Descriptor]) -> Self {
        Self { packed: PackedWords::new(words) }
    }
}
