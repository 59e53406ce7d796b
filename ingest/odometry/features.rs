//! Blob and corner features of one image, with descriptors.

use crate::extremes::{Search, extremes};
use crate::filters::{Responses, halve, respond};
use crate::index::{Index, Window, bin_order};
use crate::matching_afar::Wide;
use crate::params::{MatcherParams, MatchingScale};
use furrow_model::GreyImage;
use std::sync::OnceLock;

/// Blob maxima, blob minima, corner maxima, corner minima: only features of one class are compared.
pub(crate) const CLASSES: usize = 4;

/// What the matcher needs of one image. Extract once and reuse: a live image is compared with many candidates.
#[derive(Debug, Clone)]
pub struct FrameFeatures {
    /// The image itself, for refinement to a fraction of a pixel.
    pub(crate) image: GreyImage,
    /// Image pixels per matching pixel: 1 or 2.
    pub(crate) scale: usize,
    pub(crate) matching_width: usize,
    pub(crate) matching_height: usize,
    pub(crate) index: Index<32>,
    /// Offset of each feature's extreme from its pixel, (du, dv) in matching px, each within +-0.5.
    pub(crate) offsets: Vec<[f32; 2]>,
    /// Whether each feature belongs to the sparse subset.
    pub(crate) sparse: Vec<bool>,
    /// The features laid out for wide windows, once somebody asks.
    wide: OnceLock<Wide<32>>,
}

impl FrameFeatures {
    /// Finds and describes the features of `image` (Geiger et al. 2011, III A): extremes of the blob and corner masks on the matching
    /// image, 32 Sobel bytes each. An image without texture, or too small for a descriptor, gives none.
    pub fn extract(image: &GreyImage, params: &MatcherParams) -> Self {
        let half = match params.scale {
            MatchingScale::Full => false,
            MatchingScale::Half => true,
            MatchingScale::Auto => image.width >= AUTO_HALF_WIDTH,
        };
        let responses = if half { respond(&halve(image)) } else { respond(image) };
        let found = find(&responses, params);
        let points: Vec<_> = found.iter().map(|&(class, u, v)| (class, u as i16, v as i16)).collect();
        let order = bin_order(&points, responses.width, responses.height);
        let points: Vec<_> = order.iter().map(|&i| points[i as usize]).collect();
        let descriptors = points.iter().map(|&(_, u, v)| describe(&responses, u as usize, v as usize)).collect();
        let index = Index::new(&points, descriptors, responses.width, responses.height);
        let offsets = points.iter().map(|&(class, u, v)| peak(&responses, class, u as usize, v as usize)).collect();
        let sparse = sparse_subset(&index, &responses, params.sparse_radius_px);
        Self {
            image: image.clone(),
            scale: if half { 2 } else { 1 },
            matching_width: responses.width,
            matching_height: responses.height,
            index,
            offsets,
            sparse,
            wide: OnceLock::new(),
        }
    }

    /// The features laid out for wide windows.
    pub(crate) fn wide(&self) -> &Wide<32> {
        self.wide.get_or_init(|| Wide::of(&self.index, (self.matching_width, self.matching_height)))
    }

    /// How many features there are.
    pub fn len(&self) -> usize {
        self.index.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Where the features are, (u, v) in image px.
    pub fn positions_px(&self) -> impl Iterator<Item = [f64; 2]> + '_ {
        (0..self.len()).map(|i| self.position_px(i).map(f64::from))
    }

    /// Where feature `i` is, (u, v) in image px, to the fraction that its filter response tells.
    pub(crate) fn position_px(&self, i: usize) -> [f32; 2] {
        let centre = if self.scale == 2 { 0.5 } else { 0.0 };
        let at = [self.index.u[i], self.index.v[i]];
        std::array::from_fn(|k| (f32::from(at[k]) + self.offsets[i][k]) * self.scale as f32 + centre)
    }
}

const AUTO_HALF_WIDTH: usize = 960;

/// Farthest sample of the descriptor from its feature, and the mask that computed that sample.
const MARGIN: usize = 5 + crate::filters::MASK_RADIUS;

/// Sixteen places in the 11x11 block around a feature, denser in the middle; both Sobel values of each are the descriptor.
const SAMPLES: [(i32, i32); 16] = [
    (-1, -1),
    (1, -1),
    (-1, 1),
    (1, 1),
    (-5, -1),
    (5, -1),
    (-5, 1),
    (5, 1),
    (-1, -5),
    (1, -5),
    (-1, 5),
    (1, 5),
    (-3, -3),
    (3, -3),
    (-3, 3),
    (3, 3),
];

fn find(responses: &Responses, params: &MatcherParams) -> Vec<(u8, usize, usize)> {
    let search = Search { radius: params.nms_radius_px, threshold: params.nms_threshold, margin: MARGIN };
    let width = responses.width;
    let of_class = |class: u8| match class {
        0 => extremes::<true>(&responses.blob, width, &search),
        1 => extremes::<false>(&responses.blob, width, &search),
        2 => extremes::<true>(&responses.corner, width, &search),
        _ => extremes::<false>(&responses.corner, width, &search),
    };
    (0..CLASSES as u8).flat_map(|class| of_class(class).into_iter().map(move |(u, v)| (class, u, v))).collect()
}

fn response_of(responses: &Responses, class: u8) -> &[i16] {
    if class < 2 { &responses.blob } else { &responses.corner }
}

fn describe(responses: &Responses, u: usize, v: usize) -> [u8; 32] {
    let centre = (v * responses.width + u) as isize;
    let mut bytes = [0; 32];
    for (i, (du, dv)) in SAMPLES.into_iter().enumerate() {
        let at = (centre + dv as isize * responses.width as isize + du as isize) as usize;
        bytes[i] = responses.sobel_u[at];
        bytes[16 + i] = responses.sobel_v[at];
    }
    bytes
}

/// Where the parabola through the response and its two neighbours peaks, each direction.
fn peak(responses: &Responses, class: u8, u: usize, v: usize) -> [f32; 2] {
    let values = response_of(responses, class);
    let at = v * responses.width + u;
    [1, responses.width].map(|step| {
        let [before, here, after] = [values[at - step], values[at], values[at + step]].map(f32::from);
        let curvature = before - 2.0 * here + after;
        if curvature == 0.0 { 0.0 } else { (0.5 * (before - after) / curvature).clamp(-0.5, 0.5) }
    })
}

/// The features that no stronger one of their class has within `radius`.
fn sparse_subset(index: &Index<32>, responses: &Responses, radius: usize) -> Vec<bool> {
    let strength = |i: usize| {
        let at = index.v[i] as usize * responses.width + index.u[i] as usize;
        response_of(responses, index.class[i])[at].unsigned_abs()
    };
    let strengths: Vec<u16> = (0..index.len()).map(strength).collect();
    let radius = radius as i32;
    let strongest = |i: usize| {
        let window = Window::around(i32::from(index.u[i]), i32::from(index.v[i]), radius, radius);
        let mut beaten = false;
        index.for_each_in(index.class[i], window, |j| {
            beaten |= (strengths[j], i) > (strengths[i], j);
        });
        !beaten
    };
    (0..index.len()).map(strongest).collect()
}
