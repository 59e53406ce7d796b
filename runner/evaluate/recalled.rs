//! Recall as a curve: over the distance that is tolerated, and along the route.

use furrow_model::{RecallWithin, RouteRecalled};
use std::collections::BTreeMap;

/// Tolerated distances, metres; 2.5 m is what "right" tolerates along the route.
const TOLERATED_M: [f64; 9] = [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 5.0, 7.5, 10.0];
/// Wanted shares of the frames of a stretch.
const WANTED: [f64; 5] = [0.1, 0.25, 0.5, 0.75, 0.9];
/// Stretches that a local recall is counted in, metres.
const STRETCH_M: f64 = 10.0;

/// From the distances to the truth of accepted answers of `mapped` frames, metres.
pub(super) fn recall_within(errors_m: &[f64], mapped: usize) -> Vec<RecallWithin> {
    let at = |metres: f64| {
        let near = errors_m.iter().filter(|error| **error <= metres).count();
        RecallWithin { metres, recall: near as f64 / mapped as f64 }
    };
    if mapped == 0 { Vec::new() } else { TOLERATED_M.map(at).to_vec() }
}

/// From the mapped frames: distance travelled from the start of the traversal in metres, and whether it was localised
/// right.
pub(super) fn route_recalled(frames: &[(f64, bool)]) -> Vec<RouteRecalled> {
    let mut stretches: BTreeMap<u64, (u32, u32)> = BTreeMap::new();
    for (travelled_m, right) in frames {
        let stretch = stretches.entry((travelled_m / STRETCH_M).max(0.0) as u64).or_default();
        *stretch = (stretch.0 + u32::from(*right), stretch.1 + 1);
    }
    let at = |recall: f64| {
        let reached = stretches.values().filter(|(right, all)| f64::from(*right) >= recall * f64::from(*all)).count();
        RouteRecalled { recall, share: reached as f64 / stretches.len() as f64 }
    };
    if stretches.is_empty() { Vec::new() } else { WANTED.map(at).to_vec() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_by_hand() {
        let within = recall_within(&[0.2, 0.9, 2.5, 40.0], 8);
        let recalls: Vec<f64> = within.iter().map(|point| point.recall).collect();
        assert_eq!(recalls, [0.125, 0.25, 0.25, 0.25, 0.375, 0.375, 0.375, 0.375, 0.375]);
        // Stretches with 2 of 4, 0 of 1 and 1 of 1.
        let frames = [(0.0, true), (3.0, false), (5.0, true), (9.9, false), (10.0, false), (35.0, true)];
        let shares: Vec<f64> = route_recalled(&frames).iter().map(|point| point.share).collect();
        assert_eq!(shares, [2.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0]);
        assert_eq!((recall_within(&[], 0), route_recalled(&[])), (Vec::new(), Vec::new()));
    }
}
