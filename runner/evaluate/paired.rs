//! Whether one contender beats another on the same live traversals: differences with paired bootstrap intervals, of
//! moving blocks that go around. What makes a stretch of road hard is hard for both, so each replicate draws one set of
//! blocks for the two.

use super::bootstrap::{Blocks, REPLICATES, percentiles};
use super::lost::{CELL_M, Event, Stretches};
use super::{BLOCK_M, LEAST_M, Rules};
use furrow_model::{Difference, Verdict};

/// Keeps the blocks of different traversals apart.
const NEXT_PASS: u64 = 0x9E37_79B9_7F4A_7C15;

/// A live traversal and what two contenders made of it.
#[derive(Debug, Clone)]
pub(crate) struct Drive {
    /// Distance travelled at each frame, metres; never falling.
    pub travelled_m: Vec<f64>,
    /// The contender that is asked about.
    pub of: Course,
    /// The one that it should beat.
    pub over: Course,
}

/// What a contender made of each live frame.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Course {
    /// Whether it was accepted.
    pub good: Vec<bool>,
    /// Whether it was accepted and right; `None` where nobody knows.
    pub right: Option<Vec<bool>>,
}

/// The differences over all drives.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Differences {
    pub good: Difference,
    pub right: Option<Difference>,
    pub lost_fraction: Difference,
    pub area_m: Difference,
}

/// The differences of two contenders over some drives; blocks are drawn within each. Drives that come to less than
/// [`LEAST_M`] have too few blocks for an interval: theirs are all that could be.
pub(crate) fn differences(drives: &[Drive], rules: Rules) -> Differences {
    let found = drawn(drives, rules);
    let length_m = |drive: &Drive| drive.travelled_m.last().zip(drive.travelled_m.first()).map_or(0.0, |(b, a)| b - a);
    let route_m: f64 = drives.iter().map(length_m).sum();
    if route_m >= LEAST_M {
        return found;
    }
    let frames = drives.iter().map(|drive| drive.travelled_m.len()).sum::<usize>() as f64;
    let within = |difference: Difference, most: f64| {
        let most = most.max(difference.difference.abs());
        Difference { interval: [-most, most], verdict: Verdict::NotSeparable, ..difference }
    };
    Differences {
        good: within(found.good, frames),
        right: found.right.map(|right| within(right, frames)),
        lost_fraction: within(found.lost_fraction, 1.0),
        area_m: within(found.area_m, route_m),
    }
}

fn drawn(drives: &[Drive], rules: Rules) -> Differences {
    let (mut of, mut over) = (Totals::zero(), Totals::zero());
    let mut seed = rules.seed;
    for drive in drives {
        let blocks = DriveBlocks::draw(drive, seed);
        of.add(&blocks.totals(drive, &drive.of, rules));
        over.add(&blocks.totals(drive, &drive.over, rules));
        seed = seed.wrapping_add(NEXT_PASS);
    }
    let right = of.right.as_ref().zip(over.right.as_ref());
    Differences {
        good: difference(&of.good.0, &over.good.0, Wanted::More),
        right: right.map(|(of, over)| difference(&of.0, &over.0, Wanted::More)),
        lost_fraction: difference(&of.lost_m.per(&of.route_m), &over.lost_m.per(&over.route_m), Wanted::Less),
        area_m: difference(&of.area_m2.per(&of.route_m), &over.area_m2.per(&over.route_m), Wanted::Less),
    }
}

/// A sum as it was observed, then as each replicate has it.
struct Observed(Vec<f64>);

impl Observed {
    fn zero() -> Self {
        Self(vec![0.0; 1 + REPLICATES])
    }

    /// Replicates are scaled from their own number of places to the traversal's.
    fn of(observed: f64, replicates: Vec<f64>, scale: f64) -> Self {
        Self(std::iter::once(observed).chain(replicates.into_iter().map(|sum| sum * scale)).collect())
    }

    fn add(&mut self, other: &Self) {
        self.0.iter_mut().zip(&other.0).for_each(|(sum, other)| *sum += other);
    }

    fn per(&self, whole: &Self) -> Vec<f64> {
        let share = |(part, whole): (&f64, &f64)| if *whole > 0.0 { part / whole } else { 0.0 };
        self.0.iter().zip(&whole.0).map(share).collect()
    }
}

/// One contender's sums.
struct Totals {
    good: Observed,
    right: Option<Observed>,
    lost_m: Observed,
    /// The integral of the distance since the last localisation along the route.
    area_m2: Observed,
    route_m: Observed,
}

