//! Lost-distance curves (SPEC 4.1; thesis Fig 6.3).

use furrow_model::{LostDistance, LostPoint};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A live frame's fate on its route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Distance travelled when it was taken, metres; never falling from event to event.
    pub travelled_m: f64,
    /// Whether it was localised and accepted.
    pub localised: bool,
}

/// Two neighbouring localisations farther apart than this many median event spacings count as a lost stretch: frames are missing.
const CONTINUITY: f64 = 2.0;
/// But never within this distance: a robot that stands still for half its frames has a median spacing of nearly nothing.
const LEAST_GAP_M: f64 = 0.5;
/// Blocks of the moving-block bootstrap, metres.
const BLOCK_M: f64 = 10.0;
/// Resolution at which blocks are drawn, metres.
const CELL_M: f64 = 0.1;
/// Bootstrap replicates.
const REPLICATES: usize = 400;

/// A stretch of route driven without a localisation.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Stretch {
    from_m: f64,
    to_m: f64,
}

impl Stretch {
    fn length_m(self) -> f64 {
        self.to_m - self.from_m
    }
}

/// The lost stretches of a pass from `start_m` to `end_m` and their curves. `events` are in the order driven. Stretches cut off by the route's
/// ends are included. `seed` draws the bootstrap's blocks.
pub fn lost_distance(events: &[Event], start_m: f64, end_m: f64, seed: u64) -> LostDistance {
    let route_m = (end_m - start_m).max(0.0);
    let stretches = stretches(events, start_m, end_m);
    let lengths: Vec<f64> = stretches.iter().map(|stretch| stretch.length_m()).collect();
    // An empty sum of floats is -0.
    let lost_m = lengths.iter().sum::<f64>() + 0.0;
    let share = |metres: f64| if route_m > 0.0 { metres / route_m } else { 0.0 };
    let grid = distances(route_m);
    let bands = bands(&stretches, start_m, route_m, &grid, seed);
    let curve = grid.iter().zip(bands).map(|(&distance_m, (low, high))| {
        let longer = || lengths.iter().copied().filter(|length| *length > distance_m);
        let survival = share(longer().map(|length| length - distance_m).sum::<f64>() + 0.0);
        LostPoint {
            distance_m,
            survival,
            survival_low: low.min(survival),
            survival_high: high.max(survival),
            length_biased: share(longer().sum::<f64>() + 0.0),
            per_gap: if lengths.is_empty() { 0.0 } else { longer().count() as f64 / lengths.len() as f64 },
        }
    });
    LostDistance {
        route_m,
        lost_fraction: share(lost_m),
        max_lost_m: lengths.iter().copied().fold(0.0, f64::max),
        mean_lost_m: if lengths.is_empty() { 0.0 } else { lost_m / lengths.len() as f64 },
        area_m: share(lengths.iter().map(|length| length * length / 2.0).sum::<f64>() + 0.0),
        curve: curve.collect(),
        stretches_m: lengths,
    }
}

/// Maximal runs with at least one failed event, from the localisation before to the one after; and pairs of localisations too far apart.
fn stretches(events: &[Event], start_m: f64, end_m: f64) -> Vec<Stretch> {
    let continuity_m = (CONTINUITY * median_spacing(events)).max(LEAST_GAP_M);
    let mut stretches = Vec::new();
    let (mut last_m, mut failed) = (start_m, false);
    let mut push = |from_m: f64, to_m: f64| {
        if to_m > from_m {
            stretches.push(Stretch { from_m, to_m });
        }
    };
    for (i, event) in events.iter().enumerate() {
        if !event.localised {
            failed = true;
            continue;
        }
        let missing_frames = i > 0 && event.travelled_m - last_m > continuity_m;
        if failed || missing_frames {
            push(last_m, event.travelled_m);
        }
        (last_m, failed) = (event.travelled_m, false);
    }
    if failed || events.is_empty() {
        push(last_m, end_m);
    }
    stretches
}

fn median_spacing(events: &[Event]) -> f64 {
    let mut spacings: Vec<f64> = events.windows(2).map(|pair| pair[1].travelled_m - pair[0].travelled_m).collect();
    spacings.sort_by(f64::total_cmp);
    // Without two events no spacing is known, and no pair of localisations can be too far apart.
    spacings.get(spacings.len() / 2).copied().unwrap_or(f64::INFINITY)
}

/// Where curves are drawn: every 0.25 m to 10 m, every metre to 50 m, every 5 m to the route's end.
fn distances(route_m: f64) -> Vec<f64> {
    let fine = (0..40).map(|i| f64::from(i) * 0.25);
    let middle = (10..50).map(f64::from);
    let coarse = (10..).map(|i| f64::from(i) * 5.0).take_while(move |d| *d <= route_m.max(50.0));
    fine.chain(middle).chain(coarse).collect()
}

