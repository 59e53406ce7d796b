//! A point seen from two places.

/// One point seen in the live image and in the candidate's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Correspondence {
    /// (u, v) in the live left image, px.
    pub live_px: [f64; 2],
    /// (u, v) in the candidate's left image, px.
    pub candidate_px: [f64; 2],
}
