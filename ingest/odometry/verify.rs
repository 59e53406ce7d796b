//! Verification of a candidate place (SPEC 7, thesis Fig 3.5): live left and right against the candidate's left, and its right where it has
//! one. A generated candidate has none, and the parent's must not stand in for it.

use crate::align::Patch;
use crate::bucket::best_of_buckets;
use crate::features::FrameFeatures;
use crate::index::Window;
use crate::matching::Match;
use crate::matching_afar::{Wide, mutual_best_afar};
use crate::motion::{Noise, Observation, Reprojection, Views, Weights};
use crate::params::VerifyParams;
use crate::ransac::consensus;
use crate::stereo::StereoFrame;
use furrow_model::{Se3, StereoRig};

/// What a live pair and a candidate have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct PairEstimate {
    /// Features found in both live images.
    pub stereo_matches: usize,
    /// Of these, matched with the candidate, kept by bucketing and confirmed: both live images look alike around them.
    pub matches: usize,
    /// Matches that agree on one rigid motion, 0 where that motion is refused: the number that decides whether the localisation is believed. Capped by bucketing.
    pub inliers: usize,
    /// The live camera's pose in the candidate's frame; `None` where nothing plausible was found.
    pub candidate_from_live: Option<Se3>,
    /// Largest standard deviation of that pose's translation components, in metres, from what the agreeing matches
    /// disagree by.
    pub sigma_m: Option<f64>,
    /// The agreeing matches, for drawing.
    pub correspondences: Vec<Correspondence>,
}

/// One point seen from both places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correspondence {
    /// (u, v) in the live left image, px.
    pub live_px: [f64; 2],
    /// (u, v) in the candidate's left image, px.
    pub candidate_px: [f64; 2],
}

/// Verifies one candidate. For many candidates of one live pair, build the [`StereoFrame`] once and call [`verify`].
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

/// Verifies one candidate of a live pair: matches left with left, mutually and without any guess of the motion; gives the live points their
/// depth; finds the motion most agree on.
pub fn verify(live: &StereoFrame, candidate: &FrameFeatures, rig: &StereoRig, params: &VerifyParams) -> PairEstimate {
    let matches = thin(live, match_left(live, candidate, params), params);
    let seen = |m: &Match| Place::of_left(candidate, m.b as usize);
    let observed = matches.iter().filter_map(|m| observe(live, m, &seen(m), rig, params)).collect();
    judge(live, observed, &Reprojection { rig, views: Views::Left, weights: Weights::Equal }, params)
}

/// Verifies a candidate that has a right image: pairs are matched with pairs, and the motion must explain all four images.
pub fn verify_four_view(
    live: &StereoFrame,
    candidate: &StereoFrame,
    rig: &StereoRig,
    params: &VerifyParams,
) -> PairEstimate {
    let window = |i| Some(search_window(live, live.index.u[i], live.index.v[i], params));
    let candidates = Wide::of(&candidate.index, candidate.matching_size());
    let matches = mutual_best_afar(&live.index, &candidates, params.ratio, window);
    let matches = thin(live, matches, params);
    let seen = |m: &Match| Place::of_pair(candidate, m.b as usize);
    let observed = matches.iter().filter_map(|m| observe(live, m, &seen(m), rig, params)).collect();
    judge(live, observed, &Reprojection { rig, views: Views::Stereo, weights: Weights::Equal }, params)
}

/// The verdict on what was observed: the motion that most observations agree on, refused where it is implausible or uncertain.
fn judge(
    live: &StereoFrame,
    observed: Vec<(Observation, Correspondence)>,
    reprojection: &Reprojection<'_>,
    params: &VerifyParams,
) -> PairEstimate {
    let observations: Vec<Observation> = observed.iter().map(|o| o.0).collect();
    let plausible =
        |motion: &Se3| motion.distance_m() <= params.max_distance_m && motion.yaw_rad().abs() <= params.max_yaw_rad;
    // Judged at the end only: a limit on the triples would bend the motion of a place beyond it until it fits inside.
    let found = consensus(reprojection, &observations, &Se3::IDENTITY, &params.ransac, |_| true)
        .filter(|found| found.inliers.len() >= params.ransac.min_inliers && plausible(&found.after_from_before))
        .map(|found| ((3..6).map(|i| found.covariance[(i, i)].sqrt()).fold(0.0, f64::max), found))
        .filter(|(sigma_m, _)| *sigma_m <= params.max_sigma_m);
    let agreeing = found.as_ref().map_or(&[][..], |(_, found)| &found.inliers);
    PairEstimate {
        stereo_matches: live.stereo_matches(),
        matches: observations.len(),
        inliers: agreeing.len(),
        candidate_from_live: found.as_ref().map(|(_, found)| found.after_from_before),
        sigma_m: found.as_ref().map(|(sigma_m, _)| *sigma_m),
        correspondences: agreeing.iter().map(|&i| observed[i].1).collect(),
    }
}

