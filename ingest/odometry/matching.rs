//! Mutual best matches between two indexed sets of points.

use crate::index::{Index, Window, distance};

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
type Key = u64;
const NONE: Key = Key::MAX;

fn key(distance: u32, partner: usize) -> Key {
    u64::from(distance) << 32 | partner as u64
}

fn distance_of(key: Key) -> u32 {
    (key >> 32) as u32
}

/// The best and second best partner of every point of one side.
struct Best {
    first: Vec<Key>,
    second: Vec<Key>,
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
    if picky {
        compare::<N, true>(a, b, window, &mut of_a, &mut of_b);
    } else {
        compare::<N, false>(a, b, window, &mut of_a, &mut of_b);
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

/// Offers every pair to both sides; the second best is kept where `SECOND` says that it will be asked for.
fn compare<const N: usize, const SECOND: bool>(
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
            if SECOND {
                second = second.min(first.max(ours));
                of_b.second[j] = of_b.second[j].min(of_b.first[j].max(theirs));
            }
            first = first.min(ours);
            of_b.first[j] = of_b.first[j].min(theirs);
        });
        (of_a.first[i], of_a.second[i]) = (first, second);
    }
}
