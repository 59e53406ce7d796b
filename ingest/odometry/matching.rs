//! Mutual best matches between two indexed sets of points.

use crate::index::{Index, Window, distance};
use crate::matching_wide as wide;

/// Two points that chose each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Match {
    /// Index into the first set.
    pub a: u32,
    /// Index into the second set.
    pub b: u32,
    /// Sum of absolute differences of their descriptors.
    pub distance: u32,
}

/// A partner and the distance to it in one number, so that the least number is the nearest partner, and of equals the one of lowest index.
pub(crate) type Key = u64;
pub(crate) const NONE: Key = Key::MAX;

pub(crate) fn key(distance: u32, partner: usize) -> Key {
    u64::from(distance) << 32 | partner as u64
}

fn distance_of(key: Key) -> u32 {
    (key >> 32) as u32
}

/// The best and second best partner of every point of one side.
pub(crate) struct Best {
    pub first: Vec<Key>,
    pub second: Vec<Key>,
}

impl Best {
    fn of(count: usize) -> Best {
        Best { first: vec![NONE; count], second: vec![NONE; count] }
    }

    fn is_distinct(&self, i: usize, ratio: f64) -> bool {
        let second = self.second[i];
        second == NONE || f64::from(distance_of(self.first[i])) < ratio * f64::from(distance_of(second))
    }
}

/// Every pair that is mutually best among equal classes within the windows that `window` gives for the points of `a`; points without
/// a window stay unmatched. A pair must beat both second bests by `ratio` (1 asks for nothing). Ties go to the lower index.
///
/// Each candidate pair is compared once and offered to both sides, so "mutual" costs nothing more.
pub(crate) fn mutual_best<const N: usize>(
    a: &Index<N>,
    b: &Index<N>,
    ratio: f64,
    window: impl FnMut(usize) -> Option<Window>,
) -> Vec<Match> {
    let (mut of_a, mut of_b) = (Best::of(a.len()), Best::of(b.len()));
    let picky = ratio < 1.0;
    if wide::can(a, b) {
        wide::compare(a, b, window, &mut of_a, &mut of_b);
    } else {
        compare(a, b, window, &mut of_a, &mut of_b);
    }
    let mut matches = Vec::new();
    for (i, &best) in of_a.first.iter().enumerate() {
        let partner = best as u32;
        let Some(&back) = of_b.first.get(partner as usize) else { continue };
        let distinct = !picky || of_a.is_distinct(i, ratio) && of_b.is_distinct(partner as usize, ratio);
        if back as u32 == i as u32 && distinct {
            matches.push(Match { a: i as u32, b: partner, distance: distance_of(best) });
        }
    }
    matches
}