/// The circle candidate left, live left, live right, live left, closed in both directions: only live features with a mutual right match
/// enter, and left matches left mutually.
fn match_left(live: &StereoFrame, candidate: &FrameFeatures, params: &VerifyParams) -> Vec<Match> {
    let from = live.left_of_pairs();
    let window = |i| Some(search_window(live, from.u[i], from.v[i], params));
    mutual_best_afar(from, candidate.wide(), params.ratio, window)
}

/// Where the candidate may show what the live image shows at (u, v), in matching px.
fn search_window(live: &StereoFrame, u: i16, v: i16, params: &VerifyParams) -> Window {
    let (width, height) = live.matching_size();
    let columns = (params.search_columns * width as f64) as i32;
    let rows = (params.search_rows * height as f64) as i32;
    Window::around(i32::from(u), i32::from(v), columns, rows)
}

fn thin(live: &StereoFrame, matches: Vec<Match>, params: &VerifyParams) -> Vec<Match> {
    let places: Vec<_> = matches.iter().map(|m| live.coarse_px(m.a as usize).0.map(|px| px as f32)).collect();
    let distances: Vec<_> = matches.iter().map(|m| m.distance).collect();
    best_of_buckets(&places, &distances, &params.bucket).into_iter().map(|i| matches[i]).collect()
}

/// A feature of the candidate: where its left image has it, and its disparity in its right image, if any.
struct Place<'a> {
    left: &'a FrameFeatures,
    px: [f64; 2],
    right: Option<(&'a StereoFrame, f64)>,
}

impl<'a> Place<'a> {
    fn of_left(candidate: &'a FrameFeatures, feature: usize) -> Self {
        Self { left: candidate, px: candidate.position_px(feature).map(f64::from), right: None }
    }

    fn of_pair(candidate: &'a StereoFrame, pair: usize) -> Self {
        let (px, disparity_px) = candidate.coarse_px(pair);
        Self { left: &candidate.left, px, right: Some((candidate, disparity_px)) }
    }
}

/// The match as an observation, refined on the images themselves; `None` where the live disparity is not confirmed by them, and outside
/// the depths that the rig can measure.
///
/// A wrong place at a similar heading agrees with a live view on all that does not move when the camera does: clouds, and rows of equal
/// posts. With a disparity that no pair of patches confirms, such a point passes for a near one that did not move.
fn observe(
    live: &StereoFrame,
    m: &Match,
    seen: &Place<'_>,
    rig: &StereoRig,
    params: &VerifyParams,
) -> Option<(Observation, Correspondence)> {
    let (live_px, coarse_px) = live.coarse_px(m.a as usize);
    let patch = Patch::cut(&live.left.image, live_px)?;
    let disparity_px = live.confirmed_disparity_px(&patch, live_px, coarse_px, params.min_likeness)?;
    let candidate_px = patch.anywhere(&seen.left.image, seen.px).unwrap_or(seen.px);
    let right_u = match seen.right {
        None => 0.0,
        Some((pair, coarse_px)) => {
            let patch = Patch::cut(&seen.left.image, candidate_px)?;
            candidate_px[0] - pair.confirmed_disparity_px(&patch, candidate_px, coarse_px, params.min_likeness)?
        }
    };
    let point_m = rig.triangulate(live_px[0], live_px[1], disparity_px);
    let measurable = disparity_px >= params.stereo.min_disparity_px && point_m[2] >= params.stereo.near_m;
    let seen_px = [candidate_px[0], candidate_px[1], right_u];
    measurable
        .then_some((Observation { point_m, seen_px, noise: Noise::EQUAL }, Correspondence { live_px, candidate_px }))
}
