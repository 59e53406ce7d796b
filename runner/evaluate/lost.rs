//! Lost-distance curves (thesis 6.3, Fig 6.3; as in Churchill and Newman 2013, Linegar et al. 2015, Porav et al. 2018).

mod bands;

pub(super) use bands::CELL_M;
use bands::{Band, Span, bands};
use furrow_model::{Censored, LostDistance, LostPoint, LostStretch};

/// A live frame's fate on its route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Distance travelled when it was taken, metres; never falling from event to event.
    pub travelled_m: f64,
    /// Whether it was localised and accepted.
    pub localised: bool,
}

/// Two neighbouring localisations farther apart than this many median event spacings count as a lost stretch: frames
/// are missing.
const CONTINUITY: f64 = 2.0;
/// But never within this distance: a robot that stands still for half its frames has a median spacing of nearly
/// nothing.
const LEAST_GAP_M: f64 = 0.5;

/// The lost stretches of a traversal from `start_m` to `end_m` and their curves. `events` are in the order driven.
/// `seed` draws the bootstrap's blocks. A traversal without any localisation keeps its one stretch also where cut-off
/// ones are dropped: nothing else would be left to judge.
pub fn lost_distance(events: &[Event], start_m: f64, end_m: f64, censored: Censored, seed: u64) -> LostDistance {
    Stretches::of(events, start_m, end_m, censored).curves(seed)
}

/// Where a traversal was lost, before anything is drawn of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Stretches {
    lost: Vec<LostStretch>,
    span: Span,
}

impl Stretches {
    /// As [`lost_distance`].
    pub fn of(events: &[Event], start_m: f64, end_m: f64, censored: Censored) -> Self {
        let mut lost = stretches(events, start_m, end_m);
        let mut span = Span { from_m: start_m, to_m: end_m.max(start_m) };
        if censored == Censored::Drop && events.iter().any(|event| event.localised) {
            span = uncensored(&lost, span);
            lost.retain(|stretch| !stretch.censored);
        }
        Self { lost, span }
    }

    fn lengths(&self) -> impl ExactSizeIterator<Item = f64> {
        self.lost.iter().map(|stretch| stretch.length_m())
    }

    /// What share of the route `metres` are.
    fn share(&self, metres: f64) -> f64 {
        let route_m = self.route_m();
        // An empty sum of floats is -0.
        if route_m > 0.0 { (metres + 0.0) / route_m } else { 0.0 }
    }

    /// The share of the route driven lost.
    pub fn fraction(&self) -> f64 {
        self.share(self.lost_m())
    }

    /// The longest stretch, metres.
    pub fn max_m(&self) -> f64 {
        self.lengths().fold(0.0, f64::max)
    }

    /// The route's length in metres, without what was dropped.
    pub fn route_m(&self) -> f64 {
        self.span.to_m - self.span.from_m
    }

    /// Metres driven lost.
    pub fn lost_m(&self) -> f64 {
        self.lengths().sum::<f64>() + 0.0
    }

    /// The integral of the distance since the last localisation along the route, square metres: half the sum of squared
    /// lengths.
    pub fn area_m2(&self) -> f64 {
        self.lengths().map(|length| length * length / 2.0).sum::<f64>() + 0.0
    }

    /// Every 0.1 m of a traversal from `start_m` to `end_m`: metres driven since the last localisation, 0 where not
    /// lost; `None` where nothing is judged.
    pub(super) fn along(&self, start_m: f64, end_m: f64) -> Vec<Option<f64>> {
        let whole = Span { from_m: start_m, to_m: end_m };
        let places = bands::cells(&self.lost, whole).into_iter().enumerate();
        let judged = |cell: usize| {
            let here_m = start_m + (cell as f64 + 0.5) * CELL_M;
            self.span.from_m < here_m && here_m < self.span.to_m
        };
        places.map(|(i, cell)| judged(i).then_some(cell.since_m)).collect()
    }

    /// The curves. `seed` draws the bootstrap's blocks.
    pub fn curves(self, seed: u64) -> LostDistance {
        let route_m = self.route_m();
        let lengths: Vec<f64> = self.lengths().collect();
        let grid = distances(route_m);
        let bands = bands(&self.lost, self.span, &grid, seed);
        let curve = grid.iter().zip(bands).map(|(&distance_m, band)| {
            let longer = || lengths.iter().copied().filter(|length| *length > distance_m);
            let survival = self.share(longer().map(|length| length - distance_m).sum());
            let length_biased = self.share(longer().sum());
            let per_gap = if lengths.is_empty() { 0.0 } else { longer().count() as f64 / lengths.len() as f64 };
            LostPoint {
                distance_m,
                survival,
                survival_band: around(survival, band.survival),
                length_biased,
                length_biased_band: around(length_biased, band.length_biased),
                per_gap,
                per_gap_band: around(per_gap, band.per_gap),
            }
        });
        LostDistance {
            route_m,
            lost_fraction: self.fraction(),
            max_lost_m: self.max_m(),
            mean_lost_m: lengths.iter().sum::<f64>() / lengths.len().max(1) as f64 + 0.0,
            area_m: self.share(self.area_m2()),
            curve: curve.collect(),
            stretches: self.lost,
        }
    }
}

/// What is left of `span` without the stretches at its ends.
fn uncensored(stretches: &[LostStretch], span: Span) -> Span {
    stretches.iter().filter(|stretch| stretch.censored).fold(span, |span, stretch| {
        if stretch.from_m <= span.from_m {
            Span { from_m: stretch.to_m, ..span }
        } else {
            Span { to_m: stretch.from_m, ..span }
        }
    })
}

