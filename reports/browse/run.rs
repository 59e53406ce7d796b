//! A run: its cells, contrasts and report.

use super::error::BrowseError;
use super::places::site_key;
use super::reply::Reply;
use super::store::Store;
use crate::page::contrasts::{self, ContrastTable};
use crate::wording;
use furrow_catalog::Catalog;
use furrow_catalog::records::RunCell;
use furrow_model::{CellKey, Outcome, RunId};
use serde::Serialize;
use std::collections::BTreeMap;

/// Cells on a page; a report has all.
const CELLS: usize = 400;

#[derive(Serialize)]
struct View {
    id: String,
    short: String,
    name: String,
    site: String,
    site_key: String,
    source: String,
    finished: usize,
    all: usize,
    cells: Vec<CellLine>,
    left_out: usize,
    settings: bool,
    truth: bool,
    blocked: Vec<(String, String)>,
    contrasts: Option<ContrastTable>,
    trouble: Option<String>,
    traversals: Vec<(String, String)>,
}

#[derive(Serialize)]
struct CellLine {
    live: String,
    experience: String,
    setting: String,
    state: String,
    /// The live traversal and the cell, for the player.
    watch: Option<(String, String)>,
    numbers: Option<Numbers>,
}

/// As the report has them; – for what does not exist.
#[derive(Serialize)]
struct Numbers {
    frames: String,
    good: String,
    percent: String,
    lost: String,
    right: String,
    wrong: String,
}

pub(super) fn page(store: &Store, typed: String) -> Result<Reply, BrowseError> {
    let catalog = store.catalog()?;
    let id = run_id(&catalog, &typed)?;
    let run = catalog.run(id)?;
    let failures: BTreeMap<CellKey, String> =
        catalog.failures()?.into_iter().map(|failure| (failure.cell, failure.reason)).collect();
    let mut outcomes: BTreeMap<CellKey, Outcome> = BTreeMap::new();
    let mut damaged: BTreeMap<CellKey, String> = BTreeMap::new();
    for cell in run.cells.iter().take(CELLS) {
        match catalog.outcome(cell.key) {
            Ok(Some(outcome)) => drop(outcomes.insert(cell.key, outcome)),
            Ok(None) => {}
            Err(error) => drop(damaged.insert(cell.key, error.to_string())),
        }
    }
    let keys: Vec<CellKey> = run.cells.iter().map(|cell| cell.key).collect();
    let done = catalog.finished(&keys)?;
    let made = store.insight.contrasts(store.objects(), &run, &outcomes.values().collect::<Vec<_>>());
    let (contrasts, trouble) = match made {
        Ok(made) => (contrasts::table(&made), None),
        Err(error) => (None, Some(wording::shown(&error.to_string()))),
    };
    let line = |cell: &RunCell| {
        let state = damaged.get(&cell.key).or_else(|| failures.get(&cell.key)).map(|reason| wording::shown(reason));
        cell_line(cell, outcomes.get(&cell.key), state)
    };
    let label =
        |live: &dyn std::fmt::Display, experience: &str| format!("live {live} against {}", wording::shown(experience));
    let view = View {
        id: id.to_string(),
        short: id.short(),
        name: wording::shown(&run.name),
        site: wording::shown(&run.site),
        site_key: site_key(&run.site),
        source: wording::shown_lines(&run.source),
        finished: keys.iter().filter(|key| done.contains(key)).count(),
        all: run.cells.len(),
        cells: run.cells.iter().take(CELLS).map(line).collect(),
        left_out: run.cells.len().saturating_sub(CELLS),
        settings: run.cells.iter().any(|cell| !cell.setting.is_empty()),
        truth: outcomes.values().any(|outcome| outcome.evaluation.ground_truth.is_some()),
        blocked: run.blocked.iter().map(|b| (label(&b.live, &b.experience), wording::shown(&b.reason))).collect(),
        contrasts,
        trouble,
        traversals: run.traversals.iter().map(|id| (id.to_string(), id.short())).collect(),
    };
    store.render("run.html", view)
}

fn run_id(catalog: &Catalog, typed: &str) -> Result<RunId, BrowseError> {
    let unknown = || BrowseError::not_here("run", typed);
    let id: RunId = typed.parse().map_err(|_| unknown())?;
    catalog.run_row(id)?.map(|row| row.id).ok_or_else(unknown)
}

fn cell_line(cell: &RunCell, outcome: Option<&Outcome>, trouble: Option<String>) -> CellLine {
    let numbers = outcome.map(|outcome| {
        let (e, truth) = (&outcome.evaluation, outcome.evaluation.ground_truth.as_ref());
        let count = |value: Option<u32>| value.map_or("–".to_owned(), wording::count);
        Numbers {
            frames: wording::count(e.frames),
            good: wording::count(e.good),
            percent: wording::tenths(e.percent_good),
            lost: wording::percent(e.lost.lost_fraction),
            right: count(truth.map(|truth| truth.correct)),
            wrong: count(truth.map(|truth| truth.wrong)),
        }
    });
    let state = match (&numbers, trouble) {
        (Some(_), _) => "finished".to_owned(),
        (None, Some(reason)) => format!("failed: {reason}"),
        (None, None) => "not finished: run the matrix again".to_owned(),
    };
    CellLine {
        live: cell.live.to_string(),
        experience: wording::shown(&cell.experience),
        setting: wording::shown(&cell.setting),
        state,
        watch: outcome.map(|outcome| (outcome.live_traversal.to_string(), cell.key.to_string())),
        numbers,
    }
}

/// The run's report, made now.
pub(super) fn report(store: &Store, typed: String) -> Result<Reply, BrowseError> {
    let catalog = store.catalog()?;
    let id = run_id(&catalog, &typed)?;
    Ok(Reply::report(store.insight.report(&catalog, id)?))
}
