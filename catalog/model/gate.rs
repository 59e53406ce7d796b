//! What the quality gate measures of a generator. The runner computes these numbers; reports only draw them.
//!
//! Equations are those of the thesis (Church 2023).

use serde::{Deserialize, Serialize};

/// What was measured at one domainness, as means over the sample of images.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Measures {
    /// The domainness.
    pub z: f64,
    /// Descriptors of a source image that have two neighbours among the generated image's (M of Eq. 5.6).
    pub matchable: f64,
    /// Those whose nearest neighbour is nearer than half the second (M_good).
    pub good_matches: f64,
    /// The mean absolute difference of descriptors at the source's keypoints, per number (Eq. 5.4).
    pub descriptor_distance: f64,
    /// The share that is lost times the distance (Eqs. 5.7 and 5.8).
    pub descriptor_loss: f64,
    /// Energy of the Laplacian over the source's.
    pub laplacian_ratio: f64,
    /// The share of clipped pixels.
    pub clipped: f64,
    /// That of the source.
    pub clipped_source: f64,
    /// That of the images which the generator was trained to mimic; none where there are none.
    pub clipped_target: Option<f64>,
    /// The share of keypoints where the source shows nothing.
    pub hallucinated: f64,
}

impl Measures {
    /// The share of descriptors that are still matched well; 1 where there are none.
    pub fn retention(&self) -> f64 {
        if self.matchable > 0.0 { self.good_matches / self.matchable } else { 1.0 }
    }
}

/// Whether a generator moves evenly or switches (Church 2023, section 5.4, Fig. 5.6).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SwitchIndex {
    /// Largest step over the median one plus 0.05 grey levels: about 1 for an even way.
    pub kappa: f64,
    /// The middle of the largest step, in domainness.
    pub at: f64,
    /// The largest step in grey levels.
    pub largest: f64,
}

/// Added to the median step, in grey levels: a generator that hardly moves is not one that switches.
const STILL: f64 = 0.05;

impl SwitchIndex {
    /// Above this `kappa`, with the largest step in the middle, a generator switches.
    pub const KAPPA_LIMIT: f64 = 4.0;
    /// What is the middle, in domainness.
    pub const MIDDLE: [f64; 2] = [0.35, 0.65];

    /// From the steps between neighbours on an even ladder of domainnesses from 0 to 1, in grey levels; none without
    /// steps.
    pub fn of(steps: &[f64]) -> Option<Self> {
        let (most, largest) =
            steps.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0)))?;
        let mut sorted = steps.to_vec();
        sorted.sort_by(f64::total_cmp);
        let middle = sorted.len() / 2;
        let median = if sorted.len() % 2 == 1 { sorted[middle] } else { (sorted[middle - 1] + sorted[middle]) / 2.0 };
        let at = (most as f64 + 0.5) / steps.len() as f64;
        Some(Self { kappa: largest / (median + STILL), at, largest })
    }

    /// Whether the generator switches in the middle.
    pub fn switches(&self) -> bool {
        self.kappa > Self::KAPPA_LIMIT && (Self::MIDDLE[0]..=Self::MIDDLE[1]).contains(&self.at)
    }
}
