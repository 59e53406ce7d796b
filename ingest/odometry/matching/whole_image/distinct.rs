//! Pairs that pass the ratio test in both directions. Closures are not passed to library functions here: those are
//! compiled without AVX2, and what they call would not be inlined.

use super::sixteen::{NO_DISTANCE, Query, equal_lanes, sixteen_distances, to_array};
use crate::features::{Blocks, Index, LANES, Window};
use crate::matching::best::Match;
use std::arch::x86_64::{
    _mm256_loadu_si256, _mm256_max_epu16, _mm256_min_epu16, _mm256_set1_epi16, _mm256_storeu_si256,
};

/// The least and second least distance of every point of one set.
struct Least {
    first: Vec<u16>,
    second: Vec<u16>,
}

impl Least {
    /// No distances yet, for `count` points.
    fn none(count: usize) -> Self {
        Self { first: vec![NO_DISTANCE; count], second: vec![NO_DISTANCE; count] }
    }

    /// Lowe's ratio test (2004): whether the least distance of point `i` is below `ratio` times its second least.
    fn passes_ratio_test(&self, i: usize, ratio: f64) -> bool {
        let (first, second) = (self.first[i], self.second[i]);
        first != NO_DISTANCE && (second == NO_DISTANCE || f64::from(first) < ratio * f64::from(second))
    }
}

/// The pairs that pass the ratio test in both directions. They are mutually best without a further test.
#[target_feature(enable = "avx2")]
pub(super) fn match_distinct<const N: usize>(
    a: &Index<N>,
    b: &Blocks<N>,
    ratio: f64,
    window: impl Fn(usize) -> Option<Window>,
) -> Vec<Match> {
    let (mut least_of_a, mut least_of_b) = (Least::none(a.len()), Least::none(b.names.len()));
    for i in 0..a.len() {
        let Some(window) = window(i) else { continue };
        let query = Query::new(&a.descriptors[i], window);
        (least_of_a.first[i], least_of_a.second[i]) = compare_all(&query, a.class[i], window, b, &mut least_of_b);
    }
    let mut pairs = Vec::new();
    for i in (0..a.len()).filter(|&i| least_of_a.passes_ratio_test(i, ratio)) {
        let Some(window) = window(i) else { continue };
        let (query, distance) = (Query::new(&a.descriptors[i], window), least_of_a.first[i]);
        let partner = find_partner(&query, a.class[i], window, b, (distance, &least_of_b.first));
        if let Some(partner) = partner.filter(|&partner| least_of_b.passes_ratio_test(partner, ratio)) {
            pairs.push(Match { a: i as u32, b: b.names[partner], distance: distance.into() });
        }
    }
    pairs
}

/// Compares a query with all points in its window and returns its two least distances. Those of each point are updated
/// in `theirs`.
#[inline]
#[target_feature(enable = "avx2")]
fn compare_all<const N: usize>(
    query: &Query,
    class: u8,
    window: Window,
    b: &Blocks<N>,
    theirs: &mut Least,
) -> (u16, u16) {
    let mut least = [_mm256_set1_epi16(-1); 2];
    for run in b.runs(class, window) {
        let mut j = run.start;
        while j < run.end {
            let distances = sixteen_distances(query, b, j);
            least[1] = _mm256_min_epu16(least[1], _mm256_max_epu16(least[0], distances));
            least[0] = _mm256_min_epu16(least[0], distances);
            let first = theirs.first[j..j + LANES].as_mut_ptr().cast();
            let second = theirs.second[j..j + LANES].as_mut_ptr().cast();
            // SAFETY: both hold sixteen distances from `j` on.
            unsafe {
                let (before, runner_up) = (_mm256_loadu_si256(first), _mm256_loadu_si256(second));
                _mm256_storeu_si256(second, _mm256_min_epu16(runner_up, _mm256_max_epu16(before, distances)));
                _mm256_storeu_si256(first, _mm256_min_epu16(before, distances));
            }
            j += LANES;
        }
    }
    let (mut first, mut second) = (NO_DISTANCE, NO_DISTANCE);
    for distance in least.into_iter().flat_map(to_array) {
        second = second.min(first.max(distance));
        first = first.min(distance);
    }
    (first, second)
}

/// The first point in the window whose distance to the query and whose least distance are both `distance`.
#[inline]
#[target_feature(enable = "avx2")]
fn find_partner<const N: usize>(
    query: &Query,
    class: u8,
    window: Window,
    b: &Blocks<N>,
    (distance, least_of_b): (u16, &[u16]),
) -> Option<usize> {
    let wanted = _mm256_set1_epi16(distance as i16);
    for run in b.runs(class, window) {
        let mut j = run.start;
        while j < run.end {
            // SAFETY: sixteen distances are read.
            let least = equal_lanes(unsafe { _mm256_loadu_si256(least_of_b[j..j + LANES].as_ptr().cast()) }, wanted);
            if least != 0 {
                let both = least & equal_lanes(sixteen_distances(query, b, j), wanted);
                if both != 0 {
                    return Some(j + both.trailing_zeros() as usize / 2);
                }
            }
            j += LANES;
        }
    }
    None
}
