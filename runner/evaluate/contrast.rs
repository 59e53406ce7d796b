//! The story of contrasts: the events of two cells of one live traversal, frame by frame, become differences with
//! intervals. Only the tables of events are read, so that any other program can count it again.

use crate::RunError;
use crate::evaluate::Rules;
use crate::evaluate::holm;
use crate::evaluate::paired::{Compared, Course, differences};
use furrow_catalog::records::{ContrastPair, RunContrasts};
use furrow_catalog::{CatalogError, Objects, tables};
use furrow_model::outcome::event;
use furrow_model::{CellKey, Contrast, ContrastTraversal, Difference, Outcome};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// What contrasts came to.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Contrasts {
    /// In the matrix' order: each live traversal, then all of them pooled where there are several.
    pub found: Vec<Contrast>,
    /// Those that could not be made.
    pub missing: Vec<MissingContrast>,
}

/// A contrast that could not be made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MissingContrast {
    /// What was asked.
    pub pair: ContrastPair,
    /// What tells its setting from the matrix' others.
    pub setting: String,
    /// Why there is none.
    pub reason: String,
}

/// The contrasts of a run from its finished cells.
///
/// # Errors
/// Where a table of events cannot be read, or is not its outcome's.
pub fn contrasts<'a>(
    objects: &Objects,
    asked: impl IntoIterator<Item = &'a RunContrasts>,
    outcomes: &[&Outcome],
) -> Result<Contrasts, RunError> {
    let finished: BTreeMap<CellKey, &Outcome> = outcomes.iter().map(|outcome| (outcome.key, *outcome)).collect();
    let mut courses: BTreeMap<CellKey, (Vec<f64>, Course)> = BTreeMap::new();
    let mut all = Contrasts::default();
    let mut headlines = Vec::new();
    for (asked, pair) in asked.into_iter().flat_map(|asked| asked.pairs.iter().map(move |pair| (asked, pair))) {
        let rules = Rules { censored: asked.censored };
        let both = |[of, over]: &[CellKey; 2]| Some((*finished.get(of)?, *finished.get(over)?));
        let shared: Vec<Cells<'_>> = pair.cells.iter().filter_map(both).collect();
        if shared.is_empty() {
            let reason = "no live traversal was finished against both: see the blocked cells".to_owned();
            all.missing.push(MissingContrast { pair: pair.clone(), setting: asked.setting.clone(), reason });
            continue;
        }
        let mut compared = Vec::new();
        for (of, over) in &shared {
            for outcome in [of, over] {
                if let Entry::Vacant(unread) = courses.entry(outcome.key) {
                    unread.insert(course(objects, outcome)?);
                }
            }
            let (travelled_m, of) = courses[&of.key].clone();
            compared.push(Compared { travelled_m, of, over: courses[&over.key].1.clone() });
        }
        for (cells, compared) in shared.chunks(1).zip(compared.chunks(1)) {
            headlines.push(shared.len() == 1);
            all.found.push(contrast((asked, pair), cells, compared, rules));
        }
        if shared.len() > 1 {
            headlines.push(true);
            all.found.push(contrast((asked, pair), &shared, &compared, rules));
        }
    }
    correct(&mut all.found, &headlines);
    Ok(all)
}

/// Corrects for the number of contrasts asked, each measure by itself. What is asked is answered over all traversals;
/// the rows of single traversals beside that are a family of their own.
fn correct(found: &mut [Contrast], headlines: &[bool]) {
    type Measure = fn(&mut Contrast) -> Option<&mut Difference>;
    let measures: [Measure; 4] = [
        |contrast| Some(&mut contrast.good),
        |contrast| contrast.right.as_mut(),
        |contrast| Some(&mut contrast.lost_fraction),
        |contrast| Some(&mut contrast.area_m),
    ];
    for (measure, wanted) in measures.iter().flat_map(|measure| [(measure, true), (measure, false)]) {
        let family = found.iter_mut().zip(headlines).filter(|(_, headline)| **headline == wanted);
        let judged = family.filter_map(|(contrast, _)| measure(contrast)).filter(|difference| difference.p.is_some());
        let mut judged: Vec<&mut Difference> = judged.collect();
        let p: Vec<f64> = judged.iter().filter_map(|difference| difference.p).collect();
        for (difference, p) in judged.iter_mut().zip(holm::adjusted(&p)) {
            difference.p_holm = Some(p);
        }
    }
}

/// Two cells of one live traversal.
type Cells<'a> = (&'a Outcome, &'a Outcome);

fn contrast(
    (asked, pair): (&RunContrasts, &ContrastPair),
    cells: &[Cells<'_>],
    compared: &[Compared],
    rules: Rules,
) -> Contrast {
    let found = differences(compared, rules);
    let live = |(of, over): &Cells<'_>| ContrastTraversal {
        slot: of.live,
        traversal: of.live_traversal,
        cells: [of.key, over.key],
    };
    let source = |(of, _): &Cells<'_>| of.evaluation.ground_truth.as_ref().map(|truth| truth.source.clone());
    Contrast {
        of: pair.of.clone(),
        over: pair.over.clone(),
        setting: asked.setting.clone(),
        live: cells.iter().map(live).collect(),
        frames: compared.iter().map(|traversal| traversal.travelled_m.len() as u32).sum(),
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
        return Err(RunError::Contrast(format!(
            "cell {}: its table of events has {frames} frames and {counted} good localisations, its outcome {} and {}: run the matrix again",
            outcome.key.short(),
            evaluation.frames,
            evaluation.good
        )));
    }
    let right = evaluation.ground_truth.as_ref().map(|_| right);
    Ok((travelled_m, Course { good, right }))
}
