//! A 3-D point, where it is seen after the motion, and how exact both are.

/// A point of the earlier (or live) frame and where it is seen in the later (or candidate's) frame.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Observation {
    /// In the frame before the motion, metres.
    pub point_m: [f64; 3],
    /// After the motion: column and row in the left image, and column in the right image where that is used, in px.
    pub seen_px: [f64; 3],
    /// How exact these numbers are.
    pub noise: Noise,
}

/// Relative variances of an observation: only their ratios matter. None is below 1 along any direction, except that of
/// a known depth, which is 0.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Noise {
    /// Of column and row after the motion, with their covariance: uu, uv, vv.
    pub seen: [f64; 3],
    /// Of the disparity after the motion.
    pub disparity: f64,
    /// Of the disparity before the motion, which gave the point's depth.
    pub depth: f64,
}

impl Noise {
    /// Equal variances of all that is seen, and a known point.
    pub const EQUAL: Self = Self { seen: [1.0, 0.0, 1.0], disparity: 1.0, depth: 0.0 };
}
