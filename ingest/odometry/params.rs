//! Every parameter, with its unit and its default. The records are serialisable because a cell's key hashes them.

use serde::{Deserialize, Serialize};

/// At what resolution features are found and compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MatchingScale {
    /// As recorded.
    Full,
    /// Half, whatever the image (Geiger's setting for 1.3 MP cameras).
    Half,
    /// Half for images of 960 columns and more, else full: small images have no detail to spare.
    Auto,
}

/// How features are found (Geiger et al. 2011, section III A).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MatcherParams {
    /// Resolution of the matching image; its pixels are "matching px" below.
    pub scale: MatchingScale,
    /// A feature is the extreme of its class within this many matching px (Chebyshev distance).
    pub nms_radius_px: usize,
    /// Least magnitude of the filter response (blob at most 4080, corner 2040).
    pub nms_threshold: i16,
    /// The sparse subset, which gives the first guess of the motion, is extreme within this many matching px.
    pub sparse_radius_px: usize,
}

impl Default for MatcherParams {
    fn default() -> Self {
        Self { scale: MatchingScale::Auto, nms_radius_px: 3, nms_threshold: 50, sparse_radius_px: 9 }
    }
}

/// Which left-right matches are believed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StereoParams {
    /// Greatest difference of rows, in matching px: what rectification leaves.
    pub epipolar_tolerance_px: u32,
    /// Nearest depth searched, in metres.
    pub near_m: f64,
    /// Greatest disparity searched, in image px, where `near_m` would ask for more.
    pub max_disparity_px: f64,
    /// Least disparity that still gives a depth, in image px. It sets the far limit f B / d: 40 m for a ZED 2i at 640x360, 480 m for KITTI.
    pub min_disparity_px: f64,
}

impl Default for StereoParams {
    fn default() -> Self {
        Self { epipolar_tolerance_px: 1, near_m: 0.5, max_disparity_px: 200.0, min_disparity_px: 0.8 }
    }
}

/// Which matches their neighbours support (Geiger's outlier removal).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SupportParams {
    /// How many of the nearest matches are asked.
    pub neighbours: usize,
    /// How many of them must agree.
    pub supporters: usize,
    /// A neighbour agrees when its flow differs by no more than this, in image px, each direction ...
    pub flow_tolerance_px: f32,
    /// ... and its disparity by no more than this, in image px.
    pub disparity_tolerance_px: f32,
}

impl Default for SupportParams {
    fn default() -> Self {
        Self { neighbours: 8, supporters: 2, flow_tolerance_px: 5.0, disparity_tolerance_px: 5.0 }
    }
}

/// How matches are thinned so that they cover the image evenly: the best of each bucket are kept, by descriptor distance.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BucketParams {
    /// Side of a bucket in image px.
    pub side_px: usize,
    /// Matches kept per bucket. Inlier counts are capped by this and by the image's area: record it with them.
    pub matches: usize,
}

/// How the motion is found among matches of which many may be wrong.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RansacParams {
    /// Seed of the sampling; equal seeds give equal bits.
    pub seed: u64,
    /// Most rounds of three points.
    pub max_rounds: u32,
    /// Rounds stop once a better motion has been missed with a probability of at most 1 - confidence.
    pub confidence: f64,
    /// A match agrees with a motion when its residual vector is shorter than this, in image px.
    pub inlier_px: f64,
    /// Fewer agreeing matches are a failure.
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
    /// Greatest flow of the first, sparse search, in image px, each direction.
    pub search_radius_px: f64,
    /// Greatest distance from the place that the sparse motion predicts, in image px.
    pub guided_radius_px: f64,
    /// Neighbour support.
    pub support: SupportParams,
    /// Thinning.
    pub bucket: BucketParams,
    /// Sampling.
    pub ransac: RansacParams,
    /// A disparity at least this large, in image px, is believed to the pixel where it cannot be refined.
    pub near_disparity_px: f64,
    /// A motion with which a smaller share of all matches agrees, refined or not, is a failure: what little a stretch of street has in common with another
    /// agrees on standing still.
    pub min_inlier_share: f64,
    /// A longer step is implausible, in metres.
    pub max_step_m: f64,
    /// A larger turn in one step is implausible, in radians.
    pub max_turn_rad: f64,
    /// What a rig's focal length and baseline may be wrong by, as a share: so much of a step's length is uncertain however many matches agree.
    pub calibration_error: f64,
    /// A step whose translation is less certain than this (one standard deviation, metres) is a failure.
    pub max_sigma_m: f64,
    /// The chain's second try, where the first is not sure.
    pub second_try: SecondTryParams,
}

/// When and how a chain looks again where the motion of the frames before says.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SecondTryParams {
    /// A step with fewer inliers is tried again ...
    pub sure_inliers: usize,
    /// ... and one with a smaller share of its matches.
    pub sure_share: f64,
    /// A first try with fewer inliers gives way to the second even where that one fails: so few may agree by chance in a wide search.
    pub doubtful_inliers: usize,
    /// What [`OdometryParams::min_inlier_share`] is where the search is guided: a motion that nobody expected needs more to speak for it.
    pub min_inlier_share: f64,
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
            ransac: RansacParams { seed: 0, max_rounds: 200, confidence: 0.9999, inlier_px: 2.0, min_inliers: 10 },
            near_disparity_px: 8.0,
            min_inlier_share: 0.2,
            max_step_m: 15.0,
            max_turn_rad: 0.8,
            calibration_error: 0.005,
            max_sigma_m: 0.5,
            second_try: SecondTryParams {
                sure_inliers: 40,
                sure_share: 0.4,
                doubtful_inliers: 30,
                min_inlier_share: 0.12,
            },
        }
    }
}

/// Verification of a candidate: live left and right against the candidate's left (SPEC 7).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VerifyParams {
    /// Features; those of cached [`FrameFeatures`](crate::FrameFeatures) must have been found with the same.
    pub matcher: MatcherParams,
    /// Left-right matches of the live pair.
    pub stereo: StereoParams,
    /// Greatest difference of columns searched, as a fraction of the image's width.
    pub search_columns: f64,
    /// Greatest difference of rows searched, as a fraction of the image's height.
    pub search_rows: f64,
    /// A match is kept when its descriptor distance is below this fraction of the second best's; 1 keeps all mutual best.
    pub ratio: f64,
    /// Thinning; inlier counts depend on it.
    pub bucket: BucketParams,
    /// Sampling.
    pub ransac: RansacParams,
    /// A match is confirmed when the patches around it in both live images correlate by at least this.
    pub min_likeness: f32,
    /// A candidate farther away than this is refused, in metres.
    pub max_distance_m: f64,
    /// A candidate turned by more than this about the vertical axis is refused, in radians.
    pub max_yaw_rad: f64,
    /// A motion whose translation is less certain than this (one standard deviation, metres) is refused.
    pub max_sigma_m: f64,
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
            ransac: RansacParams { seed: 0, max_rounds: 1000, confidence: 0.999, inlier_px: 2.0, min_inliers: 6 },
            min_likeness: 0.8,
            max_distance_m: 4.0,
            max_yaw_rad: std::f64::consts::FRAC_PI_4,
            max_sigma_m: 0.5,
        }
    }
}
