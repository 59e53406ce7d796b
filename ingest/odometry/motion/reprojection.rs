//! The reprojection error of an observation under a motion (Geiger et al. 2011, section III-B).

use super::observation::Observation;
use furrow_model::{Se3, StereoRig};

/// How a fit uses the noise of observations.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weights {
    /// Not at all: the residuals are those of the columns and the row, in px.
    Equal,
    /// The residuals of column, row and disparity are whitened: uncorrelated and of equal variance (Matthies and Shafer
    /// 1987). An error of depth moves all three together, and more for a larger motion.
    Noise,
}

/// Which images after the motion are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Views {
    /// The left only: residuals (u, v).
    Left,
    /// Left and right: residuals (u left, v, u right).
    Stereo,
}

/// Reprojection errors of one rig.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reprojection<'a> {
    pub rig: &'a StereoRig,
    pub views: Views,
    pub weights: Weights,
}

/// Least depth of a point that is projected, in metres.
pub(super) const NEAR_M: f64 = 0.05;

impl Reprojection<'_> {
    /// Predicted minus seen position, in px. `None` behind the camera. The third residual is 0 where the right view is
    /// not used.
    #[inline]
    pub(super) fn residuals(
        &self,
        after_from_before: &Se3,
        point_m: &[f64; 3],
        seen_px: &[f64; 3],
    ) -> Option<[f64; 3]> {
        let [x, y, z] = after_from_before.apply(*point_m);
        if z < NEAR_M {
            return None;
        }
        let scale = self.rig.focal_px / z;
        let u = x * scale + self.rig.cu_px - seen_px[0];
        let v = y * scale + self.rig.cv_px - seen_px[1];
        let right = match self.views {
            Views::Left => 0.0,
            Views::Stereo => (x - self.rig.baseline_m) * scale + self.rig.cu_px - seen_px[2],
        };
        Some([u, v, right])
    }

    /// The squared length of the residual vector in px^2. Infinite behind the camera, so that it is above every limit.
    #[inline]
    pub fn error(&self, after_from_before: &Se3, observation: &Observation) -> f64 {
        self.residuals(after_from_before, &observation.point_m, &observation.seen_px)
            .map_or(f64::INFINITY, |r| r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
    }

    /// Residuals per observation.
    #[inline]
    pub(super) fn residual_count(&self) -> usize {
        if self.views == Views::Stereo { 3 } else { 2 }
    }
}
