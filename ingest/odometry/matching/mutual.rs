//! Mutually best matches between two indexed sets of points.

use super::best::{Best, Match, NO_KEY, key_distance, make_key};
use super::distance::distance;
use super::four_lanes;
use crate::features::{Index, Window};

/// Every pair of one class that is mutually best within the windows that `window` gives for the points of `a`. Points
/// without a window stay unmatched. Below 1, `ratio` is that of Lowe's ratio test, which both points must pass. Ties go
/// to the lower index.
///
/// Each candidate pair is compared once and offered to both points, so mutuality costs nothing more.
pub(crate) fn match_mutually<const N: usize>(
    a: &Index<N>,
    b: &Index<N>,
    ratio: f64,
    window: impl FnMut(usize) -> Option<Window>,
) -> Vec<Match> {
    let (mut best_of_a, mut best_of_b) = (Best::none(a.len()), Best::none(b.len()));
    let has_ratio_test = ratio < 1.0;
    if four_lanes::is_available(a, b) {
        four_lanes::compare(a, b, window, &mut best_of_a, &mut best_of_b);
    } else {
        compare(a, b, window, &mut best_of_a, &mut best_of_b);
    }
    let mut matches = Vec::new();
    for (i, &best) in best_of_a.first.iter().enumerate() {
        let partner = best as u32;
        let Some(&back) = best_of_b.first.get(partner as usize) else { continue };
        let is_distinct = !has_ratio_test
            || best_of_a.passes_ratio_test(i, ratio) && best_of_b.passes_ratio_test(partner as usize, ratio);
        if back as u32 == i as u32 && is_distinct {
            matches.push(Match { a: i as u32, b: partner, distance: key_distance(best) });
        }
    }
    matches
}

/// Compares every pair and updates the best partners of both points.
pub(super) fn compare<const N: usize>(
    a: &Index<N>,
    b: &Index<N>,
    mut window: impl FnMut(usize) -> Option<Window>,
    best_of_a: &mut Best,
    best_of_b: &mut Best,
) {
    for i in 0..a.len() {
        let Some(window) = window(i) else { continue };
        let descriptor = &a.descriptors[i];
        let (mut first, mut second) = (NO_KEY, NO_KEY);
        b.for_each_in(a.class[i], window, |j| {
            let distance = distance(descriptor, &b.descriptors[j]);
            let (ours, theirs) = (make_key(distance, j), make_key(distance, i));
            second = second.min(first.max(ours));
            best_of_b.second[j] = best_of_b.second[j].min(best_of_b.first[j].max(theirs));
            first = first.min(ours);
            best_of_b.first[j] = best_of_b.first[j].min(theirs);
        });
        (best_of_a.first[i], best_of_a.second[i]) = (first, second);
    }
}
