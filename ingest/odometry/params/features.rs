//! How features are found.

use serde::{Deserialize, Serialize};

/// The resolution at which features are found and compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum MatchingScale {
    /// As recorded.
    Full,
    /// Half, whatever the image's size (Geiger's setting for 1.3 MP cameras).
    Half,
    /// Half for images of 960 columns and more, else full: small images have no detail to spare.
    Auto,
}

/// How features are found (Geiger et al. 2011, section III-A).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MatcherParams {
    /// Resolution of the matching image. Its pixels are called "matching px".
    pub scale: MatchingScale,
    /// Radius of the non-maximum suppression in matching px (Chebyshev distance).
    pub nms_radius_px: usize,
    /// Least magnitude of the filter response (at most 4080 for blobs, 2040 for corners).
    pub nms_threshold: i16,
    /// Radius of the non-maximum suppression of the sparse subset, which gives the first guess of the motion, in
    /// matching px.
    pub sparse_radius_px: usize,
}

impl Default for MatcherParams {
    fn default() -> Self {
        Self { scale: MatchingScale::Auto, nms_radius_px: 3, nms_threshold: 50, sparse_radius_px: 9 }
    }
}
