//! Codebooks, and the features that they and all words rest on.

use super::record::Record;
use furrow_model::ObjectId;
use serde::{Deserialize, Serialize};

/// A codebook: vocabulary, Chow-Liu tree and sample descriptors, each a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CodebookRecord {
    /// The site its images come from.
    pub site: String,
    /// The routes they come from; nothing may be judged on these.
    pub route: String,
    /// Left images that it was trained on, in order.
    pub images: Vec<ObjectId>,
    /// Words in the vocabulary.
    pub words: u32,
    /// How features were found in the images.
    pub features: FeatureParameters,
    /// The trainer and its version.
    pub trainer: String,
    /// The trainer's seed.
    pub seed: u64,
    /// Root mean square distance of the training descriptors to their words.
    pub quantisation_error: f64,
    /// The vocabulary: a row per word.
    pub vocabulary: ObjectId,
    /// The tree: a row per word.
    pub tree: ObjectId,
    /// The sample descriptors: a row per image and word.
    pub samples: ObjectId,
}

impl Record for CodebookRecord {
    const KIND: &'static str = "codebook";
    const VERSION: u32 = 1;
}

/// SURF's parameters, as records and keys spell them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FeatureParameters {
    /// Smallest determinant of the Hessian.
    pub hessian: f64,
    /// Whether orientation is left at upright.
    pub upright: bool,
}
