//! Bucketing: matches are thinned to the best few of each square of the image, so that no part of the image dominates
//! (Geiger et al. 2011, section III-B).

use crate::params::BucketParams;

/// The indices, ascending, of the matches to keep, given each one's place (u, v) in image px and its descriptor
/// distance. The best have the least distance; ties go to the lower index.
pub(crate) fn select_best_of_buckets(places_px: &[[f32; 2]], distances: &[u32], params: &BucketParams) -> Vec<usize> {
    let side = params.side_px.max(1) as f32;
    let bucket = |i: usize| places_px[i].map(|px| (px.max(0.0) / side) as u32);
    let mut order: Vec<usize> = (0..places_px.len()).collect();
    order.sort_by_cached_key(|&i| (bucket(i), distances[i], i));
    let (mut current, mut taken) = (None, 0);
    order.retain(|&i| {
        if current != Some(bucket(i)) {
            (current, taken) = (Some(bucket(i)), 0);
        }
        taken += 1;
        taken <= params.matches
    });
    order.sort_unstable();
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_of_each_bucket_are_kept() {
        let places = [[1.0, 1.0], [2.0, 2.0], [3.0, 3.0], [60.0, 1.0], [4.0, 55.0]];
        let params = BucketParams { side_px: 50, matches: 2 };
        assert_eq!(select_best_of_buckets(&places, &[30, 10, 10, 99, 5], &params), [1, 2, 3, 4]);
        assert!(select_best_of_buckets(&[], &[], &params).is_empty());
    }
}
