//! Verification of a candidate place (SPEC 7, thesis Fig 3.5): live left and right against the candidate's left. The candidate may be a
//! generated image, which has no right one.

use crate::align::Patch;
use crate::bucket::best_of_buckets;
use crate::features::FrameFeatures;
use crate::index::Window;
use crate::matching::{Match, mutual_best};
use crate::motion::{Observation, Reprojection, Views};
use crate::params::VerifyParams;
use crate::ransac::consensus;
use crate::stereo::StereoFrame;
use furrow_model::{Se3, StereoRig};

/// What a live pair and a candidate have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct PairEstimate {
    /// Features found in both live images.
    pub stereo_matches: usize,
    /// Of these, matched with the candidate and kept by bucketing.
    pub matches: usize,
    /// Matches that agree on one rigid motion, 0 where that motion is refused: the number that decides whether the localisation is believed. Capped by bucketing.
    pub inliers: usize,
    /// The live camera's pose in the candidate's frame; `None` where nothing plausible was found.
    pub candidate_from_live: Option<Se3>,
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
    let observed: Vec<_> = matches.iter().filter_map(|m| observe(live, candidate, m, rig, params)).collect();
    let observations: Vec<Observation> = observed.iter().map(|o| o.0).collect();
    let reprojection = Reprojection { rig, views: Views::Left };
    let plausible =
        |motion: &Se3| motion.distance_m() <= params.max_distance_m && motion.yaw_rad().abs() <= params.max_yaw_rad;
    // Judged at the end only: a limit on the triples would bend the motion of a place beyond it until it fits inside.
    let found = consensus(&reprojection, &observations, &Se3::IDENTITY, &params.ransac, |_| true)
        .filter(|found| found.inliers.len() >= params.ransac.min_inliers && plausible(&found.fit.after_from_before));
    let agreeing = found.as_ref().map_or(&[][..], |found| &found.inliers);
    PairEstimate {
        stereo_matches: live.stereo_matches(),
        matches: observations.len(),
        inliers: agreeing.len(),
        candidate_from_live: found.as_ref().map(|found| found.fit.after_from_before),
        correspondences: agreeing.iter().map(|&i| observed[i].1).collect(),
    }
}

/// The circle candidate left, live left, live right, live left, closed in both directions: only live features with a mutual right match
/// enter, and left matches left mutually.
fn match_left(live: &StereoFrame, candidate: &FrameFeatures, params: &VerifyParams) -> Vec<Match> {
    let lefts: Vec<u32> = live.pairs.iter().map(|pair| pair.0).collect();
    let (width, height) = live.matching_size();
    let from = live.left.index.subset(&lefts, (width, height));
    let columns = (params.search_columns * width as f64) as i32;
    let rows = (params.search_rows * height as f64) as i32;
    mutual_best(&from, &candidate.index, params.ratio, |i| {
        Some(Window::around(i32::from(from.u[i]), i32::from(from.v[i]), columns, rows))
    })
}

fn thin(live: &StereoFrame, matches: Vec<Match>, params: &VerifyParams) -> Vec<Match> {
    let places: Vec<_> = matches.iter().map(|m| live.coarse_px(m.a as usize).0.map(|px| px as f32)).collect();
    let distances: Vec<_> = matches.iter().map(|m| m.distance).collect();
    best_of_buckets(&places, &distances, &params.bucket).into_iter().map(|i| matches[i]).collect()
}

/// The match as an observation, refined where the images allow; `None` outside the depths that the rig can measure.
fn observe(
    live: &StereoFrame,
    candidate: &FrameFeatures,
    m: &Match,
    rig: &StereoRig,
    params: &VerifyParams,
) -> Option<(Observation, Correspondence)> {
    let (live_px, mut disparity_px) = live.coarse_px(m.a as usize);
    let mut candidate_px = candidate.position_px(m.b as usize).map(f64::from);
    if let Some(patch) = Patch::cut(&live.left.image, live_px) {
        disparity_px = live.disparity_px(&patch, live_px, disparity_px).unwrap_or(disparity_px);
        candidate_px = patch.anywhere(&candidate.image, candidate_px).unwrap_or(candidate_px);
    }
    let point_m = rig.triangulate(live_px[0], live_px[1], disparity_px);
    let measurable = disparity_px >= params.stereo.min_disparity_px && point_m[2] >= params.stereo.near_m;
    let seen_px = [candidate_px[0], candidate_px[1], 0.0];
    measurable.then_some((Observation { point_m, seen_px }, Correspondence { live_px, candidate_px }))
}
