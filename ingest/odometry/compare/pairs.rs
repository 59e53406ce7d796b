//! Which poses are compared with each other.

use furrow_model::Se3;

/// Distance between the two poses of a pair.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Delta {
    /// Poses.
    Frames(usize),
    /// Metres along the track.
    Metres(f64),
}

impl Delta {
    /// The consecutive pairs of a track: each begins where the one before ends (evo's default, its `all_pairs` off).
    pub(super) fn pairs(self, poses: &[Se3]) -> Vec<(usize, usize)> {
        let ends: Vec<usize> = match self {
            Delta::Frames(count) => (0..poses.len()).step_by(count.max(1)).collect(),
            Delta::Metres(length_m) => {
                let mut path_m = 0.0;
                let ends_pair = |i: &usize| {
                    path_m += distance_m(&poses[*i - 1], &poses[*i]);
                    let reached = path_m >= length_m;
                    if reached {
                        path_m = 0.0;
                    }
                    reached
                };
                std::iter::once(0).chain((1..poses.len()).filter(ends_pair)).collect()
            }
        };
        ends.windows(2).map(|pair| (pair[0], pair[1])).collect()
    }
}

/// Distance between two positions in metres.
pub(super) fn distance_m(a: &Se3, b: &Se3) -> f64 {
    (0..3).map(|k| (a.translation_m[k] - b.translation_m[k]).powi(2)).sum::<f64>().sqrt()
}

/// The indices (into `a`, into `b`) of stamps that are nearest to each other and differ by at most `max_difference_s`
/// seconds. Each stamp of the shorter list takes its nearest in the longer one, the earlier of two equally near (evo's
/// `associate_trajectories`). Both lists ascend.
pub fn associate(a: &[f64], b: &[f64], max_difference_s: f64) -> Vec<(usize, usize)> {
    if b.len() > a.len() {
        nearest(a, b, max_difference_s).collect()
    } else {
        nearest(b, a, max_difference_s).map(|(i, j)| (j, i)).collect()
    }
}

/// For each stamp of `short` the nearest of `long`.
fn nearest<'a>(short: &'a [f64], long: &'a [f64], max_difference_s: f64) -> impl Iterator<Item = (usize, usize)> + 'a {
    short.iter().enumerate().filter_map(move |(i, &stamp)| {
        let after = long.partition_point(|&other| other < stamp);
        let near = [after.checked_sub(1), Some(after).filter(|&j| j < long.len())].into_iter().flatten();
        let difference = |j: &usize| (long[*j] - stamp).abs();
        near.min_by(|x, y| difference(x).total_cmp(&difference(y)))
            .filter(|j| difference(j) <= max_difference_s)
            .map(|j| (i, j))
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn association_equals_brute_force(
            mut a in proptest::collection::vec(0_u32..2000, 1..40),
            mut b in proptest::collection::vec(0_u32..2000, 1..40),
            most in 0_u32..30,
        ) {
            for list in [&mut a, &mut b] {
                list.sort_unstable();
                list.dedup();
            }
            let [a, b] = [a, b].map(|list| list.into_iter().map(f64::from).collect::<Vec<_>>());
            let flip = b.len() <= a.len();
            let (short, long) = if flip { (&b, &a) } else { (&a, &b) };
            let mut expected = Vec::new();
            for (i, stamp) in short.iter().enumerate() {
                let mut best = 0;
                for j in 0..long.len() {
                    if (long[j] - stamp).abs() < (long[best] - stamp).abs() {
                        best = j;
                    }
                }
                if (long[best] - stamp).abs() <= f64::from(most) {
                    expected.push(if flip { (best, i) } else { (i, best) });
                }
            }
            prop_assert_eq!(associate(&a, &b, f64::from(most)), expected);
        }
    }
}
