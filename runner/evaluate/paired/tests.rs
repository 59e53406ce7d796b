use super::*;
use furrow_model::Censored;

const RULES: Rules = Rules { censored: Censored::Keep, seed: 3 };

/// A traversal with a frame every `spacing_m`.
fn traversal(frames: usize, spacing_m: f64, of: impl Fn(usize) -> bool, over: impl Fn(usize) -> bool) -> Compared {
    let course = |good: &dyn Fn(usize) -> bool| Course { good: (0..frames).map(good).collect(), right: None };
    Compared { travelled_m: (0..frames).map(|i| i as f64 * spacing_m).collect(), of: course(&of), over: course(&over) }
}

/// Good inside some stretches of 50 frames: a count that blocks of 10 m know very badly.
fn in_runs(frame: usize) -> bool {
    (frame / 50).is_multiple_of(2)
}

#[test]
fn a_contender_is_not_separable_from_itself() {
    let found = differences(&[traversal(400, 0.1, in_runs, in_runs)], RULES);
    for difference in [found.good, found.lost_fraction, found.area_m] {
        assert_eq!((difference.difference, difference.interval), (0.0, [0.0; 2]));
        assert_eq!(difference.verdict, Verdict::NotSeparable);
    }
    assert_eq!(found.right, None);
}

#[test]
fn a_drive_of_too_few_blocks_separates_nothing() {
    let at = |frames: usize| differences(&[traversal(frames, 0.5, |_| true, |_| false)], RULES);
    let (short, long) = (at(40), at(80));
    assert_eq!((short.good.difference, short.good.interval), (40.0, [-40.0, 40.0]));
    let verdicts = [short.good, short.lost_fraction, short.area_m].map(|difference| difference.verdict);
    assert_eq!(verdicts, [Verdict::NotSeparable; 3]);
    assert_eq!(long.good.verdict, Verdict::Better);
}

/// Three more localisations in every hundred frames, and blocks of a hundred: whatever blocks are drawn, the same
/// for both, the difference is the same. Were they drawn for each alone, the count of runs would drown it.
#[test]
fn what_is_hard_for_both_does_not_blur_the_difference() {
    let more = |frame: usize| in_runs(frame) || [60, 70, 80].contains(&(frame % 100));
    let found = differences(&[traversal(1000, 0.1, more, in_runs)], RULES).good;
    assert_eq!((found.of, found.over, found.difference), (530.0, 500.0, 30.0));
    assert_eq!((found.interval, found.verdict), ([30.0; 2], Verdict::Better));
    let found = differences(&[traversal(1000, 0.1, in_runs, more)], RULES).good;
    assert_eq!((found.interval, found.verdict), ([-30.0; 2], Verdict::Worse));
}

/// Frames 10 m apart are blocks of their own, so the interval is that of a sum of independent differences, here -1,
/// 0 and 1.
#[test]
fn single_frames_give_the_closed_form() {
    // Of every 8 frames the first has 3 more, the other 1 more: 2 of 8 net, a mean square of 4 of 8.
    let of = |frame: usize| [0, 1, 2, 4].contains(&(frame % 8));
    let over = |frame: usize| [3, 4].contains(&(frame % 8));
    let found = differences(&[traversal(800, 10.0, of, over)], RULES).good;
    let sd = (800.0 * (0.5 - 0.25_f64 * 0.25)).sqrt();
    assert_eq!(found.difference, 200.0);
    // 400 replicates know the end of 95 % to within about 2.5, and 8 are three times that.
    let [low, high] = found.interval;
    assert!(
        (low - (200.0 - 1.96 * sd)).abs() < 8.0 && (high - (200.0 + 1.96 * sd)).abs() < 8.0,
        "{low} to {high}, {sd}"
    );
}

/// The two robots of thesis Fig 6.3: lost 5 x 10 m, and once 50 m, of 100 m. As much is lost; the areas are 2.5 m
/// and 12.5 m.
#[test]
fn lost_stretches_are_told_apart_by_their_area() {
    let often = |i: usize| !(i % 200 > 100 && i < 1000);
    let once = |i: usize| !(200..700).contains(&i) || i == 200;
    let found = differences(&[traversal(1001, 0.1, often, once)], RULES);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
    assert!(near(found.lost_fraction.of, 0.5) && near(found.lost_fraction.over, 0.5), "{found:?}");
    assert!(near(found.area_m.of, 2.5) && near(found.area_m.over, 12.5), "{found:?}");
    assert!(near(found.area_m.difference, -10.0), "{found:?}");
    assert_eq!(found.area_m.verdict, Verdict::Better);
}

/// Replicates by hand: on a road of two blocks, half of it lost by one contender only, the shares are those of the
/// cells in the blocks drawn.
#[test]
fn replicates_are_the_shares_of_the_blocks_drawn() {
    let seen = |_: usize| true;
    let half = |i: usize| i <= 100;
    let found = drawn(&[traversal(201, 0.1, half, seen)], RULES).lost_fraction;
    let blocks = Blocks::draw(200, 100, RULES.seed);
    let mut shares: Vec<f64> =
        blocks.sums(|cell| u32::from(cell >= 100)).into_iter().map(|lost| f64::from(lost) / 200.0).collect();
    shares.sort_by(f64::total_cmp);
    let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
    assert!(near(found.difference, 0.5), "{found:?}");
    assert!(near(found.interval[0], shares[REPLICATES / 40]), "{found:?} {shares:?}");
    assert!(near(found.interval[1], shares[REPLICATES - 1 - REPLICATES / 40]), "{found:?}");
    assert_eq!(found.verdict, Verdict::Worse);
}

/// Traversals add up by their frames and metres; a traversal of one block has nothing to draw, so the pooled
/// interval is the sum itself.
#[test]
fn traversals_are_pooled_by_what_they_count() {
    let all = |_: usize| true;
    let long = traversal(101, 0.1, all, |i| i < 51 || i == 100);
    let short = traversal(51, 0.1, |i| i == 0 || i == 50, all);
    let found = drawn(&[long, short], RULES);
    assert_eq!((found.good.of, found.good.over), (103.0, 52.0 + 51.0));
    assert_eq!((found.good.difference, found.good.interval), (0.0, [0.0; 2]));
    // Lost: 5 m of 15 m by the first, 5 m of 15 m by the other.
    assert!(found.lost_fraction.difference.abs() < 1e-9 && (found.lost_fraction.of - 1.0 / 3.0).abs() < 1e-9);
}

#[test]
fn right_ones_need_a_truth_of_every_pass_and_nothing_is_needed_at_all() {
    let mut known = traversal(50, 0.7, in_runs, in_runs);
    known.of.right = Some(vec![true; 50]);
    known.over.right = Some(vec![false; 50]);
    let unknown = traversal(50, 0.7, in_runs, in_runs);
    let found = differences(&[known.clone()], RULES).right;
    assert_eq!(found.map(|right| (right.difference, right.verdict)), Some((50.0, Verdict::Better)));
    assert_eq!(differences(&[known, unknown], RULES).right, None);
    let empty = differences(&[traversal(0, 1.0, in_runs, in_runs)], RULES);
    assert_eq!((empty.good.difference, empty.area_m.interval), (0.0, [0.0; 2]));
}
