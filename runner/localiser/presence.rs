//! Which words an image shows.

use serde::{Deserialize, Serialize};

/// The distinct words present in one image, as word indices in rising order. How often a word occurs is not kept:
/// FAB-MAP's observation is binary (Cummins and Newman 2008, section 3).
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<u32>", into = "Vec<u32>")]
pub struct Presence {
    words: Vec<u32>,
}

impl Presence {
    /// The word indices, rising, without repeats.
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// Number of distinct words.
    pub fn len(&self) -> usize {
        self.words.len()
    }

    /// Whether the image shows no word at all, as a black image does.
    pub fn is_empty(&self) -> bool {
        self.words.is_empty()
    }

    /// Whether `word` is present.
    pub fn contains(&self, word: u32) -> bool {
        self.words.binary_search(&word).is_ok()
    }

    /// The first word index that a vocabulary of `words` words does not have, if any.
    pub(crate) fn beyond(&self, words: usize) -> Option<u32> {
        self.words.last().copied().filter(|&word| word as usize >= words)
    }
}

impl From<Vec<u32>> for Presence {
    /// Sorts and drops repeats.
    fn from(mut words: Vec<u32>) -> Self {
        words.sort_unstable();
        words.dedup();
        Self { words }
    }
}

impl From<Presence> for Vec<u32> {
    fn from(presence: Presence) -> Self {
        presence.words
    }
}

impl FromIterator<u32> for Presence {
    fn from_iter<I: IntoIterator<Item = u32>>(words: I) -> Self {
        Vec::from_iter(words).into()
    }
}
