//! How the motion between two stereo frames is estimated, and when it is accepted.

use super::features::MatcherParams;
use super::matching::{BucketParams, StereoParams, SupportParams};
use furrow_model::Se3;
use serde::{Deserialize, Serialize};

/// RANSAC: how a motion is found among matches of which many may be wrong.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RansacParams {
    /// Seed of the sampling. Equal seeds give equal bits.
    pub seed: u64,
    /// Most samples drawn.
    #[serde(rename = "max_rounds")]
    pub max_iterations: u32,
    /// Sampling stops when a better motion has been missed with a probability of at most 1 - confidence.
    pub confidence: f64,
    /// A match is an inlier of a motion if its residual vector is shorter than this, in image px.
    pub inlier_px: f64,
    /// Fewer inliers are a failure.
    pub min_inliers: usize,
}

/// Stereo odometry: four views.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OdometryParams {
    /// Features.
    pub matcher: MatcherParams,
    /// Left-right matches.
    pub stereo: StereoParams,
    /// Greatest flow of the first, sparse search, in image px, along each axis.
    pub search_radius_px: f64,
    /// Greatest distance from the place that the sparse motion predicts, in image px.
    pub guided_radius_px: f64,
    /// Outlier removal by neighbours.
    pub support: SupportParams,
    /// Thinning.
    pub bucket: BucketParams,
    /// RANSAC.
    pub ransac: RansacParams,
    /// A disparity at least this large, in image px, is used unrefined where refinement fails.
    pub near_disparity_px: f64,
    /// Least share of inliers among all matches, refined or not. A stretch of street has a few features in common with
    /// any other, and those agree on a motion of zero.
    pub min_inlier_share: f64,
    /// A longer step is implausible, in metres.
    pub max_step_m: f64,
    /// A larger rotation in one step is implausible, in radians.
    pub max_turn_rad: f64,
    /// Relative error of the rig's focal length and baseline: this share of a step's length stays uncertain however
    /// many matches agree.
    pub calibration_error: f64,
    /// A step whose translation has a larger standard deviation is a failure, in metres.
    #[serde(rename = "max_sigma_m")]
    pub max_std_m: f64,
    /// The chain's second try for doubtful steps.
    pub second_try: SecondTryParams,
}

/// When a chain matches two frames again, near the motion that the steps before predict.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondTryParams {
    /// A step with fewer inliers is tried again ...
    pub sure_inliers: usize,
    /// ... and one with a smaller share of inliers among its matches.
    pub sure_share: f64,
    /// A first try with fewer inliers is replaced by the second even if that one fails: in a wide search so few may
    /// agree by chance.
    pub doubtful_inliers: usize,
    /// [`OdometryParams::min_inlier_share`] of the second try. It is smaller: a predicted motion needs less evidence.
    pub min_inlier_share: f64,
}

impl OdometryParams {
    /// Whether a vehicle could have made the step.
    pub(crate) fn is_plausible(&self, motion: &Se3) -> bool {
        motion.distance_m() <= self.max_step_m && motion.angle_rad() <= self.max_turn_rad
    }
}

impl Default for OdometryParams {
    fn default() -> Self {
        Self {
            matcher: MatcherParams::default(),
            stereo: StereoParams::default(),
            search_radius_px: 200.0,
            guided_radius_px: 12.0,
            support: SupportParams::default(),
            bucket: BucketParams { side_px: 50, matches: 3 },
            ransac: RansacParams { seed: 0, max_iterations: 200, confidence: 0.9999, inlier_px: 2.0, min_inliers: 10 },
            near_disparity_px: 8.0,
            min_inlier_share: 0.2,
            max_step_m: 15.0,
            max_turn_rad: 0.8,
            calibration_error: 0.005,
            max_std_m: 0.5,
            second_try: SecondTryParams {
                sure_inliers: 40,
                sure_share: 0.4,
                doubtful_inliers: 30,
                min_inlier_share: 0.12,
            },
        }
    }
}