/// The 95 % band of the survival curve: the route is cut into cells, each knowing how far the robot had driven since its last localisation,
/// and put together anew from blocks of 10 m that begin anywhere.
fn bands(stretches: &[Stretch], start_m: f64, route_m: f64, grid: &[f64], seed: u64) -> Vec<(f64, f64)> {
    let cells = (route_m / CELL_M).round() as usize;
    if cells == 0 {
        return vec![(0.0, 0.0); grid.len()];
    }
    let since_m: Vec<f64> = (0..cells)
        .map(|cell| {
            let here_m = start_m + (cell as f64 + 0.5) * CELL_M;
            let inside = stretches.iter().find(|stretch| stretch.from_m < here_m && here_m < stretch.to_m);
            inside.map_or(0.0, |stretch| here_m - stretch.from_m)
        })
        .collect();
    let block = ((BLOCK_M / CELL_M) as usize).min(cells);
    let blocks = cells.div_ceil(block);
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let starts: Vec<usize> = (0..REPLICATES * blocks).map(|_| random.random_range(0..=cells - block)).collect();
    grid.iter()
        .map(|distance_m| {
            let mut before = vec![0_u32; cells + 1];
            for (cell, since) in since_m.iter().enumerate() {
                before[cell + 1] = before[cell] + u32::from(since > distance_m);
            }
            let longer = |start: &usize| before[start + block] - before[*start];
            let mut shares: Vec<f64> = starts
                .chunks(blocks)
                .map(|replicate| f64::from(replicate.iter().map(longer).sum::<u32>()) / (blocks * block) as f64)
                .collect();
            shares.sort_by(f64::total_cmp);
            (shares[REPLICATES / 40], shares[REPLICATES - 1 - REPLICATES / 40])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A 100 m route with an event every 0.5 m, lost inside the given stretches.
    fn route(lost: &[(f64, f64)]) -> LostDistance {
        let event = |i: i32| {
            let travelled_m = f64::from(i) * 0.5;
            let localised = !lost.iter().any(|(from, to)| travelled_m > *from && travelled_m < *to);
            Event { travelled_m, localised }
        };
        lost_distance(&(0..=200).map(event).collect::<Vec<_>>(), 0.0, 100.0, 1)
    }

    fn at(lost: &LostDistance, distance_m: f64) -> (f64, f64, f64) {
        let point = lost.curve.iter().find(|point| point.distance_m == distance_m).unwrap();
        (point.survival, point.length_biased, point.per_gap)
    }

    /// The table of SPEC 4.1 for thesis Fig 6.3: five separated stretches of 10 m against one of 50 m.
    #[test]
    fn figure_6_3_is_exact() {
        let often = route(&[(5.0, 15.0), (25.0, 35.0), (45.0, 55.0), (65.0, 75.0), (85.0, 95.0)]);
        let once = route(&[(20.0, 70.0)]);
        let table = [
            (0.0, (0.50, 0.5, 1.0), (0.50, 0.5, 1.0)),
            (5.0, (0.25, 0.5, 1.0), (0.45, 0.5, 1.0)),
            (10.0, (0.0, 0.0, 0.0), (0.40, 0.5, 1.0)),
            (25.0, (0.0, 0.0, 0.0), (0.25, 0.5, 1.0)),
            (50.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        ];
        for (distance_m, a, b) in table {
            assert_eq!(at(&often, distance_m), a, "five stretches of 10 m, d = {distance_m}");
            assert_eq!(at(&once, distance_m), b, "one stretch of 50 m, d = {distance_m}");
        }
        assert_eq!((often.area_m, once.area_m), (2.5, 12.5));
        assert_eq!((often.max_lost_m, once.max_lost_m, once.mean_lost_m), (10.0, 50.0, 50.0));
    }

    #[test]
    fn a_pass_without_localisation_is_one_stretch() {
        let nothing = |travelled_m| Event { travelled_m, localised: false };
        let lost = lost_distance(&[nothing(2.0), nothing(30.0)], 0.0, 40.0, 1);
        assert_eq!((lost.stretches_m, lost.lost_fraction), (vec![40.0], 1.0));
        assert_eq!(lost_distance(&[], 0.0, 40.0, 1).stretches_m, [40.0]);
    }

    #[test]
    fn ends_belong_to_the_stretches() {
        let event = |travelled_m, localised| Event { travelled_m, localised };
        let events = [event(1.0, false), event(2.0, true), event(3.0, true), event(4.0, false)];
        assert_eq!(lost_distance(&events, 0.0, 5.0, 1).stretches_m, [2.0, 2.0]);
    }

    #[test]
    fn standing_still_loses_nothing() {
        let event = |travelled_m| Event { travelled_m, localised: true };
        let events: Vec<Event> =
            (0..60).map(|i| event(f64::from(i) * 1e-3)).chain((1..40).map(|i| event(f64::from(i) * 0.1))).collect();
        assert_eq!(lost_distance(&events, 0.0, 3.9, 1).stretches_m, [0.0; 0]);
    }

    #[test]
    fn missing_frames_count_as_lost() {
        let event = |travelled_m| Event { travelled_m, localised: true };
        let events = [0.0, 1.0, 2.0, 7.0, 8.0, 9.0].map(event);
        assert_eq!(lost_distance(&events, 0.0, 9.0, 1).stretches_m, [5.0]);
    }

    #[test]
    fn the_band_holds_the_curve_and_is_repeatable() {
        let lost = route(&[(5.0, 15.0), (45.0, 55.0)]);
        assert!(lost.curve.iter().all(|p| p.survival_low <= p.survival && p.survival <= p.survival_high));
        assert!(lost.curve[0].survival_high > lost.curve[0].survival_low);
        assert_eq!(lost, route(&[(5.0, 15.0), (45.0, 55.0)]));
    }
}
