//! A rectified stereo pair with its left-right matches.

use super::mutual::match_mutually;
use super::patch::Patch;
use crate::features::{FrameFeatures, Index, Window};
use crate::params::StereoParams;
use furrow_model::StereoRig;
use std::sync::OnceLock;

/// The two images of one moment with their left-right matches. It needs no other moment, so frames can be prepared in
/// parallel and ahead of the motion estimation.
#[derive(Debug, Clone)]
pub struct StereoFrame {
    pub(crate) left: FrameFeatures,
    pub(crate) right: FrameFeatures,
    /// For each pair its left and right feature; left features ascend.
    pub(crate) pairs: Vec<(u32, u32)>,
    /// The pairs at their left position, described by the bytes of both sides.
    pub(crate) index: Index<64>,
    /// The left features of the pairs, made on first use.
    left_of_pairs: OnceLock<Index<32>>,
}

impl StereoFrame {
    /// Matches `left` with `right`: mutually best along the row, within the disparities that `rig` and `params` allow.
    pub fn new(left: FrameFeatures, right: FrameFeatures, rig: &StereoRig, params: &StereoParams) -> Self {
        let scale = left.scale as f64;
        let farthest_px = (rig.focal_px * rig.baseline_m / params.near_m).min(params.max_disparity_px);
        let reach = (farthest_px / scale).ceil() as i32;
        let rows = params.epipolar_tolerance_px as i32;
        let index = &left.index;
        let matches = match_mutually(index, &right.index, 1.0, |i| {
            let (u, v) = (i32::from(index.u[i]), i32::from(index.v[i]));
            // Far points may have a disparity of -1 after both columns are rounded.
            Some(Window { u: (u - reach, u + 1), v: (v - rows, v + rows) })
        });
        let near_enough = |&(l, r): &(u32, u32)| {
            let [a, b] = [left.position_px(l as usize), right.position_px(r as usize)];
            f64::from(a[0] - b[0]) > params.min_disparity_px - 1.0
        };
        let pairs: Vec<_> = matches.iter().map(|m| (m.a, m.b)).filter(near_enough).collect();
        let points: Vec<_> =
            pairs.iter().map(|&(l, _)| l as usize).map(|l| (index.class[l], index.u[l], index.v[l])).collect();
        let describe = |&(l, r): &(u32, u32)| {
            let mut bytes = [0; 64];
            bytes[..32].copy_from_slice(&left.index.descriptors[l as usize]);
            bytes[32..].copy_from_slice(&right.index.descriptors[r as usize]);
            bytes
        };
        let index =
            Index::new(&points, pairs.iter().map(describe).collect(), left.matching_width, left.matching_height);
        Self { left, right, pairs, index, left_of_pairs: OnceLock::new() }
    }

    /// The left image's features.
    pub fn left(&self) -> &FrameFeatures {
        &self.left
    }

    /// The right image's features.
    pub fn right(&self) -> &FrameFeatures {
        &self.right
    }

    /// The left features of the pairs, in their order.
    pub(crate) fn left_of_pairs(&self) -> &Index<32> {
        let lefts = || -> Vec<u32> { self.pairs.iter().map(|pair| pair.0).collect() };
        self.left_of_pairs.get_or_init(|| self.left.index.subset(&lefts(), self.matching_size()))
    }

    /// How many features were found in both images.
    pub fn stereo_matches(&self) -> usize {
        self.pairs.len()
    }

    /// Where pair `i` is in the left image, (u, v) in image px, and its disparity, by the peaks of the filter
    /// responses.
    pub(crate) fn coarse_px(&self, i: usize) -> ([f64; 2], f64) {
        let (l, r) = self.pairs[i];
        let [a, b] = [self.left.position_px(l as usize), self.right.position_px(r as usize)];
        (a.map(f64::from), f64::from(a[0] - b[0]))
    }

    /// The disparity of the left patch at `left_px`, refined along its row in the right image from `start_px` on.
    /// `None` if the patch leaves an image or the refinement does not converge.
    pub(crate) fn refine_disparity_px(&self, left: &Patch, left_px: [f64; 2], start_px: f64) -> Option<f64> {
        let right_u = left.refine_along_row(&self.right.image, left_px[0] - start_px, left_px[1])?;
        Some(left_px[0] - right_u)
    }

    /// [`StereoFrame::refine_disparity_px`] if both images correlate there by at least `min_correlation`. They show the
    /// same moment, so light and season explain no difference.
    pub(crate) fn confirm_disparity_px(
        &self,
        left: &Patch,
        left_px: [f64; 2],
        start_px: f64,
        min_correlation: f32,
    ) -> Option<f64> {
        let disparity_px = self.refine_disparity_px(left, left_px, start_px)?;
        let correlation = left.correlation(&self.right.image, [left_px[0] - disparity_px, left_px[1]])?;
        (correlation >= min_correlation).then_some(disparity_px)
    }

    /// The pairs whose left feature is in the sparse subset.
    pub(crate) fn sparse_pairs(&self) -> Vec<u32> {
        (0..self.pairs.len() as u32).filter(|&i| self.left.sparse[self.pairs[i as usize].0 as usize]).collect()
    }

    /// Columns and rows of the matching image.
    pub(crate) fn matching_size(&self) -> (usize, usize) {
        (self.left.matching_width, self.left.matching_height)
    }
}
