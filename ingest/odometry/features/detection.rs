//! Where features are: extremes of the blob and corner responses (Geiger et al. 2011, section III-A).

use super::descriptor::MARGIN;
use super::filters::Responses;
use super::index::{CLASSES, Index, Window};
use super::non_maximum::{Suppression, suppress_non_maxima};
use crate::params::MatcherParams;

/// The features of all classes as (class, u, v), class by class in raster order.
pub(super) fn detect(responses: &Responses, params: &MatcherParams) -> Vec<(u8, usize, usize)> {
    let settings = Suppression { radius: params.nms_radius_px, threshold: params.nms_threshold, margin: MARGIN };
    let width = responses.width;
    let detect_class = |class: u8| match class {
        0 => suppress_non_maxima::<true>(&responses.blob, width, &settings),
        1 => suppress_non_maxima::<false>(&responses.blob, width, &settings),
        2 => suppress_non_maxima::<true>(&responses.corner, width, &settings),
        _ => suppress_non_maxima::<false>(&responses.corner, width, &settings),
    };
    (0..CLASSES as u8).flat_map(|class| detect_class(class).into_iter().map(move |(u, v)| (class, u, v))).collect()
}

/// The response in which features of a class are extreme.
fn class_response(responses: &Responses, class: u8) -> &[i16] {
    if class < 2 { &responses.blob } else { &responses.corner }
}

/// Offset (du, dv) of a feature's extreme from its pixel: the peak of the parabola through the response and its two
/// neighbours, along each axis, within +-0.5.
pub(super) fn peak_offset(responses: &Responses, class: u8, u: usize, v: usize) -> [f32; 2] {
    let values = class_response(responses, class);
    let at = v * responses.width + u;
    [1, responses.width].map(|step| {
        let [before, here, after] = [values[at - step], values[at], values[at + step]].map(f32::from);
        let curvature = before - 2.0 * here + after;
        if curvature == 0.0 { 0.0 } else { (0.5 * (before - after) / curvature).clamp(-0.5, 0.5) }
    })
}

/// For each feature whether it is the strongest of its class within `radius`.
pub(super) fn select_sparse(index: &Index<32>, responses: &Responses, radius: usize) -> Vec<bool> {
    let strength = |i: usize| {
        let at = index.v[i] as usize * responses.width + index.u[i] as usize;
        class_response(responses, index.class[i])[at].unsigned_abs()
    };
    let strengths: Vec<u16> = (0..index.len()).map(strength).collect();
    let radius = radius as i32;
    let is_strongest = |i: usize| {
        let window = Window::around(i32::from(index.u[i]), i32::from(index.v[i]), radius, radius);
        let mut is_beaten = false;
        index.for_each_in(index.class[i], window, |j| {
            is_beaten |= (strengths[j], i) > (strengths[i], j);
        });
        !is_beaten
    };
    (0..index.len()).map(is_strongest).collect()
}
