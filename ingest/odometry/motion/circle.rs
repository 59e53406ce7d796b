//! Matches between two stereo frames: the circle of four views (Geiger et al. 2011, section III-A).
//!
//! Geiger's circle goes from left to right, to the other moment, and back, and must end at the feature where it began.
//! Here left-right matches are mutual within each moment ([`StereoFrame`]), and pairs are matched with pairs, mutually,
//! by the sum of both sides' distances: every edge of the circle holds in both directions.

use super::consensus::find_consensus;
use super::observe::{coarse_point_m, observe_coarsely};
use super::reprojection::{Reprojection, Views, Weights};
use crate::features::{Index, Window};
use crate::matching::{FlowSample, Match, StereoFrame, find_supported, match_mutually, select_best_of_buckets};
use crate::params::{OdometryParams, RansacParams};
use furrow_model::{Se3, StereoRig};

/// The matches of two frames, by pair: sparse ones in a large window first, then all where the motion of the sparse
/// ones predicts.
pub(super) fn match_frames(
    previous: &StereoFrame,
    current: &StereoFrame,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Vec<Match> {
    let reach = (params.search_radius_px / previous.left.scale as f64).ceil() as i32;
    if let Some(current_from_previous) = estimate_sparse_motion(previous, current, rig, params, reach) {
        return match_near(previous, current, &current_from_previous, rig, params);
    }
    let matches =
        match_mutually(&previous.index, &current.index, 1.0, |i| Some(window_around(&previous.index, i, reach)));
    thin(current, &keep_supported(previous, current, matches, params), params)
}

/// The matches of two frames, by pair, near where a motion predicts them.
pub(super) fn match_near(
    previous: &StereoFrame,
    current: &StereoFrame,
    current_from_previous: &Se3,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Vec<Match> {
    let window = |i| predict_window(previous, i, current_from_previous, rig, params);
    let matches = match_mutually(&previous.index, &current.index, 1.0, window);
    thin(current, &keep_supported(previous, current, matches, params), params)
}

/// The window around point `i`.
fn window_around<const N: usize>(index: &Index<N>, i: usize, reach: i32) -> Window {
    Window::around(i32::from(index.u[i]), i32::from(index.v[i]), reach, reach)
}

/// The motion (current_from_previous) with which most sparse matches agree. `None` if too few do.
fn estimate_sparse_motion(
    previous: &StereoFrame,
    current: &StereoFrame,
    rig: &StereoRig,
    params: &OdometryParams,
    reach: i32,
) -> Option<Se3> {
    let (from, to) = (previous.sparse_pairs(), current.sparse_pairs());
    let (a, b) =
        (previous.index.subset(&from, previous.matching_size()), current.index.subset(&to, current.matching_size()));
    let matches: Vec<Match> = match_mutually(&a, &b, 1.0, |i| Some(window_around(&a, i, reach)))
        .into_iter()
        .map(|m| Match { a: from[m.a as usize], b: to[m.b as usize], ..m })
        .collect();
    let matches = keep_supported(previous, current, matches, params);
    let observations: Vec<_> = matches.iter().map(|m| observe_coarsely(previous, current, m, rig)).collect();
    let reprojection = Reprojection { rig, views: Views::Stereo, weights: Weights::Equal };
    // Positions are not refined yet, so the residuals are larger.
    let ransac = RansacParams { inlier_px: 2.0 * params.ransac.inlier_px, ..params.ransac.clone() };
    let found = find_consensus(&reprojection, &observations, &Se3::IDENTITY, &ransac, |m| params.is_plausible(m))?;
    // A dense search guided by a motion of few inliers would find matches that confirm it.
    let is_clear = found.inliers.len() >= CLEAR_INLIERS && 2 * found.inliers.len() >= observations.len();
    is_clear.then_some(found.after_from_before)
}

/// Least inliers of a sparse motion that may guide the dense search.
const CLEAR_INLIERS: usize = 20;

/// Where pair `i` is expected after the motion. `None` behind the camera.
fn predict_window(
    previous: &StereoFrame,
    i: usize,
    current_from_previous: &Se3,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Option<Window> {
    let moved = current_from_previous.apply(coarse_point_m(previous, i, rig));
    if moved[2] < rig.baseline_m {
        return None;
    }
    let scale = previous.left.scale as f64;
    let [u, v] = rig.project(moved).map(|px| (px / scale).clamp(-1e6, 1e6) as i32);
    let reach = (params.guided_radius_px / scale).ceil() as i32;
    Some(Window::around(u, v, reach, reach))
}

/// The matches that enough of their neighbours support.
fn keep_supported(
    previous: &StereoFrame,
    current: &StereoFrame,
    mut matches: Vec<Match>,
    params: &OdometryParams,
) -> Vec<Match> {
    let sample = |m: &Match| {
        let (before, disparity) = previous.coarse_px(m.a as usize);
        let (after, _) = current.coarse_px(m.b as usize);
        FlowSample {
            at_px: before.map(|px| px as f32),
            flow_px: [0, 1].map(|k| (after[k] - before[k]) as f32),
            disparity_px: disparity as f32,
        }
    };
    let samples: Vec<_> = matches.iter().map(sample).collect();
    let mut keep = find_supported(&samples, &params.support).into_iter();
    matches.retain(|_| keep.next().unwrap_or(false));
    matches
}

/// The best matches of each bucket of the current left image.
fn thin(current: &StereoFrame, matches: &[Match], params: &OdometryParams) -> Vec<Match> {
    let places: Vec<_> = matches.iter().map(|m| current.coarse_px(m.b as usize).0.map(|px| px as f32)).collect();
    let distances: Vec<_> = matches.iter().map(|m| m.distance).collect();
    select_best_of_buckets(&places, &distances, &params.bucket).into_iter().map(|i| matches[i]).collect()
}
