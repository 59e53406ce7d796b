//! How features are matched, and which matches are kept.

use serde::{Deserialize, Serialize};

/// Which left-right matches are accepted.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StereoParams {
    /// Greatest difference of rows, in matching px: the error that rectification leaves.
    pub epipolar_tolerance_px: u32,
    /// Nearest depth searched, in metres.
    pub near_m: f64,
    /// Greatest disparity searched, in image px, where `near_m` would allow more.
    pub max_disparity_px: f64,
    /// Least disparity that gives a depth, in image px. It sets the far limit f B / d: 40 m for a ZED 2i at 640x360,
    /// 480 m for KITTI.
    pub min_disparity_px: f64,
}

impl Default for StereoParams {
    fn default() -> Self {
        Self { epipolar_tolerance_px: 1, near_m: 0.5, max_disparity_px: 200.0, min_disparity_px: 0.8 }
    }
}

/// Outlier removal by the flow of neighbouring matches (Geiger et al. 2011, section III-A).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SupportParams {
    /// How many of the nearest matches are compared.
    pub neighbours: usize,
    /// How many of them must agree.
    pub supporters: usize,
    /// A neighbour agrees if its flow differs by at most this, in image px, along each axis ...
    pub flow_tolerance_px: f32,
    /// ... and its disparity by at most this, in image px.
    pub disparity_tolerance_px: f32,
}

impl Default for SupportParams {
    fn default() -> Self {
        Self { neighbours: 8, supporters: 2, flow_tolerance_px: 5.0, disparity_tolerance_px: 5.0 }
    }
}

/// Bucketing: matches are thinned so that they cover the image evenly. Of each bucket the best are kept, by descriptor
/// distance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BucketParams {
    /// Side of a bucket in image px.
    pub side_px: usize,
    /// Matches kept per bucket. This and the image's area limit the inlier counts: record it with them.
    pub matches: usize,
}
