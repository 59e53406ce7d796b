//! The verification of a candidate by two views.

use super::consensus::{SAMPLE, find_consensus, find_inliers};
use crate::matching::select_best_of_buckets;
use crate::params::TwoViewParams;
use crate::verification::correspondence::Correspondence;

/// What a live image and a candidate have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoViewEstimate {
    /// Matches kept by bucketing.
    pub matches: usize,
    /// Matches that agree on one epipolar geometry: the number that decides whether the localisation is accepted.
    pub inliers: usize,
    /// The fundamental matrix F of that geometry, by rows: candidate^T F live = 0 for places (u, v, 1) in px. `None` if
    /// no eight matches agree.
    pub fundamental: Option<[[f64; 3]; 3]>,
    /// The inliers, for drawing.
    pub correspondences: Vec<Correspondence>,
}

/// A match of two images, by any matcher.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoViewMatch {
    /// Where both images show the point.
    pub at: Correspondence,
    /// The distance of the two descriptors, from 0, in the matcher's own unit: only the order matters.
    pub distance: f32,
}

/// Verifies one candidate: thins the matches, finds the epipolar geometry with which most of them agree, and counts the
/// inliers.
pub fn verify_two_view(matches: &[TwoViewMatch], params: &TwoViewParams) -> TwoViewEstimate {
    let is_finite = |m: &&TwoViewMatch| [m.at.live_px, m.at.candidate_px].iter().flatten().all(|v| v.is_finite());
    let matches: Vec<&TwoViewMatch> = matches.iter().filter(is_finite).collect();
    let places: Vec<_> = matches.iter().map(|m| m.at.live_px.map(|px| px as f32)).collect();
    // Floats that are not negative have the order of their bits.
    let distances: Vec<u32> = matches.iter().map(|m| m.distance.max(0.0).to_bits()).collect();
    let kept: Vec<Correspondence> =
        select_best_of_buckets(&places, &distances, &params.bucket).into_iter().map(|i| matches[i].at).collect();
    let limit = params.ransac.inlier_px * params.ransac.inlier_px;
    let found = find_consensus(&kept, &params.ransac)
        .map(|matrix| (matrix, find_inliers(&kept, &matrix, limit)))
        .filter(|(_, inliers)| inliers.len() >= params.ransac.min_inliers.max(SAMPLE + 1));
    let inliers = found.as_ref().map_or(&[][..], |(_, inliers)| inliers);
    TwoViewEstimate {
        matches: kept.len(),
        inliers: inliers.len(),
        correspondences: inliers.iter().map(|&i| kept[i]).collect(),
        fundamental: found
            .as_ref()
            .map(|(matrix, _)| std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)]))),
    }
}
