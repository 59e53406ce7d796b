//! Two runs side by side, cell by cell: what changed, and whether anything got worse by more than is allowed.

use crate::RunError;
use furrow_catalog::Catalog;
use furrow_catalog::records::{RunCell, RunRecord};
use furrow_model::{Outcome, RunId, TimeSlot};
use serde::Serialize;
use std::collections::BTreeMap;

/// Two runs' cells, matched by live slot, name on the experience axis and setting.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Comparison {
    /// The run before.
    pub a: RunId,
    /// The run after.
    pub b: RunId,
    /// Cells that both finished, in the order of the first.
    pub cells: Vec<Compared>,
    /// Cells that only one of them has an outcome of.
    pub unmatched: Vec<Unmatched>,
}

/// A cell in two runs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Compared {
    /// The live slot.
    pub live: TimeSlot,
    /// What it is called on the experience axis.
    pub experience: String,
    /// What tells its setting from the others.
    pub setting: String,
    /// Whether both are the same cell: same inputs, parameters and algorithms.
    pub same: bool,
    /// Before.
    pub a: Numbers,
    /// After.
    pub b: Numbers,
    /// Good localisations per 100 live frames, after less before.
    pub change_points: f64,
    /// Whether the 95 % intervals of good localisations, each along its traversal, have no number in common. Never
    /// where a traversal is too short to have one.
    pub apart: bool,
}

/// The numbers that are compared.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Numbers {
    /// Live frames.
    pub frames: u32,
    /// Good localisations.
    pub good: u32,
    /// Their 95 % interval along the traversal, where that is long enough to have one.
    pub good_interval: Option<[u32; 2]>,
    /// Share of the route driven lost.
    pub lost_fraction: f64,
    /// The longest lost stretch, metres.
    pub max_lost_m: f64,
    /// Accepted and wrong, where a ground truth is known.
    pub wrong: Option<u32>,
}

/// A cell of one run only.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Unmatched {
    /// `a` or `b`.
    pub side: &'static str,
    /// The live slot.
    pub live: TimeSlot,
    /// What it is called on the experience axis.
    pub experience: String,
    /// What tells its setting from the others.
    pub setting: String,
}

/// What matches cells of two runs; of several with one name the first is matched with the first.
type Place = (TimeSlot, String, String, usize);

/// Compares the finished cells of two runs.
///
/// # Errors
/// Where a run or an outcome cannot be read.
pub fn compare(catalog: &Catalog, a: RunId, b: RunId) -> Result<Comparison, RunError> {
    let (before, after) = (finished(catalog, &catalog.run(a)?)?, finished(catalog, &catalog.run(b)?)?);
    let by_place: BTreeMap<&Place, &Outcome> = after.iter().map(|(place, outcome)| (place, outcome)).collect();
    let in_before: BTreeMap<&Place, &Outcome> = before.iter().map(|(place, outcome)| (place, outcome)).collect();
    let cells = before.iter().filter_map(|(place, outcome)| Some(compared(place, outcome, by_place.get(place)?)));
    let only = |side, of: &[(Place, Outcome)], other: &BTreeMap<&Place, &Outcome>| {
        let missing = of.iter().filter(|(place, _)| !other.contains_key(place));
        let missing = missing.map(|((live, experience, setting, _), _)| Unmatched {
            side,
            live: *live,
            experience: experience.clone(),
            setting: setting.clone(),
        });
        missing.collect::<Vec<_>>()
    };
    let mut unmatched = only("a", &before, &by_place);
    unmatched.extend(only("b", &after, &in_before));
    Ok(Comparison { a, b, cells: cells.collect(), unmatched })
}

impl Comparison {
    /// Cells that lost more than so many good localisations per 100 live frames.
    pub fn worse_than(&self, points: f64) -> impl Iterator<Item = &Compared> {
        self.cells.iter().filter(move |cell| -cell.change_points > points)
    }

    /// Cells of the first run that the second lacks: nobody knows whether they got worse.
    pub fn missing(&self) -> usize {
        self.unmatched.iter().filter(|cell| cell.side == "a").count()
    }
}

fn finished(catalog: &Catalog, record: &RunRecord) -> Result<Vec<(Place, Outcome)>, RunError> {
    let mut seen: BTreeMap<(TimeSlot, String, String), usize> = BTreeMap::new();
    let mut found = Vec::new();
    for RunCell { key, live, experience, setting } in &record.cells {
        let count = seen.entry((*live, experience.clone(), setting.clone())).or_default();
        *count += 1;
        if let Some(outcome) = catalog.outcome(*key)? {
            found.push(((*live, experience.clone(), setting.clone(), *count), outcome));
        }
    }
    Ok(found)
}

fn compared((live, experience, setting, _): &Place, a: &Outcome, b: &Outcome) -> Compared {
    let (before, after) = (numbers(a), numbers(b));
    let share = |numbers: Numbers| 100.0 * f64::from(numbers.good) / f64::from(numbers.frames.max(1));
    let apart = match (before.good_interval, after.good_interval) {
        (Some([a_low, a_high]), Some([b_low, b_high])) => a_high < b_low || b_high < a_low,
        _ => false,
    };
    Compared {
        live: *live,
        experience: experience.clone(),
        setting: setting.clone(),
        same: a.key == b.key,
        a: before,
        b: after,
        change_points: share(after) - share(before),
        apart,
    }
}

fn numbers(outcome: &Outcome) -> Numbers {
    let evaluation = &outcome.evaluation;
    Numbers {
        frames: evaluation.frames,
        good: evaluation.good,
        good_interval: evaluation.good_interval,
        lost_fraction: evaluation.lost.lost_fraction,
        max_lost_m: evaluation.lost.max_lost_m,
        wrong: evaluation.ground_truth.as_ref().map(|truth| truth.wrong),
    }
}
