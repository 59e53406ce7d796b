//! Blob and corner features of one image, with descriptors.

use super::descriptor::describe;
use super::detection::{detect, peak_offset, select_sparse};
use super::filters::{apply_masks, halve};
use super::index::{Index, bin_order};
use super::whole_image::WholeImage;
use crate::params::{MatcherParams, MatchingScale};
use furrow_model::GreyImage;
use std::sync::OnceLock;

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
    offsets: Vec<[f32; 2]>,
    /// Whether each feature belongs to the sparse subset.
    pub(crate) sparse: Vec<bool>,
    /// The features indexed for whole-image windows, made on first use.
    whole_image: OnceLock<WholeImage<32>>,
}

/// Images of this many columns are matched at half resolution with [`MatchingScale::Auto`].
const AUTO_HALF_WIDTH: usize = 960;

impl FrameFeatures {
    /// Detects and describes the features of `image` (Geiger et al. 2011, section III-A): extremes of the blob and
    /// corner masks on the matching image, 32 Sobel bytes each. An image without texture, or too small for a
    /// descriptor, has none.
    pub fn extract(image: &GreyImage, params: &MatcherParams) -> Self {
        let is_half = match params.scale {
            MatchingScale::Full => false,
            MatchingScale::Half => true,
            MatchingScale::Auto => image.width >= AUTO_HALF_WIDTH,
        };
        let responses = if is_half { apply_masks(&halve(image)) } else { apply_masks(image) };
        let found = detect(&responses, params);
        let points: Vec<_> = found.iter().map(|&(class, u, v)| (class, u as i16, v as i16)).collect();
        let order = bin_order(&points, responses.width, responses.height);
        let points: Vec<_> = order.iter().map(|&i| points[i as usize]).collect();
        let descriptors = points.iter().map(|&(_, u, v)| describe(&responses, u as usize, v as usize)).collect();
        let index = Index::new(&points, descriptors, responses.width, responses.height);
        let offset = |&(class, u, v): &(u8, i16, i16)| peak_offset(&responses, class, u as usize, v as usize);
        let offsets = points.iter().map(offset).collect();
        let sparse = select_sparse(&index, &responses, params.sparse_radius_px);
        Self {
            image: image.clone(),
            scale: if is_half { 2 } else { 1 },
            matching_width: responses.width,
            matching_height: responses.height,
            index,
            offsets,
            sparse,
            whole_image: OnceLock::new(),
        }
    }

    /// The features indexed for whole-image windows.
    pub(crate) fn whole_image(&self) -> &WholeImage<32> {
        self.whole_image.get_or_init(|| WholeImage::new(&self.index, (self.matching_width, self.matching_height)))
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

    /// Where feature `i` is, (u, v) in image px, to a fraction of a pixel by the peak of its filter response.
    pub(crate) fn position_px(&self, i: usize) -> [f32; 2] {
        let centre = if self.scale == 2 { 0.5 } else { 0.0 };
        let at = [self.index.u[i], self.index.v[i]];
        std::array::from_fn(|k| (f32::from(at[k]) + self.offsets[i][k]) * self.scale as f32 + centre)
    }
}
