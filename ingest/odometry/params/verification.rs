//! How a candidate is verified.

use super::features::MatcherParams;
use super::matching::{BucketParams, StereoParams};
use super::motion::RansacParams;
use serde::{Deserialize, Serialize};

/// Verification of a candidate by three or four views: the live left and right images against the candidate's left one,
/// and its right one if there is one (the thesis, section 3.5 and Fig. 3.5).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VerifyParams {
    /// Features. Cached [`FrameFeatures`](crate::FrameFeatures) must have been extracted with the same.
    pub matcher: MatcherParams,
    /// Left-right matches of the live pair.
    pub stereo: StereoParams,
    /// Greatest difference of columns searched, as a fraction of the image's width.
    pub search_columns: f64,
    /// Greatest difference of rows searched, as a fraction of the image's height.
    pub search_rows: f64,
    /// Ratio test: the distance of the best match must be below this fraction of the second best's (Lowe 2004). 1 keeps
    /// all mutually best matches.
    pub ratio: f64,
    /// Thinning. Inlier counts depend on it.
    pub bucket: BucketParams,
    /// RANSAC.
    pub ransac: RansacParams,
    /// A match is kept if the patches around it in both live images correlate by at least this.
    #[serde(rename = "min_likeness")]
    pub min_correlation: f32,
    /// A candidate farther away is refused, in metres.
    pub max_distance_m: f64,
    /// A candidate with a larger difference of heading is refused, in radians.
    pub max_yaw_rad: f64,
    /// A motion whose translation has a larger standard deviation is refused, in metres.
    #[serde(rename = "max_sigma_m")]
    pub max_std_m: f64,
}

impl Default for VerifyParams {
    fn default() -> Self {
        Self {
            matcher: MatcherParams::default(),
            stereo: StereoParams::default(),
            search_columns: 0.33,
            search_rows: 0.25,
            ratio: 0.95,
            bucket: BucketParams { side_px: 25, matches: 2 },
            ransac: RansacParams { seed: 0, max_iterations: 1000, confidence: 0.999, inlier_px: 2.0, min_inliers: 6 },
            min_correlation: 0.8,
            max_distance_m: 4.0,
            max_yaw_rad: std::f64::consts::FRAC_PI_4,
            max_std_m: 0.5,
        }
    }
}

/// Verification of a candidate by two views: a single live image against the candidate's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TwoViewParams {
    /// Thinning by places in the live image. Inlier counts depend on it.
    pub bucket: BucketParams,
    /// RANSAC. A `min_inliers` below 8 has no effect: any 7 matches agree on some geometry.
    pub ransac: RansacParams,
}

impl Default for TwoViewParams {
    fn default() -> Self {
        Self {
            bucket: BucketParams { side_px: 25, matches: 2 },
            ransac: RansacParams { seed: 0, max_iterations: 2000, confidence: 0.999, inlier_px: 1.5, min_inliers: 8 },
        }
    }
}
