//! Whether one contender beats another on the same live traversals: differences with paired bootstrap intervals, of
//! moving blocks that go around. What makes a stretch of road hard is hard for both, so each replicate draws one set of
//! blocks for the two.

use super::bootstrap::{Blocks, REPLICATES, percentiles};
use super::lost::{CELL_M, Event, Stretches};
use super::{BLOCK_M, LEAST_M, Rules};
use furrow_model::{Difference, Verdict};

/// Keeps the blocks of different traversals apart.
const NEXT_TRAVERSAL: u64 = 0x9E37_79B9_7F4A_7C15;

/// A live traversal and what two contenders made of it.
#[derive(Debug, Clone)]
pub(crate) struct Compared {
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

/// The differences over all traversals.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Differences {
    pub good: Difference,
    pub right: Option<Difference>,
    pub lost_fraction: Difference,
    pub area_m: Difference,
}

/// The differences of two contenders over some traversals; blocks are drawn within each. Traversals that come to less
/// than [`LEAST_M`] have too few blocks for an interval: theirs are all that could be.
pub(crate) fn differences(traversals: &[Compared], rules: Rules) -> Differences {
    let found = drawn(traversals, rules);
    let length_m = |traversal: &Compared| {
        traversal.travelled_m.last().zip(traversal.travelled_m.first()).map_or(0.0, |(b, a)| b - a)
    };
    let route_m: f64 = traversals.iter().map(length_m).sum();
    if route_m >= LEAST_M {
        return found;
    }
    let frames = traversals.iter().map(|traversal| traversal.travelled_m.len()).sum::<usize>() as f64;
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

fn drawn(traversals: &[Compared], rules: Rules) -> Differences {
    let (mut of, mut over) = (Totals::zero(), Totals::zero());
    let mut seed = rules.seed;
    for traversal in traversals {
        let blocks = TraversalBlocks::draw(traversal, seed);
        of.add(&blocks.totals(traversal, &traversal.of, rules));
        over.add(&blocks.totals(traversal, &traversal.over, rules));
        seed = seed.wrapping_add(NEXT_TRAVERSAL);
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

/// The blocks of one traversal: of frames for counts, of 0.1 m of road for what is lost. Both are drawn once for the
/// two contenders.
struct TraversalBlocks {
    frames: Option<Blocks>,
    road: Option<Blocks>,
    start_m: f64,
    end_m: f64,
}

impl TraversalBlocks {
    fn draw(traversal: &Compared, seed: u64) -> Self {
        let at = |place: Option<&f64>| place.copied().unwrap_or(0.0);
        let (start_m, end_m) = (at(traversal.travelled_m.first()), at(traversal.travelled_m.last()));
        let (frames, cells) = (traversal.travelled_m.len(), ((end_m - start_m) / CELL_M).round() as usize);
        Self {
            frames: (frames > 0).then(|| Blocks::draw(frames, block_frames(frames, end_m - start_m), seed)),
            road: (cells > 0).then(|| Blocks::draw(cells, (BLOCK_M / CELL_M) as usize, seed)),
            start_m,
            end_m,
        }
    }

    fn totals(&self, traversal: &Compared, course: &Course, rules: Rules) -> Totals {
        let events: Vec<Event> = (traversal.travelled_m.iter().zip(&course.good))
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
mod tests;
