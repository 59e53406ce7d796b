//! The parameters of FAB-MAP's observation model.

use serde::{Deserialize, Serialize};

/// How a new place's likelihood is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NewPlace {
    /// The average place, where P(e) is the word's frequency.
    MeanField,
    /// The mean likelihood over the sample images.
    Samples,
}

/// How the words of one image hang together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WordDependence {
    /// Each on its parent in the Chow-Liu tree.
    ChowLiu,
    /// Not at all; for comparison.
    NaiveBayes,
}

/// The observation model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FabMapParams {
    /// P(z = 1 | e = 1): a thing that is there is seen.
    pub p_detect_present: f64,
    /// P(z = 1 | e = 0): a thing is seen that is not there.
    pub p_detect_absent: f64,
    /// The share of the posterior that is believed; the rest is spread evenly over all places and the new one.
    pub smoothing: f64,
    /// The new place's model.
    pub new_place: NewPlace,
    /// The words' model.
    pub words: WordDependence,
}

impl FabMapParams {
    /// openFABMAP's settings for FAB-MAP 2.0: 0.39, 0, 0.99, samples, Chow-Liu.
    pub const OPENFABMAP: Self = Self {
        p_detect_present: 0.39,
        p_detect_absent: 0.0,
        smoothing: 0.99,
        new_place: NewPlace::Samples,
        words: WordDependence::ChowLiu,
    };
}
