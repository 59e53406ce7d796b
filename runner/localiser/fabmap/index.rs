//! The inverted index: for each word the places that hold it, so that a query touches only what it changes.

use super::word_model::{Observation, WordModel};
use crate::presence::Presence;

/// A sample image that looks like a mapped place. See
/// [`FabMap::samples_like_places`](super::FabMap::samples_like_places).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleOverlap {
    /// Index of the sample.
    pub sample: usize,
    /// Index of the place that it resembles most.
    pub place: usize,
    /// Words in both images over words in either, 0 to 1.
    pub similarity: f64,
}

/// Places by word.
#[derive(Debug, Clone)]
pub(super) struct InvertedIndex {
    /// For each word, the places that hold it, rising.
    holders: Vec<Vec<u32>>,
    /// For each place, what its words add to the log-likelihood of an observation of nothing.
    defaults: Vec<f64>,
    /// For each place, its number of words.
    sizes: Vec<u32>,
}

impl InvertedIndex {
    pub(super) fn new(words: usize) -> Self {
        Self { holders: vec![Vec::new(); words], defaults: Vec::new(), sizes: Vec::new() }
    }

    pub(super) fn len(&self) -> usize {
        self.defaults.len()
    }

    /// Adds a place whose words are in range; its number.
    pub(super) fn add(&mut self, place: &Presence, model: &WordModel) -> usize {
        let number = self.len();
        place.words().iter().for_each(|&word| self.holders[word as usize].push(number as u32));
        self.defaults.push(place.words().iter().map(|&word| model.gain_of_nothing(word)).sum());
        self.sizes.push(place.len() as u32);
        number
    }

    /// Log-likelihood of an observation at each place, given that at a place without words.
    pub(super) fn log_likelihoods(&self, unseen: f64, observation: &Observation, log_likelihoods: &mut Vec<f64>) {
        log_likelihoods.clear();
        log_likelihoods.extend(self.defaults.iter().map(|default| unseen + default));
        for &(word, change) in observation.changes.iter().filter(|(_, change)| *change != 0.0) {
            for &place in &self.holders[word as usize] {
                log_likelihoods[place as usize] += change;
            }
        }
    }

    /// For each place of this index, the place of `other` with the highest Jaccard index of their words, lowest number
    /// first; places that share no word with any are left out.
    pub(super) fn most_similar(&self, other: &Self) -> Vec<SampleOverlap> {
        let mut words_of = vec![Vec::new(); self.len()];
        for (word, holders) in self.holders.iter().enumerate() {
            holders.iter().for_each(|&place| words_of[place as usize].push(word));
        }
        let mut shared = vec![0_u32; other.len()];
        let mut found = Vec::new();
        for (sample, words) in words_of.iter().enumerate() {
            shared.fill(0);
            words.iter().flat_map(|&word| &other.holders[word]).for_each(|&place| shared[place as usize] += 1);
            let mut best = SampleOverlap { sample, place: 0, similarity: 0.0 };
            for (place, &shared) in shared.iter().enumerate().filter(|(_, shared)| **shared > 0) {
                let either = words.len() as u32 + other.sizes[place] - shared;
                let similarity = f64::from(shared) / f64::from(either);
                if similarity > best.similarity {
                    best = SampleOverlap { sample, place, similarity };
                }
            }
            found.extend((best.similarity > 0.0).then_some(best));
        }
        found
    }
}
