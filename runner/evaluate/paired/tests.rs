use super::*;
use furrow_model::Censored;

const RULES: Rules = Rules { censored: Censored::Keep };

/// A traversal with a frame every `spacing_m`.
fn traversal(frames: usize, spacing_m: f64, of: impl Fn(usize) -> bool, over: impl Fn(usize) -> bool) -> Compared {
    let course = |good: &dyn Fn(usize) -> bool| Course { good: (0..frames).map(good).collect(), right: None };
    Compared { travelled_m: (0..frames).map(|i| i as f64 * spacing_m).collect(), of: course(&of), over: course(&over) }
}

/// Good inside some stretches of 50 frames: a count that is known very badly.
fn in_runs(frame: usize) -> bool {
    (frame / 50).is_multiple_of(2)
}

#[test]
fn a_contender_is_not_separable_from_itself() {
    let found = differences(&[traversal(800, 0.1, in_runs, in_runs)], RULES);
    for difference in [found.good, found.lost_fraction, found.area_m] {
        assert_eq!((difference.difference, difference.interval), (0.0, Some([0.0; 2])));
        assert_eq!((difference.verdict, difference.p), (Verdict::NotSeparable, Some(1.0)));
    }
    assert_eq!(found.right, None);
}

#[test]
fn a_short_drive_has_no_interval() {
    let at = |frames: usize| differences(&[traversal(frames, 0.5, |_| true, |_| false)], RULES);
    let (short, long) = (at(100), at(140));
    for difference in [short.good, short.lost_fraction, short.area_m] {
        assert_eq!((difference.verdict, difference.interval, difference.p), (Verdict::TooLittleRoad, None, None));
    }
    assert_eq!(short.good.difference, 100.0);
    assert_eq!((long.good.verdict, long.lost_fraction.verdict), (Verdict::Better, Verdict::Better));
    // 70 m hold three stretches of 20 m, so three cosines.
    assert_eq!((long.good.blocks, long.good.block_m), (Some(4), Some(17.5)));
}

/// Three more localisations in every 10 m, on a road whose hard stretches are hard for both: the difference is the
/// same everywhere, though the counts are not.
#[test]
fn what_is_hard_for_both_does_not_blur_the_difference() {
    let more = |frame: usize| in_runs(frame) || [60, 70, 80].contains(&(frame % 100));
    let found = differences(&[traversal(1000, 0.1, more, in_runs)], RULES).good;
    assert_eq!((found.of, found.over, found.difference), (530.0, 500.0, 30.0));
    assert_eq!(found.verdict, Verdict::Better);
    // As sure as if the 30 frames stood alone, and not surer: the square root of 30 times Student's t, 5 stretches.
    let [low, high] = found.interval.unwrap();
    let reach = 2.571 * 30.0_f64.sqrt();
    assert!((low - (30.0 - reach)).abs() < 0.01 && (high - (30.0 + reach)).abs() < 0.01, "{low} to {high}");
    let found = differences(&[traversal(1000, 0.1, in_runs, more)], RULES).good;
    assert_eq!((found.interval, found.verdict), (Some([-high, -low]), Verdict::Worse));
}

/// The two robots of thesis Fig 6.3: lost 5 x 10 m, and once 50 m, of 100 m. As much is lost; the areas are 2.5 m
/// and 12.5 m. One stretch of road tells nothing of the next.
#[test]
fn lost_stretches_are_told_apart_by_their_area() {
    let often = |i: usize| !(i % 200 > 100 && i < 1000);
    let once = |i: usize| !(200..700).contains(&i) || i == 200;
    let found = differences(&[traversal(1001, 0.1, often, once)], RULES);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
    assert!(near(found.lost_fraction.of, 0.5) && near(found.lost_fraction.over, 0.5), "{found:?}");
    assert!(near(found.area_m.of, 2.5) && near(found.area_m.over, 12.5), "{found:?}");
    assert!(near(found.area_m.difference, -10.0), "{found:?}");
    assert_eq!(found.area_m.verdict, Verdict::NotSeparable);
}

/// Six traversals of 6 m that agree, by hand: Student's t of their differences.
#[test]
fn traversals_that_agree_are_told_by_student() {
    let pass = |more: usize| traversal(60, 0.1, move |i| i < 10 + more, |i| i < 10);
    let found = differences(&[20, 26, 22, 24, 18, 22].map(pass), RULES).good;
    // A sum of 132, and squares of 40 about the mean of 22.
    let error = (6.0 * 40.0 / 5.0_f64).sqrt();
    assert_eq!((found.difference, found.verdict, found.blocks), (132.0, Verdict::Better, Some(6)));
    assert!((found.error_between.unwrap() - error).abs() < 1e-9 && found.error_within.is_none(), "{found:?}");
    // Were metres alone, the error would be greater: ten frames in each of two metres, and the rest.
    let alone: f64 = [20_i32, 26, 22, 24, 18, 22].iter().map(|n| f64::from(n / 10 * 100 + (n % 10) * (n % 10))).sum();
    let [low, _] = found.interval.unwrap();
    assert!((low - (132.0 - 2.5706 * alone.sqrt().max(error))).abs() < 0.01, "{found:?}");
}

/// Traversals add up by their frames and metres.
#[test]
fn traversals_are_pooled_by_what_they_count() {
    let all = |_: usize| true;
    let long = traversal(101, 0.1, all, |i| i < 51 || i == 100);
    let short = traversal(51, 0.1, |i| i == 0 || i == 50, all);
    let found = differences(&[long, short], RULES);
    assert_eq!((found.good.of, found.good.over), (103.0, 52.0 + 51.0));
    assert_eq!((found.good.difference, found.good.verdict), (0.0, Verdict::NotSeparable));
    // Lost: 5 m of 15 m by the first, 5 m of 15 m by the other.
    assert!(found.lost_fraction.difference.abs() < 1e-9 && (found.lost_fraction.of - 1.0 / 3.0).abs() < 1e-9);
}

#[test]
fn right_ones_need_a_truth_of_every_pass_and_nothing_is_needed_at_all() {
    let mut known = traversal(100, 0.7, in_runs, in_runs);
    known.of.right = Some(vec![true; 100]);
    known.over.right = Some(vec![false; 100]);
    let unknown = traversal(50, 0.7, in_runs, in_runs);
    let found = differences(&[known.clone()], RULES).right;
    assert_eq!(found.map(|right| (right.difference, right.verdict)), Some((100.0, Verdict::Better)));
    assert_eq!(differences(&[known, unknown], RULES).right, None);
    let empty = differences(&[traversal(0, 1.0, in_runs, in_runs)], RULES);
    assert_eq!((empty.good.difference, empty.area_m.verdict), (0.0, Verdict::TooLittleRoad));
}
