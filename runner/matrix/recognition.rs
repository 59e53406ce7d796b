//! How places are learnt, seen and verified.

use super::Trainer;
use serde::Deserialize;

/// The codebook to train.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CodebookSpec {
    /// Words in the vocabulary; given here or on the axis `words`. A sequential trainer finds out.
    #[serde(default)]
    pub words: u32,
    /// How they are found.
    #[serde(default)]
    pub trainer: Trainer,
    /// Sequential: descriptors farther than this (Euclidean) from every word become a word.
    #[serde(default = "usual_radius")]
    pub radius: f64,
    /// The route of the vocabulary traversals.
    pub route: String,
    /// At most so many images, evenly spread over the traversals.
    #[serde(default = "codebook_images")]
    pub images: usize,
}

fn codebook_images() -> usize {
    1000
}

/// Usual for SURF.
fn usual_radius() -> f64 {
    0.45
}

/// SURF's parameters.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct FeatureSpec {
    /// Smallest determinant of the Hessian.
    pub hessian: f64,
    /// Leave orientation upright: the camera of a ground robot is level.
    pub upright: bool,
}

impl Default for FeatureSpec {
    fn default() -> Self {
        Self { hessian: 400.0, upright: true }
    }
}

/// Verification by inliers.
#[derive(Debug, Clone, Deserialize, Default)]
#[serde(deny_unknown_fields, default)]
pub struct VerificationSpec {
    /// Inliers to reach. By default it is calibrated on wrong places of the vocabulary route.
    pub threshold: Option<u32>,
}
