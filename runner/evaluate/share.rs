//! How far a share of a traversal may lie from that of other roads like it: Wilson's interval (Wilson 1927) with as
//! many trials as the correlation along the road leaves (Korn and Graubard 1998), and Student's t in place of the
//! normal.

use super::spread::{ALIKE_M, along};
use super::student;

/// The 95 % interval of the share that `metres` add up to, each what a metre of road contributes; `None` of too little
/// road.
pub(super) fn interval(metres: &[f64]) -> Option<[f64; 2]> {
    let (variance, degrees) = along(metres)?;
    let road_m = metres.len() as f64;
    // Sums of many metres leave traces of rounding; all of a road must be all of it.
    let share = (metres.iter().sum::<f64>() * 1e9).round().clamp(0.0, 1e9) / 1e9;
    let binomial = share * (1.0 - share);
    // Never surer than if every metre stood alone.
    let correlated = if binomial > 0.0 { (binomial / variance).min(road_m) } else { road_m };
    // Where all that differs fits into one stretch, nothing shows how alike stretches are.
    let few = share.min(1.0 - share) <= ALIKE_M / road_m;
    let trials = if few { correlated.min(road_m / ALIKE_M) } else { correlated };
    Some(wilson(share, trials, student::critical(degrees)))
}

/// The 95 % interval of the share of some of `count` things that lie along a road, each taken to stand alone.
pub(super) fn of_things(share: f64, count: usize, road_m: usize) -> Option<[f64; 2]> {
    let degrees = super::spread::cosines(road_m, ALIKE_M)?;
    (count > 0).then(|| wilson(share, count as f64, student::critical(degrees)))
}

/// Frames, each with the distance travelled and whether it counts, as what each metre adds to their share. Metres
/// without a frame are left out.
pub(crate) fn per_metre(frames: impl Iterator<Item = (f64, bool)> + Clone) -> Vec<f64> {
    let total = frames.clone().count() as f64;
    let mut metres: Vec<(f64, f64)> = Vec::new();
    for (travelled_m, counts) in frames {
        let (metre, one) = (travelled_m.floor(), if counts { 1.0 / total } else { 0.0 });
        match metres.last_mut().filter(|last| last.0 == metre) {
            Some(last) => last.1 += one,
            None => metres.push((metre, one)),
        }
    }
    metres.into_iter().map(|(_, share)| share).collect()
}

/// The share of frames that count, with its interval where there is road enough.
pub(crate) fn share_of(frames: &[(f64, bool)]) -> (f64, Option<[f64; 2]>) {
    let metres = per_metre(frames.iter().copied());
    let counted = frames.iter().filter(|(_, counts)| *counts).count();
    (counted as f64 / frames.len().max(1) as f64, interval(&metres))
}

fn wilson(share: f64, trials: f64, reach: f64) -> [f64; 2] {
    let square = reach * reach / trials;
    let middle = (share + square / 2.0) / (1.0 + square);
    let half = reach / (1.0 + square) * (share * (1.0 - share) / trials + square / (4.0 * trials)).sqrt();
    [(middle - half).clamp(0.0, share), (middle + half).clamp(share, 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Newcombe (1998), table I, with the normal's 1.96.
    #[test]
    fn wilsons_interval_is_that_of_the_books() {
        for (count, of, low, high) in [(81.0, 263.0, 0.2553, 0.3662), (15.0, 148.0, 0.0624, 0.1605)] {
            let found = wilson(count / of, of, 1.959_964);
            assert!((found[0] - low).abs() < 1e-4 && (found[1] - high).abs() < 1e-4, "{found:?}");
        }
    }

    #[test]
    fn none_of_a_road_is_not_surely_none() {
        let none = interval(&[0.0; 200]).unwrap();
        // Twenty stretches of 10 m, eight degrees of freedom: 2.306^2 / (20 + 2.306^2).
        assert!(none[0] == 0.0 && (none[1] - 5.318 / 25.318).abs() < 1e-3, "{none:?}");
        assert_eq!(interval(&[0.0; 59]), None);
        let all: Vec<f64> = vec![1.0 / 200.0; 200];
        let all = interval(&all).unwrap();
        assert!((all[0] - 20.0 / 25.318).abs() < 1e-3 && all[1] > 1.0 - 1e-9, "{all:?}");
    }

    #[test]
    fn frames_are_counted_by_the_metre_they_lie_in() {
        let frames = [(0.2, true), (0.9, true), (1.0, false), (3.5, true)];
        assert_eq!(per_metre(frames.into_iter()), [0.5, 0.0, 0.25]);
        assert_eq!(share_of(&frames), (0.75, None));
    }
}
