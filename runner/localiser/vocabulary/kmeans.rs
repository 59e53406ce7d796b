//! k-means: the vocabulary that furrow trains by default.

use super::check::check_finite;
use super::dimensions::{DIMENSIONS, Descriptor};
use super::error::VocabularyError;
use super::nearest::{Nearest, PackedWords};
use super::sample::TrainingSample;
use super::seeding;
use super::words::Vocabulary;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Rounds at most. Vocabularies change little after ten.
const MAX_ITERATIONS: usize = 15;
/// Rounds end when the squared error falls by less than this share.
const ENOUGH: f64 = 2e-3;

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

/// What a training needs to go on from, beside its sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KMeansCheckpoint {
    /// Rounds done.
    pub iteration: usize,
    /// Mean squared distance before the last of them; none before the first.
    pub squared_error: Option<f64>,
    /// The words as they are, 64 numbers each.
    pub words: Vec<f32>,
}

/// k-means (Lloyd 1982) under way, round by round, from a spread-out choice of descriptors. Equal samples and seeds
/// give equal bits on any number of threads, with or without a stop at a [`KMeansCheckpoint`] in between. A word that
/// loses all its descriptors moves to the one worst represented.
#[derive(Debug, Clone)]
pub struct KMeans {
    descriptors: Vec<Descriptor>,
    centres: Vec<Descriptor>,
    last_error: Option<f64>,
    record: TrainingRecord,
    is_finished: bool,
}

impl KMeans {
    /// Chooses the first words. Errors: [`VocabularyError::NoDescriptors`], [`VocabularyError::TooFewDescriptors`].
    pub fn start(sample: TrainingSample) -> Result<Self, VocabularyError> {
        let record = record_of(&sample, 0);
        let (descriptors, mut random) = sample.into_kept()?;
        let centres = seeding::spread(&descriptors, record.words, &mut random);
        Ok(Self { descriptors, centres, last_error: None, record, is_finished: false })
    }

    /// Takes up a training of the same sample where `checkpoint` was made. Errors: those of [`KMeans::start`],
    /// [`VocabularyError::WrongCheckpoint`], [`VocabularyError::NotFinite`].
    pub fn resume(sample: TrainingSample, checkpoint: KMeansCheckpoint) -> Result<Self, VocabularyError> {
        let record = record_of(&sample, checkpoint.iteration);
        let (descriptors, _) = sample.into_kept()?;
        let (centres, rest) = checkpoint.words.as_chunks::<DIMENSIONS>();
        if centres.len() != record.words || !rest.is_empty() {
            let numbers = checkpoint.words.len();
            return Err(VocabularyError::WrongCheckpoint { numbers, words: record.words });
        }
        check_finite("word", centres)?;
        let (centres, last_error) = (centres.to_vec(), checkpoint.squared_error);
        Ok(Self { descriptors, centres, last_error, record, is_finished: false })
    }

    /// What [`KMeans::resume`] takes, as of the last finished round.
    pub fn checkpoint(&self) -> KMeansCheckpoint {
        KMeansCheckpoint {
            iteration: self.record.iterations,
            squared_error: self.last_error,
            words: self.centres.as_flattened().to_vec(),
        }
    }

    /// Whether more rounds would change too little to matter.
    pub fn is_finished(&self) -> bool {
        self.is_finished
    }

    /// One round: every descriptor to its nearest word; then, unless that is good enough, every word to the mean of its
    /// descriptors.
    pub fn step(&mut self) -> KMeansProgress {
        let nearest = PackedWords::new(&self.centres).nearest(&self.descriptors);
        let error = mean_squared_distance(&nearest);
        let iteration = self.record.iterations;
        self.record.quantisation_error = error.sqrt();
        self.is_finished = iteration >= MAX_ITERATIONS
            || self.last_error.is_some_and(|last_error| last_error - error <= ENOUGH * error);
        if !self.is_finished {
            self.centres = move_centres(&self.descriptors, nearest, &self.centres);
            self.last_error = Some(error);
            self.record.iterations += 1;
        }
        KMeansProgress { iteration, max_iterations: MAX_ITERATIONS, quantisation_error: error.sqrt() }
    }

    /// The vocabulary, after the rounds that are left.
    pub fn finish(self) -> (Vocabulary, TrainingRecord) {
        self.run(&mut |_| ())
    }

    /// [`KMeans::finish`], telling `progress` of each round.
    pub fn run(mut self, progress: &mut dyn FnMut(KMeansProgress)) -> (Vocabulary, TrainingRecord) {
        while !self.is_finished {
            progress(self.step());
        }
        (Vocabulary::from_words(&self.centres), self.record)
    }
}

/// The record of a training that has not measured its error yet.
fn record_of(sample: &TrainingSample, iterations: usize) -> TrainingRecord {
    TrainingRecord {
        words: sample.words(),
        descriptors: sample.offered(),
        descriptors_used: sample.kept(),
        seed: sample.seed(),
        iterations,
        quantisation_error: f64::INFINITY,
    }
}

/// Trains a vocabulary of `words` words by [`KMeans`] on a [`TrainingSample`] of `descriptors`. Errors:
/// [`VocabularyError::NoWords`], [`VocabularyError::NoDescriptors`], [`VocabularyError::TooFewDescriptors`],
/// [`VocabularyError::NotFinite`].
pub fn train_kmeans(
    descriptors: &[Descriptor],
    words: usize,
    seed: u64,
    progress: &mut dyn FnMut(KMeansProgress),
) -> Result<(Vocabulary, TrainingRecord), VocabularyError> {
    let mut sample = TrainingSample::new(words, seed)?;
    sample.offer(descriptors)?;
    Ok(KMeans::start(sample)?.run(progress))
}

/// Each centre goes to the mean of its descriptors; a centre without any goes to the descriptor farthest from its own
/// centre.
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
