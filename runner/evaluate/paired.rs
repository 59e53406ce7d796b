//! Whether one contender beats another on the same live traversals: differences metre by metre of road, and how sure
//! they are. What makes a stretch of road hard is hard for both, so each metre's difference is one value.

use super::Rules;
use super::lost::{CELL_M, Event, Stretches};
use super::spread::spread;
use super::student;
use furrow_model::{Censored, Difference, Verdict};

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

/// The differences of two contenders over some traversals.
pub(crate) fn differences(traversals: &[Compared], rules: Rules) -> Differences {
    let roads: Vec<Road> = traversals.iter().map(Road::of).collect();
    let frames: usize = traversals.iter().map(|traversal| traversal.travelled_m.len()).sum();
    let count = |flags: fn(&Course) -> Option<&Vec<bool>>| {
        let sums = |course: fn(&Compared) -> &Course| -> Option<Vec<PerMetre>> {
            let one = |(traversal, road): (&Compared, &Road)| {
                Some(road.frames(&traversal.travelled_m, flags(course(traversal))?))
            };
            traversals.iter().zip(&roads).map(one).collect()
        };
        Some(difference(&sums(|both| &both.of)?, &sums(|both| &both.over)?, Wanted::More, frames as f64))
    };
    let lost = |course: fn(&Compared) -> &Course| -> Vec<Stretches> {
        let one = |(traversal, road): (&Compared, &Road)| {
            road.stretches(&traversal.travelled_m, &course(traversal).good, rules.censored)
        };
        traversals.iter().zip(&roads).map(one).collect()
    };
    let (of, over) = (lost(|both| &both.of), lost(|both| &both.over));
    let shares = |stretches: &[Stretches], whole: fn(&Stretches) -> f64, at: fn(f64) -> f64| -> Vec<PerMetre> {
        let route_m: f64 = stretches.iter().map(Stretches::route_m).sum();
        let share = |value: f64| if route_m > 0.0 { value / route_m } else { 0.0 };
        let one = |(stretches, road): (&Stretches, &Road)| PerMetre {
            sum: share(whole(stretches)),
            metres: road.cells(stretches, |since_m| share(at(since_m) * CELL_M)),
        };
        stretches.iter().zip(&roads).map(one).collect()
    };
    let lost_m: fn(f64) -> f64 = |since_m| f64::from(u8::from(since_m > 0.0));
    let share_lost = |stretches: &[Stretches]| shares(stretches, Stretches::lost_m, lost_m);
    let area = |stretches: &[Stretches]| shares(stretches, Stretches::area_m2, |since_m| since_m);
    let longest_m = roads.iter().map(|road| road.end_m - road.start_m).fold(0.0, f64::max);
    Differences {
        good: count(|course| Some(&course.good)).unwrap_or_else(|| difference(&[], &[], Wanted::More, 0.0)),
        right: count(|course| course.right.as_ref()),
        lost_fraction: difference(&share_lost(&of), &share_lost(&over), Wanted::Less, 1.0),
        area_m: difference(&area(&of), &area(&over), Wanted::Less, longest_m),
    }
}

/// A number of one contender on one traversal: as it was counted, and metre by metre of the road.
struct PerMetre {
    sum: f64,
    metres: Vec<f64>,
}

/// The road of a traversal, cut into metres.
struct Road {
    start_m: f64,
    end_m: f64,
    metres: usize,
}

impl Road {
    /// One that stands still is a metre; one without frames has none.
    fn of(traversal: &Compared) -> Self {
        let at = |place: Option<&f64>| place.copied().unwrap_or(0.0);
        let (start_m, end_m) = (at(traversal.travelled_m.first()), at(traversal.travelled_m.last()));
        let whole = (end_m - start_m).round() as usize;
        Self { start_m, end_m, metres: if traversal.travelled_m.is_empty() { 0 } else { whole.max(1) } }
    }

