//! Matches with a candidate as observations, refined and confirmed on the images.

use super::correspondence::Correspondence;
use crate::features::FrameFeatures;
use crate::matching::{Match, Patch, StereoFrame};
use crate::motion::{Noise, Observation};
use crate::params::VerifyParams;
use furrow_model::StereoRig;

/// A feature of the candidate.
pub(super) struct CandidateFeature<'a> {
    left: &'a FrameFeatures,
    /// Where it is in the left image.
    px: [f64; 2],
    /// The candidate's stereo pair and the feature's disparity, if it has a right image.
    right: Option<(&'a StereoFrame, f64)>,
}

impl<'a> CandidateFeature<'a> {
    pub fn in_left(candidate: &'a FrameFeatures, feature: usize) -> Self {
        Self { left: candidate, px: candidate.position_px(feature).map(f64::from), right: None }
    }

    pub fn in_pair(candidate: &'a StereoFrame, pair: usize) -> Self {
        let (px, disparity_px) = candidate.coarse_px(pair);
        Self { left: &candidate.left, px, right: Some((candidate, disparity_px)) }
    }
}

/// The match as an observation, refined on the images. `None` if the images do not confirm the live disparity, and
/// outside the depths that the rig can measure.
///
/// A wrong place at a similar heading agrees with a live view on what does not move with the camera: clouds, and rows
/// of equal posts. With an unconfirmed disparity such a point looks like a near one that did not move.
pub(super) fn observe(
    live: &StereoFrame,
    m: &Match,
    seen: &CandidateFeature<'_>,
    rig: &StereoRig,
    params: &VerifyParams,
) -> Option<(Observation, Correspondence)> {
    let (live_px, coarse_px) = live.coarse_px(m.a as usize);
    let patch = Patch::extract(&live.left.image, live_px)?;
    let disparity_px = live.confirm_disparity_px(&patch, live_px, coarse_px, params.min_correlation)?;
    let candidate_px = patch.refine(&seen.left.image, seen.px).unwrap_or(seen.px);
    let right_u = match seen.right {
        None => 0.0,
        Some((pair, coarse_px)) => {
            let patch = Patch::extract(&seen.left.image, candidate_px)?;
            candidate_px[0] - pair.confirm_disparity_px(&patch, candidate_px, coarse_px, params.min_correlation)?
        }
    };
    let point_m = rig.triangulate(live_px[0], live_px[1], disparity_px);
    let is_measurable = disparity_px >= params.stereo.min_disparity_px && point_m[2] >= params.stereo.near_m;
    let seen_px = [candidate_px[0], candidate_px[1], right_u];
    is_measurable
        .then_some((Observation { point_m, seen_px, noise: Noise::EQUAL }, Correspondence { live_px, candidate_px }))
}