impl Totals {
    fn zero() -> Self {
        let zero = Observed::zero;
        Self { good: zero(), right: Some(zero()), lost_m: zero(), area_m2: zero(), route_m: zero() }
    }

    fn add(&mut self, other: &Self) {
        self.good.add(&other.good);
        self.right = self.right.take().zip(other.right.as_ref()).map(|(mut right, other)| {
            right.add(other);
            right
        });
        self.lost_m.add(&other.lost_m);
        self.area_m2.add(&other.area_m2);
        self.route_m.add(&other.route_m);
    }
}

/// The blocks of one drive: of frames for counts, of 0.1 m of road for what is lost. Both are drawn once for the two
/// contenders.
struct DriveBlocks {
    frames: Option<Blocks>,
    road: Option<Blocks>,
    start_m: f64,
    end_m: f64,
}

impl DriveBlocks {
    fn draw(drive: &Drive, seed: u64) -> Self {
        let at = |place: Option<&f64>| place.copied().unwrap_or(0.0);
        let (start_m, end_m) = (at(drive.travelled_m.first()), at(drive.travelled_m.last()));
        let (frames, cells) = (drive.travelled_m.len(), ((end_m - start_m) / CELL_M).round() as usize);
        Self {
            frames: (frames > 0).then(|| Blocks::draw(frames, block_frames(frames, end_m - start_m), seed)),
            road: (cells > 0).then(|| Blocks::draw(cells, (BLOCK_M / CELL_M) as usize, seed)),
            start_m,
            end_m,
        }
    }

    fn totals(&self, drive: &Drive, course: &Course, rules: Rules) -> Totals {
        let events: Vec<Event> = (drive.travelled_m.iter().zip(&course.good))
            .map(|(travelled_m, good)| Event { travelled_m: *travelled_m, localised: *good })
            .collect();
        let stretches = Stretches::of(&events, self.start_m, self.end_m, rules.censored);
        let road = stretches.along(self.start_m, self.end_m);
        let metres =
            |value: fn(f64) -> f64| move |cell: Option<f64>| cell.map_or(0.0, |since_m| value(since_m) * CELL_M);
        Totals {
            good: self.count(&course.good),
            right: course.right.as_ref().map(|right| self.count(right)),
            lost_m: self.road(stretches.lost_m(), &road, metres(|since_m| f64::from(u8::from(since_m > 0.0)))),
            area_m2: self.road(stretches.area_m2(), &road, metres(|since_m| since_m)),
            route_m: self.road(stretches.route_m(), &road, metres(|_| 1.0)),
        }
    }

    fn count(&self, frames: &[bool]) -> Observed {
        let one = |frame: usize| f64::from(u8::from(frames[frame]));
        let observed = frames.iter().filter(|frame| **frame).count() as f64;
        match &self.frames {
            Some(blocks) => Observed::of(observed, blocks.sums(one), frames.len() as f64 / blocks.cells() as f64),
            None => Observed::zero(),
        }
    }

    fn road(&self, observed: f64, road: &[Option<f64>], value: impl Fn(Option<f64>) -> f64) -> Observed {
        match &self.road {
            Some(blocks) => {
                let scale = road.len() as f64 / blocks.cells() as f64;
                Observed::of(observed, blocks.sums(|cell| value(road[cell])), scale)
            }
            None => Observed::zero(),
        }
    }
}

/// How many frames of a traversal make a block of 10 m.
pub(super) fn block_frames(frames: usize, driven_m: f64) -> usize {
    let spacing_m = driven_m / frames as f64;
    if spacing_m > 0.0 { (BLOCK_M / spacing_m).round() as usize } else { frames }
}

/// Which way is better.
#[derive(Clone, Copy, PartialEq)]
enum Wanted {
    More,
    Less,
}

fn difference(of: &[f64], over: &[f64], wanted: Wanted) -> Difference {
    let mut differences = of.iter().zip(over).map(|(of, over)| of - over);
    let difference = differences.next().unwrap_or(0.0) + 0.0;
    let [low, high] = percentiles(differences.map(rounded).collect()).unwrap_or([difference; 2]);
    let interval = [low.min(difference), high.max(difference)];
    let (above, below) = (interval[0] > 0.0, interval[1] < 0.0);
    let verdict = match wanted {
        Wanted::More if above => Verdict::Better,
        Wanted::Less if below => Verdict::Better,
        _ if above || below => Verdict::Worse,
        _ => Verdict::NotSeparable,
    };
    let at = |values: &[f64]| values.first().copied().unwrap_or(0.0);
    Difference { of: at(of), over: at(over), difference, interval, verdict }
}