    /// The metre that a place lies in; what is left over at the end belongs to the last.
    fn metre(&self, travelled_m: f64) -> usize {
        ((travelled_m - self.start_m).max(0.0) as usize).min(self.metres.saturating_sub(1))
    }

    fn frames(&self, travelled_m: &[f64], flags: &[bool]) -> PerMetre {
        let mut metres = vec![0.0; self.metres];
        let mut sum = 0.0;
        for (travelled_m, _) in travelled_m.iter().zip(flags).filter(|(_, flag)| **flag) {
            metres[self.metre(*travelled_m)] += 1.0;
            sum += 1.0;
        }
        PerMetre { sum, metres }
    }

    fn stretches(&self, travelled_m: &[f64], good: &[bool], censored: Censored) -> Stretches {
        let event = |(travelled_m, good): (&f64, &bool)| Event { travelled_m: *travelled_m, localised: *good };
        let events: Vec<Event> = travelled_m.iter().zip(good).map(event).collect();
        Stretches::of(&events, self.start_m, self.end_m, censored)
    }

    /// The sum over each metre of `value`, of the distance travelled since the last localisation. What is not judged is
    /// nothing.
    fn cells(&self, stretches: &Stretches, value: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut metres = vec![0.0; self.metres];
        for (cell, since_m) in stretches.along(self.start_m, self.end_m).into_iter().enumerate() {
            let here_m = self.start_m + (cell as f64 + 0.5) * CELL_M;
            metres[self.metre(here_m)] += since_m.map_or(0.0, &value);
        }
        metres
    }
}

/// Which way is better.
#[derive(Clone, Copy, PartialEq)]
enum Wanted {
    More,
    Less,
}

/// The difference of two numbers; `most` is the greatest that could be.
fn difference(of: &[PerMetre], over: &[PerMetre], wanted: Wanted, most: f64) -> Difference {
    let sum = |all: &[PerMetre]| all.iter().map(|part| part.sum).sum::<f64>() + 0.0;
    let apart = |(of, over): (&PerMetre, &PerMetre)| -> Vec<f64> {
        of.metres.iter().zip(&over.metres).map(|(of, over)| rounded(of - over)).collect()
    };
    let (of_sum, over_sum) = (sum(of), sum(over));
    let difference = of_sum - over_sum + 0.0;
    let unknown = Difference {
        of: of_sum,
        over: over_sum,
        difference,
        verdict: Verdict::TooLittleRoad,
        interval: None,
        p: None,
        p_holm: None,
        blocks: None,
        block_m: None,
        error_within: None,
        error_between: None,
    };
    let Some(spread) = spread(&of.iter().zip(over).map(apart).collect::<Vec<_>>()) else { return unknown };
    let error = spread.variance.sqrt();
    let reach = student::critical(spread.degrees) * error;
    let most = most.max(difference.abs());
    let interval = [(difference - reach).max(-most), (difference + reach).min(most)].map(rounded);
    let interval = [interval[0].min(difference), interval[1].max(difference)];
    let (above, below) = (error > 0.0 && interval[0] > 0.0, error > 0.0 && interval[1] < 0.0);
    let verdict = match wanted {
        Wanted::More if above => Verdict::Better,
        Wanted::Less if below => Verdict::Better,
        _ if above || below => Verdict::Worse,
        _ => Verdict::NotSeparable,
    };
    let p = if error > 0.0 { student::two_sided_p(difference / error, spread.degrees) } else { 1.0 };
    Difference {
        verdict,
        interval: Some(interval),
        p: Some(p),
        blocks: Some(spread.blocks),
        block_m: Some(spread.block_m),
        error_within: spread.within.map(f64::sqrt),
        error_between: spread.between.map(f64::sqrt),
        ..unknown
    }
}

/// Sums of many tenths of a metre leave traces of rounding; a difference of none must be none.
fn rounded(value: f64) -> f64 {
    (value * 1e9).round() / 1e9 + 0.0
}

#[cfg(test)]
mod tests;
