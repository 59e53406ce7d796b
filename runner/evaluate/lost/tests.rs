use super::*;

/// A 100 m route with an event every 0.5 m, lost inside the given stretches.
fn route(lost: &[(f64, f64)]) -> LostDistance {
    let event = |i: i32| {
        let travelled_m = f64::from(i) * 0.5;
        let localised = !lost.iter().any(|(from, to)| travelled_m > *from && travelled_m < *to);
        Event { travelled_m, localised }
    };
    lost_distance(&(0..=200).map(event).collect::<Vec<_>>(), 0.0, 100.0, Censored::Keep)
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
    let lost = lost_distance(&[nothing(2.0), nothing(30.0)], 0.0, 40.0, Censored::Keep);
    assert_eq!((lengths(&lost), lost.lost_fraction), (vec![40.0], 1.0));
    assert_eq!(lengths(&lost_distance(&[], 0.0, 40.0, Censored::Keep)), [40.0]);
}

#[test]
fn ends_belong_to_the_stretches() {
    let event = |travelled_m, localised| Event { travelled_m, localised };
    let events = [event(1.0, false), event(2.0, true), event(3.0, true), event(4.0, false)];
    assert_eq!(lengths(&lost_distance(&events, 0.0, 5.0, Censored::Keep)), [2.0, 2.0]);
}

#[test]
fn dropping_cut_off_stretches_shortens_the_route() {
    let event = |i: i32| {
        let travelled_m = f64::from(i);
        let localised = (20..=50).contains(&i) || (60..=90).contains(&i);
        Event { travelled_m, localised }
    };
    let events: Vec<Event> = (0..=100).map(event).collect();
    let kept = lost_distance(&events, 0.0, 100.0, Censored::Keep);
    assert_eq!(kept.stretches.iter().map(|s| s.censored).collect::<Vec<_>>(), [true, false, true]);
    assert_eq!((lengths(&kept), kept.lost_fraction), (vec![20.0, 10.0, 10.0], 0.4));
    let dropped = lost_distance(&events, 0.0, 100.0, Censored::Drop);
    assert_eq!((lengths(&dropped), dropped.route_m), (vec![10.0], 70.0));
    assert_eq!(dropped.lost_fraction, 10.0 / 70.0);
    let never = lost_distance(&[Event { travelled_m: 3.0, localised: false }], 0.0, 40.0, Censored::Drop);
    assert_eq!((lengths(&never), never.lost_fraction), (vec![40.0], 1.0));
}

#[test]
fn standing_still_loses_nothing() {
    let event = |travelled_m| Event { travelled_m, localised: true };
    let events: Vec<Event> =
        (0..60).map(|i| event(f64::from(i) * 1e-3)).chain((1..40).map(|i| event(f64::from(i) * 0.1))).collect();
    assert_eq!(lengths(&lost_distance(&events, 0.0, 3.9, Censored::Keep)), [0.0; 0]);
}

#[test]
fn missing_frames_count_as_lost() {
    let event = |travelled_m| Event { travelled_m, localised: true };
    let events = [0.0, 1.0, 2.0, 7.0, 8.0, 9.0].map(event);
    assert_eq!(lengths(&lost_distance(&events, 0.0, 9.0, Censored::Keep)), [5.0]);
}

#[test]
fn bands_hold_their_curves_and_are_repeatable() {
    let lost = route(&[(5.0, 15.0), (45.0, 55.0), (80.0, 83.0)]);
    let holds = |value: f64, band: Option<[f64; 2]>| band.is_some_and(|[low, high]| low <= value && value <= high);
    for p in &lost.curve {
        assert!(holds(p.survival, p.survival_band) && holds(p.length_biased, p.length_biased_band), "{p:?}");
        assert!(holds(p.per_gap, p.per_gap_band), "{p:?}");
    }
    let first = &lost.curve[0];
    for band in [first.survival_band, first.length_biased_band, first.per_gap_band] {
        assert!(band.is_some_and(|[low, high]| high > low), "{first:?}");
    }
    let short = lost_distance(&[Event { travelled_m: 3.0, localised: true }], 0.0, 40.0, Censored::Keep);
    assert!(short.curve.iter().all(|point| point.survival_band.is_none()), "40 m are too little road");
    assert_eq!(lost, route(&[(5.0, 15.0), (45.0, 55.0), (80.0, 83.0)]));
}
