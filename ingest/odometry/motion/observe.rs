//! Matches as observations: coarse at first, then refined to a fraction of a pixel.

use super::observation::{Noise, Observation};
use crate::matching::{Match, Patch, StereoFrame, UNREFINED_VARIANCE};
use crate::params::OdometryParams;
use furrow_model::StereoRig;

/// Least disparity that coarse points are triangulated with, so that those far away keep a depth.
const LEAST_COARSE_DISPARITY_PX: f64 = 0.25;

/// The 3-D point of pair `i`, by the peaks of the filter responses.
pub(super) fn coarse_point_m(frame: &StereoFrame, i: usize, rig: &StereoRig) -> [f64; 3] {
    let (px, disparity_px) = frame.coarse_px(i);
    rig.triangulate(px[0], px[1], disparity_px.max(LEAST_COARSE_DISPARITY_PX))
}

/// The match as an observation, by the peaks of the filter responses.
pub(super) fn observe_coarsely(
    previous: &StereoFrame,
    current: &StereoFrame,
    m: &Match,
    rig: &StereoRig,
) -> Observation {
    let (after_px, after_disparity_px) = current.coarse_px(m.b as usize);
    Observation {
        point_m: coarse_point_m(previous, m.a as usize, rig),
        seen_px: [after_px[0], after_px[1], after_px[0] - after_disparity_px],
        noise: Noise::EQUAL,
    }
}

/// The match as an observation, refined on the images. `None` if the point is too far away for a depth, or may be: a
/// cloud whose disparity of a pixel cannot be refined would look like a static object at 30 m, and bias every step. A
/// large disparity is used as it is if it cannot be refined: an error of a pixel is a small part of it.
pub(super) fn observe(
    previous: &StereoFrame,
    current: &StereoFrame,
    m: &Match,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Option<Observation> {
    let (before_px, coarse_px) = previous.coarse_px(m.a as usize);
    let (coarse_after_px, coarse_after_disparity_px) = current.coarse_px(m.b as usize);
    let patch = Patch::extract(&previous.left.image, before_px)?;
    let near_px = Some(coarse_px).filter(|px| *px >= params.near_disparity_px);
    let (disparity_px, depth) = match previous.refine_disparity_px(&patch, before_px, coarse_px) {
        Some(px) => (px, patch.variance_along_row()),
        None => (near_px?, patch.variance_along_row() + UNREFINED_VARIANCE),
    };
    let (after_px, seen) = match patch.refine(&current.left.image, coarse_after_px) {
        Some(px) => (px, patch.variance()),
        None => {
            let [uu, uv, vv] = patch.variance();
            (coarse_after_px, [uu + UNREFINED_VARIANCE, uv, vv + UNREFINED_VARIANCE])
        }
    };
    let patch = Patch::extract(&current.left.image, after_px)?;
    let (after_disparity_px, disparity) = match current.refine_disparity_px(&patch, after_px, coarse_after_disparity_px)
    {
        Some(px) => (px, patch.variance_along_row()),
        None => (coarse_after_disparity_px, patch.variance_along_row() + UNREFINED_VARIANCE),
    };
    (disparity_px >= params.stereo.min_disparity_px).then(|| Observation {
        point_m: rig.triangulate(before_px[0], before_px[1], disparity_px),
        seen_px: [after_px[0], after_px[1], after_px[0] - after_disparity_px],
        noise: Noise { seen, disparity, depth },
    })
}