/// Offers every pair to both sides.
fn compare<const N: usize>(
    a: &Index<N>,
    b: &Index<N>,
    mut window: impl FnMut(usize) -> Option<Window>,
    of_a: &mut Best,
    of_b: &mut Best,
) {
    for i in 0..a.len() {
        let Some(window) = window(i) else { continue };
        let descriptor = &a.descriptors[i];
        let (mut first, mut second) = (NONE, NONE);
        b.for_each_in(a.class[i], window, |j| {
            let distance = distance(descriptor, &b.descriptors[j]);
            let (ours, theirs) = (key(distance, j), key(distance, i));
            second = second.min(first.max(ours));
            of_b.second[j] = of_b.second[j].min(of_b.first[j].max(theirs));
            first = first.min(ours);
            of_b.first[j] = of_b.first[j].min(theirs);
        });
        (of_a.first[i], of_a.second[i]) = (first, second);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::index::bin_order;
    use crate::matching_afar::{Wide, mutual_best_afar};
    use proptest::prelude::*;

    type Point = (u8, i16, i16, u8);

    /// Points with descriptors of few values, so that there are ties.
    fn indexed<const N: usize>(mut points: Vec<Point>) -> Index<N> {
        let places: Vec<_> = points.iter().map(|p| (p.0, p.1, p.2)).collect();
        points = bin_order(&places, 100, 60).into_iter().map(|i| points[i as usize]).collect();
        let places: Vec<_> = points.iter().map(|p| (p.0, p.1, p.2)).collect();
        let describe = |p: &Point| std::array::from_fn(|k| p.3.wrapping_mul(k as u8 | 1) & 7);
        Index::new(&places, points.iter().map(describe).collect(), 100, 60)
    }

    /// Looks at all pairs.
    fn brute<const N: usize>(a: &Index<N>, b: &Index<N>, ratio: f64, reach: i32) -> Vec<Match> {
        let apart = |i: usize, j: usize| -> u32 {
            a.descriptors[i].iter().zip(&b.descriptors[j]).map(|(x, y)| u32::from(x.abs_diff(*y))).sum()
        };
        let near = |i: usize, j: usize| {
            let off = |x: i16, y: i16| (i32::from(x) - i32::from(y)).abs() <= reach;
            a.class[i] == b.class[j] && off(a.u[i], b.u[j]) && off(a.v[i], b.v[j])
        };
        let two_best = |mut all: Vec<(u32, usize)>| {
            all.sort_unstable();
            let distinct = all.len() < 2 || ratio >= 1.0 || f64::from(all[0].0) < ratio * f64::from(all[1].0);
            all.first().map(|best| (best.1, distinct))
        };
        let best_of_a = |i: usize| two_best((0..b.len()).filter(|&j| near(i, j)).map(|j| (apart(i, j), j)).collect());
        let best_of_b = |j: usize| two_best((0..a.len()).filter(|&i| near(i, j)).map(|i| (apart(i, j), i)).collect());
        let mutual = |i: usize| {
            let (j, distinct) = best_of_a(i)?;
            let (back, back_distinct) = best_of_b(j)?;
            let matched = Match { a: i as u32, b: j as u32, distance: apart(i, j) };
            (back == i && distinct && back_distinct).then_some(matched)
        };
        (0..a.len()).filter_map(mutual).collect()
    }

    fn points() -> impl Strategy<Value = Vec<Point>> {
        proptest::collection::vec((0_u8..4, 0_i16..100, 0_i16..60, 0_u8..20), 0..120)
    }

    proptest! {
        #[test]
        fn matches_equal_brute_force(a in points(), b in points(), picky: bool, reach in 0_i32..80) {
            let ratio = if picky { 0.9 } else { 1.0 };
            let (a32, b32) = (indexed::<32>(a.clone()), indexed::<32>(b.clone()));
            let (a64, b64) = (indexed::<64>(a), indexed::<64>(b));
            let around = |u: &[i16], v: &[i16], i: usize| Some(Window::around(u[i].into(), v[i].into(), reach, reach));
            let found = mutual_best(&a32, &b32, ratio, |i| around(&a32.u, &a32.v, i));
            prop_assert_eq!(found, brute(&a32, &b32, ratio, reach));
            let found = mutual_best(&a64, &b64, ratio, |i| around(&a64.u, &a64.v, i));
            prop_assert_eq!(found, brute(&a64, &b64, ratio, reach));
            let afar = mutual_best_afar(&a32, &Wide::of(&b32, (100, 60)), 0.9, |i| around(&a32.u, &a32.v, i));
            prop_assert_eq!(afar, brute(&a32, &b32, 0.9, reach));
            let afar = mutual_best_afar(&a64, &Wide::of(&b64, (100, 60)), 0.9, |i| around(&a64.u, &a64.v, i));
            prop_assert_eq!(afar, brute(&a64, &b64, 0.9, reach));
            let (mut of_a, mut of_b) = (Best::of(a32.len()), Best::of(b32.len()));
            compare(&a32, &b32, |i| around(&a32.u, &a32.v, i), &mut of_a, &mut of_b);
            let (mut wide_a, mut wide_b) = (Best::of(a32.len()), Best::of(b32.len()));
            if wide::can(&a32, &b32) {
                wide::compare(&a32, &b32, |i| around(&a32.u, &a32.v, i), &mut wide_a, &mut wide_b);
                prop_assert_eq!((of_a.first, of_b.first), (wide_a.first, wide_b.first));
                let distances = |keys: Vec<Key>| keys.into_iter().map(distance_of).collect::<Vec<_>>();
                prop_assert_eq!(distances(of_a.second), distances(wide_a.second));
                prop_assert_eq!(distances(of_b.second), distances(wide_b.second));
            }
        }
    }
}