/// A band that holds its value.
fn around(value: f64, band: Band) -> [f64; 2] {
    [band.low.min(value), band.high.max(value)]
}

/// Maximal runs with at least one failed event, from the localisation before to the one after; and pairs of
/// localisations too far apart.
fn stretches(events: &[Event], start_m: f64, end_m: f64) -> Vec<LostStretch> {
    let continuity_m = (CONTINUITY * median_spacing(events)).max(LEAST_GAP_M);
    let mut stretches = Vec::new();
    let (mut last_m, mut failed, mut localised_before) = (start_m, false, false);
    let mut push = |from_m: f64, to_m: f64, censored: bool| {
        if to_m > from_m {
            stretches.push(LostStretch { from_m, to_m, censored });
        }
    };
    for (i, event) in events.iter().enumerate() {
        if !event.localised {
            failed = true;
            continue;
        }
        let missing_frames = i > 0 && event.travelled_m - last_m > continuity_m;
        if failed || missing_frames {
            push(last_m, event.travelled_m, !localised_before);
        }
        (last_m, failed, localised_before) = (event.travelled_m, false, true);
    }
    if failed || events.is_empty() {
        push(last_m, end_m, true);
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
        lost_distance(&(0..=200).map(event).collect::<Vec<_>>(), 0.0, 100.0, Censored::Keep, 1)
    }

    fn lengths(lost: &LostDistance) -> Vec<f64> {
        lost.stretches.iter().map(|stretch| stretch.length_m()).collect()
    }

    fn at(lost: &LostDistance, distance_m: f64) -> (f64, f64, f64) {
        let point = lost.curve.iter().find(|point| point.distance_m == distance_m).unwrap();
        (point.survival, point.length_biased, point.per_gap)
    }

    /// A table by hand for thesis Fig 6.3: five separated stretches of 10 m against one of 50 m.
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
        let lost = lost_distance(&[nothing(2.0), nothing(30.0)], 0.0, 40.0, Censored::Keep, 1);
        assert_eq!((lengths(&lost), lost.lost_fraction), (vec![40.0], 1.0));
        assert_eq!(lengths(&lost_distance(&[], 0.0, 40.0, Censored::Keep, 1)), [40.0]);
    }

    #[test]
    fn ends_belong_to_the_stretches() {
        let event = |travelled_m, localised| Event { travelled_m, localised };
        let events = [event(1.0, false), event(2.0, true), event(3.0, true), event(4.0, false)];
        assert_eq!(lengths(&lost_distance(&events, 0.0, 5.0, Censored::Keep, 1)), [2.0, 2.0]);
    }

    #[test]
    fn dropping_cut_off_stretches_shortens_the_route() {
        let event = |i: i32| {
            let travelled_m = f64::from(i);
            let localised = (20..=50).contains(&i) || (60..=90).contains(&i);
            Event { travelled_m, localised }
        };
        let events: Vec<Event> = (0..=100).map(event).collect();
        let kept = lost_distance(&events, 0.0, 100.0, Censored::Keep, 1);
        assert_eq!(kept.stretches.iter().map(|s| s.censored).collect::<Vec<_>>(), [true, false, true]);
        assert_eq!((lengths(&kept), kept.lost_fraction), (vec![20.0, 10.0, 10.0], 0.4));
        let dropped = lost_distance(&events, 0.0, 100.0, Censored::Drop, 1);
        assert_eq!((lengths(&dropped), dropped.route_m), (vec![10.0], 70.0));
        assert_eq!(dropped.lost_fraction, 10.0 / 70.0);
        let never = lost_distance(&[Event { travelled_m: 3.0, localised: false }], 0.0, 40.0, Censored::Drop, 1);
        assert_eq!((lengths(&never), never.lost_fraction), (vec![40.0], 1.0));
    }

    #[test]
    fn standing_still_loses_nothing() {
        let event = |travelled_m| Event { travelled_m, localised: true };
        let events: Vec<Event> =
            (0..60).map(|i| event(f64::from(i) * 1e-3)).chain((1..40).map(|i| event(f64::from(i) * 0.1))).collect();
        assert_eq!(lengths(&lost_distance(&events, 0.0, 3.9, Censored::Keep, 1)), [0.0; 0]);
    }

    #[test]
    fn missing_frames_count_as_lost() {
        let event = |travelled_m| Event { travelled_m, localised: true };
        let events = [0.0, 1.0, 2.0, 7.0, 8.0, 9.0].map(event);
        assert_eq!(lengths(&lost_distance(&events, 0.0, 9.0, Censored::Keep, 1)), [5.0]);
    }

    #[test]
    fn bands_hold_their_curves_and_are_repeatable() {
        let lost = route(&[(5.0, 15.0), (45.0, 55.0), (80.0, 83.0)]);
        let holds = |value: f64, band: [f64; 2]| band[0] <= value && value <= band[1];
        for p in &lost.curve {
            assert!(holds(p.survival, p.survival_band) && holds(p.length_biased, p.length_biased_band), "{p:?}");
            assert!(holds(p.per_gap, p.per_gap_band), "{p:?}");
        }
        let first = &lost.curve[0];
        assert!(first.survival_band[1] > first.survival_band[0]);
        let middle = lost.curve.iter().find(|point| point.distance_m == 5.0).unwrap();
        assert!(middle.length_biased_band[1] > middle.length_biased_band[0], "{middle:?}");
        assert!(middle.per_gap_band[1] > middle.per_gap_band[0], "{middle:?}");
        assert_eq!(lost, route(&[(5.0, 15.0), (45.0, 55.0), (80.0, 83.0)]));
    }
}
