//! The story of contrasts: the events of two cells of one live pass, frame by frame, become differences with intervals. Only the tables of events
//! are read, so that any other program can count it again.

use crate::RunError;
use crate::evaluate::Rules;
use crate::evaluate::paired::{Course, Drive, differences};
use furrow_catalog::records::{ContrastPair, RunContrasts};
use furrow_catalog::{CatalogError, Objects, tables};
use furrow_model::outcome::event;
use furrow_model::{Contrast, ContrastPass, Outcome};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// What contrasts came to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contrasts {
    /// In the matrix' order: each live pass, then all of them pooled where there are several.
    pub found: Vec<Contrast>,
    /// Those that could not be made, with the reason.
    pub missing: Vec<(ContrastPair, String)>,
}

/// The contrasts of a run from its finished cells.
///
/// # Errors
/// Where a table of events cannot be read, or is not its outcome's.
pub fn contrasts(objects: &Objects, asked: &RunContrasts, outcomes: &[&Outcome]) -> Result<Contrasts, RunError> {
    let rules = Rules { censored: asked.censored, seed: asked.seed };
    let mut courses: BTreeMap<_, (Vec<f64>, Course)> = BTreeMap::new();
    let mut all = Contrasts::default();
    for pair in &asked.pairs {
        let shared = shared(pair, outcomes);
        if shared.is_empty() {
            let reason = "no live pass was finished against both: see the blocked cells".to_owned();
            all.missing.push((pair.clone(), reason));
            continue;
        }
        let mut drives = Vec::new();
        for (of, over) in &shared {
            for outcome in [of, over] {
                if let Entry::Vacant(unread) = courses.entry(outcome.key) {
                    unread.insert(course(objects, outcome)?);
                }
            }
            let (travelled_m, of) = courses[&of.key].clone();
            drives.push(Drive { travelled_m, of, over: courses[&over.key].1.clone() });
        }
        for (passes, drives) in shared.chunks(1).zip(drives.chunks(1)) {
            all.found.push(contrast(pair, passes, drives, rules));
        }
        if shared.len() > 1 {
            all.found.push(contrast(pair, &shared, &drives, rules));
        }
    }
    Ok(all)
}

/// Two cells of one live pass.
type Cells<'a> = (&'a Outcome, &'a Outcome);

/// The cells of a pair, by live pass in the order of the run.
fn shared<'a>(pair: &ContrastPair, outcomes: &[&'a Outcome]) -> Vec<Cells<'a>> {
    let over = |of: &Outcome| {
        let same = |other: &&&Outcome| other.experience == pair.over && other.live_traversal == of.live_traversal;
        outcomes.iter().find(same).copied()
    };
    let of = outcomes.iter().copied().filter(|outcome| outcome.experience == pair.of);
    of.filter_map(|of| Some((of, over(of)?))).collect()
}

fn contrast(pair: &ContrastPair, cells: &[Cells<'_>], drives: &[Drive], rules: Rules) -> Contrast {
    let found = differences(drives, rules);
    let live = |(of, _): &Cells<'_>| ContrastPass { slot: of.live, traversal: of.live_traversal };
    let source = |(of, _): &Cells<'_>| of.evaluation.ground_truth.as_ref().map(|truth| truth.source.clone());
    Contrast {
        of: pair.of.clone(),
        over: pair.over.clone(),
        live: cells.iter().map(live).collect(),
        frames: drives.iter().map(|drive| drive.travelled_m.len() as u32).sum(),
        truth: found.right.and_then(|_| cells.iter().find_map(source)),
        good: found.good,
        right: found.right,
        lost_fraction: found.lost_fraction,
        area_m: found.area_m,
    }
}

/// Distances and fates of the live frames of a cell, from its table of events: a frame's rows stand together.
fn course(objects: &Objects, outcome: &Outcome) -> Result<(Vec<f64>, Course), RunError> {
    let table = tables::from_parquet("events", objects.read(outcome.events)?)?;
    let stamps = tables::i64s(&table, event::LIVE_STAMP_NS)?;
    let read = |name: &'static str| table.column(name).map_err(CatalogError::table(name));
    let travelled = read(event::TRAVELLED_M)?.f64().map_err(CatalogError::table(event::TRAVELLED_M))?;
    let decision = read(event::DECISION)?.str().map_err(CatalogError::table(event::DECISION))?;
    let correct = read(event::CORRECT)?.bool().map_err(CatalogError::table(event::CORRECT))?;
    let (mut travelled_m, mut good, mut right) = (Vec::new(), Vec::new(), Vec::new());
    let mut last = None;
    for (row, stamp_ns) in stamps.iter().enumerate() {
        if last.replace(*stamp_ns) != Some(*stamp_ns) {
            travelled_m.push(travelled.get(row).unwrap_or_default());
            good.push(false);
            right.push(false);
        }
        if decision.get(row) == Some(event::ACCEPTED)
            && let (Some(good), Some(right)) = (good.last_mut(), right.last_mut())
        {
            (*good, *right) = (true, correct.get(row) == Some(true));
        }
    }
    let (frames, counted) = (good.len(), good.iter().filter(|good| **good).count());
    let evaluation = &outcome.evaluation;
    if (frames, counted) != (evaluation.frames as usize, evaluation.good as usize) {
        return Err(RunError::Plan(format!(
            "cell {}: its table of events has {frames} frames and {counted} good localisations, its outcome {} and {}: run the matrix again",
            outcome.key.short(),
            evaluation.frames,
            evaluation.good
        )));
    }
    let right = evaluation.ground_truth.as_ref().map(|_| right);
    Ok((travelled_m, Course { good, right }))
}
