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

/// The best partner seen so far, and the second best distance.
#[derive(Clone, Copy)]
struct Best {
    partner: u32,
    distance: u32,
    second: u32,
}

const NONE: Best = Best { partner: u32::MAX, distance: u32::MAX, second: u32::MAX };

impl Best {
    #[inline]
    fn offer(&mut self, partner: u32, distance: u32) {
        if distance < self.distance {
            *self = Best { partner, distance, second: self.distance };
        } else if distance < self.second {
            self.second = distance;
        }
    }

    fn is_distinct(&self, ratio: f64) -> bool {
        self.second == u32::MAX || f64::from(self.distance) < ratio * f64::from(self.second) || ratio >= 1.0
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
    mut window: impl FnMut(usize) -> Option<Window>,
) -> Vec<Match> {
    let mut of_a = vec![NONE; a.len()];
    let mut of_b = vec![NONE; b.len()];
    for (i, best) in of_a.iter_mut().enumerate() {
        let Some(window) = window(i) else { continue };
        let descriptor = &a.descriptors[i];
        b.for_each_in(a.class[i], window, |j| {
            let distance = distance(descriptor, &b.descriptors[j]);
            best.offer(j as u32, distance);
            of_b[j].offer(i as u32, distance);
        });
    }
    let mut matches = Vec::new();
    for (i, best) in of_a.iter().enumerate() {
        let Some(back) = of_b.get(best.partner as usize) else { continue };
        if back.partner == i as u32 && best.is_distinct(ratio) && back.is_distinct(ratio) {
            matches.push(Match { a: i as u32, b: best.partner, distance: best.distance });
        }
    }
    matches
}
