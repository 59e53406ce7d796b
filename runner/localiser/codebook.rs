//! A codebook: everything FAB-MAP must have learned before it sees a mapped place.

use crate::chow_liu::{self, ChowLiuError, ChowLiuTree};
use crate::presence::Presence;
use crate::vocabulary::{
    Descriptor, KMeans, KMeansProgress, TrainingRecord, TrainingSample, Vocabulary, VocabularyError,
};
use rayon::prelude::*;

/// What a codebook is trained with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CodebookParams {
    /// Words in the vocabulary; the thesis chose 6000.
    pub words: usize,
    /// Seed of the vocabulary's training.
    pub seed: u64,
    /// Least information of a tree's edge; openFABMAP's default is 0.0005, 0 gives one tree over all words.
    pub information_threshold_nats: f64,
}

/// Vocabulary, Chow-Liu tree and samples of one set of images.
#[derive(Debug, Clone, PartialEq)]
pub struct Codebook {
    /// The words.
    pub vocabulary: Vocabulary,
    /// How they hang together.
    pub tree: ChowLiuTree,
    /// The presences of the training images, in their order: the samples of a new place.
    pub samples: Vec<Presence>,
}

/// Why a codebook could not be trained.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CodebookError {
    /// The vocabulary could not.
    #[error(transparent)]
    Vocabulary(#[from] VocabularyError),
    /// The tree could not.
    #[error(transparent)]
    Tree(#[from] ChowLiuError),
}

impl Codebook {
    /// Trains a codebook from the descriptors of each image of a vocabulary traversal: vocabulary, then the words of
    /// every image, then the tree over them; the images become the samples. The run must not touch ground that will be
    /// mapped (see [`crate::FabMap`]).
    pub fn train(
        images: &[Vec<Descriptor>],
        params: &CodebookParams,
        progress: &mut dyn FnMut(KMeansProgress),
    ) -> Result<(Self, TrainingRecord), CodebookError> {
        let (vocabulary, record) = KMeans::start(Self::sample(images, params)?)?.run(progress);
        Ok((Self::of_vocabulary(vocabulary, images, params)?, record))
    }

    /// What the vocabulary of [`Codebook::train`] is trained on. Callers that keep checkpoints run [`KMeans`] on it
    /// themselves.
    pub fn sample(images: &[Vec<Descriptor>], params: &CodebookParams) -> Result<TrainingSample, VocabularyError> {
        let mut sample = TrainingSample::new(params.words, params.seed)?;
        images.iter().try_for_each(|image| sample.offer(image))?;
        Ok(sample)
    }

    /// The rest of [`Codebook::train`]: the words of every image, and the tree over them.
    pub fn of_vocabulary(
        vocabulary: Vocabulary,
        images: &[Vec<Descriptor>],
        params: &CodebookParams,
    ) -> Result<Self, CodebookError> {
        let samples = images.par_iter().map(|image| vocabulary.presence(image)).collect::<Result<Vec<_>, _>>()?;
        let tree = chow_liu::train(&samples, params.words, params.information_threshold_nats)?;
        Ok(Self { vocabulary, tree, samples })
    }
}
