//! Verification of a candidate place by a live stereo pair (the thesis, section 3.5 and Fig. 3.5): live left and right
//! against the candidate's left image, and its right one if there is one. A generated candidate has no right image, and
//! must not use that of its parent.

use super::correspondence::Correspondence;
use super::observe::{CandidateFeature, observe};
use crate::features::{FrameFeatures, WholeImage, Window};
use crate::matching::{Match, StereoFrame, match_whole_image, select_best_of_buckets};
use crate::motion::{Observation, Reprojection, Views, Weights, find_consensus};
use crate::params::VerifyParams;
use furrow_model::{Se3, StereoRig};

/// What a live pair and a candidate have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct PairEstimate {
    /// Features found in both live images.
    pub stereo_matches: usize,
    /// Of these, matched with the candidate, kept by bucketing, and confirmed: both live images correlate around them.
    pub matches: usize,
    /// Matches that agree on one rigid motion, 0 if that motion is refused: the number that decides whether the
    /// localisation is accepted. Bucketing limits it.
    pub inliers: usize,
    /// The live camera's pose in the candidate's frame. `None` if nothing plausible was found.
    pub candidate_from_live: Option<Se3>,
    /// Largest standard deviation of that pose's translation components, in metres, from the residuals of the inliers.
    pub std_m: Option<f64>,
    /// The inliers, for drawing.
    pub correspondences: Vec<Correspondence>,
}

/// Verifies one candidate by three views. For many candidates of one live pair, build the [`StereoFrame`] once and call
/// [`verify`].
pub fn verify_three_view(
    live_left: &FrameFeatures,
    live_right: &FrameFeatures,
    candidate_left: &FrameFeatures,
    rig: &StereoRig,
    params: &VerifyParams,
) -> PairEstimate {
    let live = StereoFrame::new(live_left.clone(), live_right.clone(), rig, &params.stereo);
    verify(&live, candidate_left, rig, params)
}

/// Verifies one candidate of a live pair by three views: matches left with left, mutually and without a prediction of
/// the motion, triangulates the live points, and finds the motion with which most agree.
pub fn verify(live: &StereoFrame, candidate: &FrameFeatures, rig: &StereoRig, params: &VerifyParams) -> PairEstimate {
    let matches = thin(live, match_left(live, candidate, params), params);
    let seen = |m: &Match| CandidateFeature::in_left(candidate, m.b as usize);
    let observed = matches.iter().filter_map(|m| observe(live, m, &seen(m), rig, params)).collect();
    judge(live, observed, &Reprojection { rig, views: Views::Left, weights: Weights::Equal }, params)
}

/// Verifies a candidate that has a right image: pairs are matched with pairs, and the motion must fit all four images.
pub fn verify_four_view(
    live: &StereoFrame,
    candidate: &StereoFrame,
    rig: &StereoRig,
    params: &VerifyParams,
) -> PairEstimate {
    let window = |i| Some(search_window(live, live.index.u[i], live.index.v[i], params));
    let candidates = WholeImage::new(&candidate.index, candidate.matching_size());
    let matches = match_whole_image(&live.index, &candidates, params.ratio, window);
    let matches = thin(live, matches, params);
    let seen = |m: &Match| CandidateFeature::in_pair(candidate, m.b as usize);
    let observed = matches.iter().filter_map(|m| observe(live, m, &seen(m), rig, params)).collect();
    judge(live, observed, &Reprojection { rig, views: Views::Stereo, weights: Weights::Equal }, params)
}

/// The motion with which most observations agree, refused if it is implausible or uncertain.
fn judge(
    live: &StereoFrame,
    observed: Vec<(Observation, Correspondence)>,
    reprojection: &Reprojection<'_>,
    params: &VerifyParams,
) -> PairEstimate {
    let observations: Vec<Observation> = observed.iter().map(|o| o.0).collect();
    let is_plausible =
        |motion: &Se3| motion.distance_m() <= params.max_distance_m && motion.yaw_rad().abs() <= params.max_yaw_rad;
    // Tested at the end only: with a limit on the triples, a place beyond it would give a wrong motion within it.
    let found = find_consensus(reprojection, &observations, &Se3::IDENTITY, &params.ransac, |_| true)
        .filter(|found| found.inliers.len() >= params.ransac.min_inliers && is_plausible(&found.after_from_before))
        .map(|found| ((3..6).map(|i| found.covariance[(i, i)].sqrt()).fold(0.0, f64::max), found))
        .filter(|(std_m, _)| *std_m <= params.max_std_m);
    let inliers = found.as_ref().map_or(&[][..], |(_, found)| &found.inliers);
    PairEstimate {
        stereo_matches: live.stereo_matches(),
        matches: observations.len(),
        inliers: inliers.len(),
        candidate_from_live: found.as_ref().map(|(_, found)| found.after_from_before),
        std_m: found.as_ref().map(|(std_m, _)| *std_m),
        correspondences: inliers.iter().map(|&i| observed[i].1).collect(),
    }
}

/// Matches around the circle candidate left, live left, live right, closed in both directions: only live features with
/// a mutual match in the right image are used, and left images are matched mutually.
fn match_left(live: &StereoFrame, candidate: &FrameFeatures, params: &VerifyParams) -> Vec<Match> {
    let from = live.left_of_pairs();
    let window = |i| Some(search_window(live, from.u[i], from.v[i], params));
    match_whole_image(from, candidate.whole_image(), params.ratio, window)
}

/// Where the candidate may show the point that the live image shows at (u, v), in matching px.
fn search_window(live: &StereoFrame, u: i16, v: i16, params: &VerifyParams) -> Window {
    let (width, height) = live.matching_size();
    let columns = (params.search_columns * width as f64) as i32;
    let rows = (params.search_rows * height as f64) as i32;
    Window::around(i32::from(u), i32::from(v), columns, rows)
}

/// The best matches of each bucket of the live left image.
fn thin(live: &StereoFrame, matches: Vec<Match>, params: &VerifyParams) -> Vec<Match> {
    let places: Vec<_> = matches.iter().map(|m| live.coarse_px(m.a as usize).0.map(|px| px as f32)).collect();
    let distances: Vec<_> = matches.iter().map(|m| m.distance).collect();
    select_best_of_buckets(&places, &distances, &params.bucket).into_iter().map(|i| matches[i]).collect()
}
