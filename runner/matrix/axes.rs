//! The axes: what meets what, in which settings.

use super::{ExperienceEntry, ThresholdEntry, TraversalEntry, entries};
use furrow_localiser::hub::Policy;
use furrow_model::KeyframePolicy;
use serde::Deserialize;
use toml::Spanned;

/// The axes: every live entry meets every experience entry, in every setting of the others.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Axes {
    /// Evaluation traversals.
    pub live: Vec<TraversalEntry>,
    /// What they localise against.
    #[serde(deserialize_with = "entries::experiences")]
    pub experience: Vec<Spanned<ExperienceEntry>>,
    /// Words of the codebook.
    pub words: Option<Vec<u32>>,
    /// Most images that the codebook is trained on.
    pub images: Option<Vec<usize>>,
    /// How experiences are sub-sampled.
    pub keyframes: Option<Vec<KeyframePolicy>>,
    /// Inliers to reach.
    pub threshold: Option<Vec<ThresholdEntry>>,
    /// Place recognisers.
    pub method: Option<Vec<Spanned<String>>>,
    /// Policies of collectives that name none.
    pub policy: Option<Vec<Policy>>,
    /// Seeds: repeats of everything that is drawn at random.
    pub seed: Option<Vec<u64>>,
}
