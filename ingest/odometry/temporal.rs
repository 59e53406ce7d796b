//! Matches between two moments of a stereo rig: the circle of four views, closed in both directions.
//!
//! Geiger's circle visits left, right, right, left and asks to come back to where it began. Here left-right matches are mutual within each
//! moment ([`StereoFrame`]) and whole pairs are then matched, mutually, by the sum of both sides' distances: every edge of the circle
//! holds in both directions, and the left and right views vote together.

use crate::align::{Patch, UNREFINED};
use crate::bucket::best_of_buckets;
use crate::index::{Index, Window};
use crate::matching::{Match, mutual_best};
use crate::motion::{Noise, Observation, Reprojection, Views, Weights};
use crate::params::OdometryParams;
use crate::ransac::consensus;
use crate::stereo::StereoFrame;
use crate::support::{FlowSample, supported};
use furrow_model::{Se3, StereoRig};

/// The matches of two moments, by pair: sparse first, over a wide window; then dense, where the sparse motion says.
pub(crate) fn match_moments(
    previous: &StereoFrame,
    current: &StereoFrame,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Vec<Match> {
    let reach = (params.search_radius_px / previous.left.scale as f64).ceil() as i32;
    if let Some(current_from_previous) = sparse_motion(previous, current, rig, params, reach) {
        return match_along(previous, current, &current_from_previous, rig, params);
    }
    let matches = mutual_best(&previous.index, &current.index, 1.0, |i| Some(around(&previous.index, i, reach)));
    thin(current, &keep_supported(previous, current, matches, params), params)
}

/// The matches of two moments, by pair, near where a motion puts them.
pub(crate) fn match_along(
    previous: &StereoFrame,
    current: &StereoFrame,
    current_from_previous: &Se3,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Vec<Match> {
    let window = |i| guided_window(previous, i, current_from_previous, rig, params);
    let matches = mutual_best(&previous.index, &current.index, 1.0, window);
    thin(current, &keep_supported(previous, current, matches, params), params)
}

fn around<const N: usize>(index: &Index<N>, i: usize, reach: i32) -> Window {
    Window::around(i32::from(index.u[i]), i32::from(index.v[i]), reach, reach)
}

/// The motion (current_from_previous) that the sparse features agree on, where they clearly do.
fn sparse_motion(
    previous: &StereoFrame,
    current: &StereoFrame,
    rig: &StereoRig,
    params: &OdometryParams,
    reach: i32,
) -> Option<Se3> {
    let (from, to) = (previous.sparse_pairs(), current.sparse_pairs());
    let (a, b) =
        (previous.index.subset(&from, previous.matching_size()), current.index.subset(&to, current.matching_size()));
    let matches: Vec<Match> = mutual_best(&a, &b, 1.0, |i| Some(around(&a, i, reach)))
        .into_iter()
        .map(|m| Match { a: from[m.a as usize], b: to[m.b as usize], ..m })
        .collect();
    let matches = keep_supported(previous, current, matches, params);
    let observations: Vec<_> = matches.iter().map(|m| coarse_observation(previous, current, m, rig)).collect();
    let reprojection = Reprojection { rig, views: Views::Stereo, weights: Weights::Equal };
    // Positions are not refined yet, so the residuals are larger.
    let ransac = crate::RansacParams { inlier_px: 2.0 * params.ransac.inlier_px, ..params.ransac.clone() };
    let found = consensus(&reprojection, &observations, &Se3::IDENTITY, &ransac, |m| params.is_plausible(m))?;
    // Guiding the dense search by a motion that few agree with would breed matches that confirm it.
    let clear = found.inliers.len() >= CLEAR_INLIERS && 2 * found.inliers.len() >= observations.len();
    clear.then_some(found.after_from_before)
}

const CLEAR_INLIERS: usize = 20;

fn coarse_observation(previous: &StereoFrame, current: &StereoFrame, m: &Match, rig: &StereoRig) -> Observation {
    let (before_px, disparity_px) = previous.coarse_px(m.a as usize);
    let (after_px, after_disparity_px) = current.coarse_px(m.b as usize);
    Observation {
        point_m: rig.triangulate(before_px[0], before_px[1], disparity_px.max(LEAST_COARSE_DISPARITY_PX)),
        seen_px: [after_px[0], after_px[1], after_px[0] - after_disparity_px],
        noise: Noise::EQUAL,
    }
}

const LEAST_COARSE_DISPARITY_PX: f64 = 0.25;

/// Where pair `i` should be found after the motion; `None` behind the camera.
fn guided_window(
    previous: &StereoFrame,
    i: usize,
    current_from_previous: &Se3,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Option<Window> {
    let (px, disparity_px) = previous.coarse_px(i);
    let point = rig.triangulate(px[0], px[1], disparity_px.max(LEAST_COARSE_DISPARITY_PX));
    let moved = current_from_previous.apply(point);
    if moved[2] < rig.baseline_m {
        return None;
    }
    let scale = previous.left.scale as f64;
    let [u, v] = rig.project(moved).map(|px| (px / scale).clamp(-1e6, 1e6) as i32);
    let reach = (params.guided_radius_px / scale).ceil() as i32;
    Some(Window::around(u, v, reach, reach))
}

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
    let mut keep = supported(&samples, &params.support).into_iter();
    matches.retain(|_| keep.next().unwrap_or(false));
    matches
}

fn thin(current: &StereoFrame, matches: &[Match], params: &OdometryParams) -> Vec<Match> {
    let places: Vec<_> = matches.iter().map(|m| current.coarse_px(m.b as usize).0.map(|px| px as f32)).collect();
    let distances: Vec<_> = matches.iter().map(|m| m.distance).collect();
    best_of_buckets(&places, &distances, &params.bucket).into_iter().map(|i| matches[i]).collect()
}

/// The match as an observation, refined to a fraction of a pixel on the images themselves. `None` where the point is too far away to have a
/// depth, or may be: a cloud with a disparity of a pixel that does not settle would pass for a thing at 30 m that did not move, and tilt every
/// step a little. Large disparities are believed as they are, a pixel more or less is little of them.
pub(crate) fn refined_observation(
    previous: &StereoFrame,
    current: &StereoFrame,
    m: &Match,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Option<Observation> {
    let (before_px, coarse_px) = previous.coarse_px(m.a as usize);
    let (coarse_after_px, coarse_after_disparity_px) = current.coarse_px(m.b as usize);
    let patch = Patch::cut(&previous.left.image, before_px)?;
    let near_px = Some(coarse_px).filter(|px| *px >= params.near_disparity_px);
    let (disparity_px, depth) = match previous.disparity_px(&patch, before_px, coarse_px) {
        Some(px) => (px, patch.noise_along_row()),
        None => (near_px?, patch.noise_along_row() + UNREFINED),
    };
    let (after_px, seen) = match patch.anywhere(&current.left.image, coarse_after_px) {
        Some(px) => (px, patch.noise()),
        None => {
            let [uu, uv, vv] = patch.noise();
            (coarse_after_px, [uu + UNREFINED, uv, vv + UNREFINED])
        }
    };
    let patch = Patch::cut(&current.left.image, after_px)?;
    let (after_disparity_px, disparity) = match current.disparity_px(&patch, after_px, coarse_after_disparity_px) {
        Some(px) => (px, patch.noise_along_row()),
        None => (coarse_after_disparity_px, patch.noise_along_row() + UNREFINED),
    };
    (disparity_px >= params.stereo.min_disparity_px).then(|| Observation {
        point_m: rig.triangulate(before_px[0], before_px[1], disparity_px),
        seen_px: [after_px[0], after_px[1], after_px[0] - after_disparity_px],
        noise: Noise { seen, disparity, depth },
    })
}