/// Sums of many tenths of a metre leave traces of rounding; a difference of none must be none.
fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9 + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use furrow_model::Censored;

    const RULES: Rules = Rules { censored: Censored::Keep, seed: 3 };

    /// A drive with a frame every `spacing_m`.
    fn drive(frames: usize, spacing_m: f64, of: impl Fn(usize) -> bool, over: impl Fn(usize) -> bool) -> Drive {
        let course = |good: &dyn Fn(usize) -> bool| Course { good: (0..frames).map(good).collect(), right: None };
        Drive { travelled_m: (0..frames).map(|i| i as f64 * spacing_m).collect(), of: course(&of), over: course(&over) }
    }

    /// Good inside some stretches of 50 frames: a count that blocks of 10 m know very badly.
    fn in_runs(frame: usize) -> bool {
        (frame / 50).is_multiple_of(2)
    }

    #[test]
    fn a_contender_is_not_separable_from_itself() {
        let found = differences(&[drive(400, 0.1, in_runs, in_runs)], RULES);
        for difference in [found.good, found.lost_fraction, found.area_m] {
            assert_eq!((difference.difference, difference.interval), (0.0, [0.0; 2]));
            assert_eq!(difference.verdict, Verdict::NotSeparable);
        }
        assert_eq!(found.right, None);
    }

    #[test]
    fn a_drive_of_too_few_blocks_separates_nothing() {
        let at = |frames: usize| differences(&[drive(frames, 0.5, |_| true, |_| false)], RULES);
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
        let found = differences(&[drive(1000, 0.1, more, in_runs)], RULES).good;
        assert_eq!((found.of, found.over, found.difference), (530.0, 500.0, 30.0));
        assert_eq!((found.interval, found.verdict), ([30.0; 2], Verdict::Better));
        let found = differences(&[drive(1000, 0.1, in_runs, more)], RULES).good;
        assert_eq!((found.interval, found.verdict), ([-30.0; 2], Verdict::Worse));
    }

    /// Frames 10 m apart are blocks of their own, so the interval is that of a sum of independent differences, here -1,
    /// 0 and 1.
    #[test]
    fn single_frames_give_the_closed_form() {
        // Of every 8 frames the first has 3 more, the other 1 more: 2 of 8 net, a mean square of 4 of 8.
        let of = |frame: usize| [0, 1, 2, 4].contains(&(frame % 8));
        let over = |frame: usize| [3, 4].contains(&(frame % 8));
        let found = differences(&[drive(800, 10.0, of, over)], RULES).good;
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
        let found = differences(&[drive(1001, 0.1, often, once)], RULES);
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
        let found = drawn(&[drive(201, 0.1, half, seen)], RULES).lost_fraction;
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
        let long = drive(101, 0.1, all, |i| i < 51 || i == 100);
        let short = drive(51, 0.1, |i| i == 0 || i == 50, all);
        let found = drawn(&[long, short], RULES);
        assert_eq!((found.good.of, found.good.over), (103.0, 52.0 + 51.0));
        assert_eq!((found.good.difference, found.good.interval), (0.0, [0.0; 2]));
        // Lost: 5 m of 15 m by the first, 5 m of 15 m by the other.
        assert!(found.lost_fraction.difference.abs() < 1e-9 && (found.lost_fraction.of - 1.0 / 3.0).abs() < 1e-9);
    }

    #[test]
    fn right_ones_need_a_truth_of_every_pass_and_nothing_is_needed_at_all() {
        let mut known = drive(50, 0.7, in_runs, in_runs);
        known.of.right = Some(vec![true; 50]);
        known.over.right = Some(vec![false; 50]);
        let unknown = drive(50, 0.7, in_runs, in_runs);
        let found = differences(&[known.clone()], RULES).right;
        assert_eq!(found.map(|right| (right.difference, right.verdict)), Some((50.0, Verdict::Better)));
        assert_eq!(differences(&[known, unknown], RULES).right, None);
        let empty = differences(&[drive(0, 1.0, in_runs, in_runs)], RULES);
        assert_eq!((empty.good.difference, empty.area_m.interval), (0.0, [0.0; 2]));
    }
}
