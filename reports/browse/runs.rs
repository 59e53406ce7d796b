//! Runs in lists.

use super::error::BrowseError;
use super::reply::Reply;
use super::store::Store;
use crate::wording;
use furrow_catalog::Catalog;
use furrow_catalog::index::RunRow;
use furrow_model::CellKey;
use serde::Serialize;
use std::collections::BTreeSet;

/// A run in a list.
#[derive(Serialize)]
pub(super) struct RunLine {
    id: String,
    short: String,
    name: String,
    site: String,
    cells: usize,
    finished: usize,
    blocked: usize,
    /// Why it cannot be read.
    trouble: Option<String>,
}

/// A run from its row and record; damage is named on its line.
pub(super) fn line(catalog: &Catalog, row: &RunRow) -> Result<RunLine, BrowseError> {
    let blank = RunLine {
        id: row.id.to_string(),
        short: row.id.short(),
        name: wording::shown(&row.matrix),
        site: String::new(),
        cells: 0,
        finished: 0,
        blocked: 0,
        trouble: None,
    };
    match catalog.run(row.id) {
        Err(error) => Ok(RunLine { trouble: Some(wording::shown(&error.to_string())), ..blank }),
        Ok(run) => {
            // Two names may share a cell.
            let keys: BTreeSet<CellKey> = run.cells.iter().map(|cell| cell.key).collect();
            let finished = catalog.finished(&keys.iter().copied().collect::<Vec<_>>())?;
            let done = run.cells.iter().filter(|cell| finished.contains(&cell.key)).count();
            let (site, cells, blocked) = (wording::shown(&run.site), run.cells.len(), run.blocked.len());
            Ok(RunLine { site, cells, finished: done, blocked, ..blank })
        }
    }
}

#[derive(Serialize)]
struct All {
    runs: Vec<RunLine>,
}

/// All runs, the latest first.
pub(super) fn page(store: &Store) -> Result<Reply, BrowseError> {
    let catalog = store.catalog()?;
    let runs = catalog.runs()?.iter().rev().map(|row| line(&catalog, row)).collect::<Result<_, _>>()?;
    store.render("all_runs.html", All { runs })
}
