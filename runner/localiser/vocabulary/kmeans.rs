//! k-means: the vocabulary that furrow trains by default.

use super::nearest::{Nearest, PackedWords};
use super::{DIMENSIONS, Descriptor, Vocabulary, VocabularyError, check_finite, seeding};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha12Rng;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Rounds at most. Vocabularies change little after ten.
const MAX_ITERATIONS: usize = 15;
/// Rounds end when the squared error falls by less than this share.
const ENOUGH: f64 = 2e-3;
/// Different descriptors per word that training looks at; of more, a seeded sample is drawn, so that time grows with the square of the words only.
const DESCRIPTORS_PER_WORD: usize = 128;

/// How a training went.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainingRecord {
    /// Words in the vocabulary.
    pub words: usize,
    /// Descriptors offered.
    pub descriptors: usize,
    /// Descriptors looked at: all different ones, or a seeded sample of 128 per word.
    pub descriptors_used: usize,
    /// The seed.
    pub seed: u64,
    /// Rounds of moving the words.
    pub iterations: usize,
    /// Root mean square distance of the descriptors looked at to their nearest words.
    pub quantisation_error: f64,
}

/// A finished round of training.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KMeansProgress {
    /// Rounds done.
    pub iteration: usize,
    /// Rounds at most; training may end earlier.
    pub max_iterations: usize,
    /// Root mean square distance of the descriptors to their nearest words so far.
    pub quantisation_error: f64,
}

/// Trains a vocabulary of `words` words by k-means (Lloyd 1982) from a spread-out choice of descriptors. Descriptors that repeat
/// exactly, as those of a robot that stands still, count once. Equal input and seed give
/// equal bits on any number of threads. A word that loses all its descriptors moves to the one worst represented. Errors:
/// [`VocabularyError::NoWords`], [`VocabularyError::NoDescriptors`], [`VocabularyError::TooFewDescriptors`],
/// [`VocabularyError::NotFinite`].
pub fn train_kmeans(
    descriptors: &[Descriptor],
    words: usize,
    seed: u64,
    progress: &mut dyn FnMut(KMeansProgress),
) -> Result<(Vocabulary, TrainingRecord), VocabularyError> {
    check(descriptors, words)?;
    let mut rng = ChaCha12Rng::seed_from_u64(seed);
    let used = sample_distinct(descriptors, words, &mut rng)?;
    let mut centres = seeding::spread(&used, words, &mut rng);
    let mut iteration = 0;
    let mut last_error = f64::INFINITY;
    loop {
        let nearest = PackedWords::new(&centres).nearest(&used);
        let error = mean_squared_distance(&nearest);
        let quantisation_error = error.sqrt();
        progress(KMeansProgress { iteration, max_iterations: MAX_ITERATIONS, quantisation_error });
        if iteration == MAX_ITERATIONS || last_error - error <= ENOUGH * error {
            let record = TrainingRecord {
                words,
                descriptors: descriptors.len(),
                descriptors_used: used.len(),
                seed,
                iterations: iteration,
                quantisation_error,
            };
            return Ok((Vocabulary::from_words(&centres), record));
        }
        centres = move_centres(&used, nearest, &centres);
        last_error = error;
        iteration += 1;
    }
}

fn check(descriptors: &[Descriptor], words: usize) -> Result<(), VocabularyError> {
    if words == 0 {
        return Err(VocabularyError::NoWords);
    }
    if descriptors.is_empty() {
        return Err(VocabularyError::NoDescriptors);
    }
    check_finite("descriptor", descriptors)
}

/// The different descriptors in their order, or a sample of them (Knuth, TAOCP 3.4.2, algorithm S).
fn sample_distinct(
    descriptors: &[Descriptor],
    words: usize,
    rng: &mut ChaCha12Rng,
) -> Result<Vec<Descriptor>, VocabularyError> {
    let distinct = seeding::distinct(descriptors);
    if distinct.len() < words {
        return Err(VocabularyError::TooFewDescriptors { words, distinct: distinct.len() });
    }
    let size = distinct.len().min(words.saturating_mul(DESCRIPTORS_PER_WORD));
    let mut chosen = Vec::with_capacity(size);
    for (passed, &index) in distinct.iter().enumerate() {
        let (wanted, left) = ((size - chosen.len()) as u64, (distinct.len() - passed) as u64);
        if wanted == left || rng.random_range(0..left) < wanted {
            chosen.push(descriptors[index as usize]);
        }
    }
    Ok(chosen)
}

/// Each centre goes to the mean of its descriptors; a centre without any goes to the descriptor farthest from its own centre.
fn move_centres(descriptors: &[Descriptor], mut nearest: Vec<Nearest>, centres: &[Descriptor]) -> Vec<Descriptor> {
    let mut members = vec![0_u32; centres.len()];
    nearest.iter().for_each(|nearest| members[nearest.word as usize] += 1);
    let empty: Vec<usize> = (0..centres.len()).filter(|&centre| members[centre] == 0).collect();
    if !empty.is_empty() {
        let mut worst: Vec<usize> = (0..descriptors.len()).collect();
        worst.sort_by(|&a, &b| nearest[b].squared_distance.total_cmp(&nearest[a].squared_distance));
        let mut worst = worst.into_iter();
        for centre in empty {
            // A centre's only descriptor stays, or that centre would be the next without any.
            if let Some(index) = worst.find(|&index| members[nearest[index].word as usize] > 1) {
                members[nearest[index].word as usize] -= 1;
                nearest[index] = Nearest { word: centre as u32, squared_distance: 0.0 };
            }
        }
    }
    means(descriptors, &nearest, centres)
}

/// The mean of each centre's descriptors, summed in the descriptors' order; a centre without any stays where it is.
pub(super) fn means(descriptors: &[Descriptor], nearest: &[Nearest], centres: &[Descriptor]) -> Vec<Descriptor> {
    let mut members = vec![Vec::new(); centres.len()];
    for (index, nearest) in nearest.iter().enumerate() {
        members[nearest.word as usize].push(index);
    }
    let mean = |(members, centre): (&Vec<usize>, &Descriptor)| {
        if members.is_empty() {
            return *centre;
        }
        let mut sums = [0.0_f64; DIMENSIONS];
        for &index in members {
            sums.iter_mut().zip(&descriptors[index]).for_each(|(sum, &value)| *sum += f64::from(value));
        }
        sums.map(|sum| (sum / members.len() as f64) as f32)
    };
    members.par_iter().zip(centres).map(mean).collect()
}

/// Summed in the descriptors' order, so that the number of threads does not show.
fn mean_squared_distance(nearest: &[Nearest]) -> f64 {
    nearest.iter().map(|nearest| nearest.squared_distance).sum::<f64>() / nearest.len() as f64
}
