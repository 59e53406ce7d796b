//! A run again from nothing but the recordings' bytes: every traversal ingested, every generator trained and every cell
//! computed in a fresh store, and what comes of it compared with what the first store holds.

mod again;
mod difference;

pub use difference::Difference;

use crate::RunError;
use crate::progress::{Progress, Stage, StageProgress};
use crate::stages::conduct::Conduct;
use crate::stages::matching::read_matrix;
use crate::study::{Study, run, study};
use again::{ingest_again, train_again};
use difference::difference;
use furrow_catalog::Catalog;
use furrow_catalog::records::{RunCell, RunRecord, record_id};
use furrow_model::{Outcome, RunId, TraversalId};
use serde::Serialize;
use std::path::Path;

/// What came of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Reproduction {
    /// The run.
    pub run: RunId,
    /// Traversals that were ingested again with the same id.
    #[serde(rename = "passes")]
    pub traversals: usize,
    /// Generators that were trained again with the same id, or brought along where another program made them.
    pub generators: usize,
    /// Cells whose outcomes have the same id.
    pub cells: usize,
    /// Cells that the first store has no outcome of: nothing to compare with.
    pub unfinished: usize,
    /// The first thing that came out otherwise; none where all is the same.
    pub difference: Option<Difference>,
}

/// Computes a run of `first` in `fresh`, an empty store; recordings are laid out in `folder` on the way.
///
/// # Errors
/// Where a recording cannot be ingested any more or the run cannot be computed at all. What merely differs is a
/// [`Difference`].
pub fn reproduce(
    first: &Catalog,
    id: RunId,
    fresh: &Catalog,
    folder: &Path,
    progress: Progress<'_>,
) -> Result<Reproduction, RunError> {
    let record = first.run(id)?;
    let mut done = Reproduction { run: id, traversals: 0, generators: 0, cells: 0, unfinished: 0, difference: None };
    let traversals = traversals_of(first, &record)?;
    for (i, traversal) in traversals.iter().enumerate() {
        let report = |done: usize| {
            progress(StageProgress::whole(Stage::Reingestion, done as u64, traversals.len() as u64));
        };
        report(i);
        done.difference = ingest_again(first, *traversal, fresh, &folder.join(i.to_string()))?;
        if done.difference.is_some() {
            return Ok(done);
        }
        done.traversals += 1;
        report(i + 1);
    }
    for generator in &record.generators {
        done.difference = train_again(first, *generator, fresh, progress)?;
        if done.difference.is_some() {
            return Ok(done);
        }
        done.generators += 1;
    }
    let matrix = read_matrix(Path::new("matrix.toml"), &record.source)?;
    let study = study(fresh, matrix, &record.source)?;
    done.difference = record.cells.iter().find_map(|cell| other_inputs(&study, cell));
    if done.difference.is_some() {
        return Ok(done);
    }
    run(fresh, &study, Conduct::default(), progress)?;
    for cell in &record.cells {
        match compared(first, fresh, cell)? {
            None => done.unfinished += 1,
            Some(Ok(())) => done.cells += 1,
            Some(Err(difference)) => {
                done.difference = Some(difference);
                return Ok(done);
            }
        }
    }
    Ok(done)
}

/// The traversals of a run; of one that an old version entered, all of its site.
fn traversals_of(first: &Catalog, record: &RunRecord) -> Result<Vec<TraversalId>, RunError> {
    if !record.traversals.is_empty() {
        return Ok(record.traversals.clone());
    }
    Ok(first.traversals()?.into_iter().filter(|row| row.site == record.site).map(|row| row.id).collect())
}

fn named(cell: &RunCell) -> String {
    let setting = if cell.setting.is_empty() { String::new() } else { format!(" [{}]", cell.setting) };
    format!("cell live {} against {}{setting}", cell.live, cell.experience)
}

/// Why a cell of the run is no cell of the fresh plan, where it is none.
fn other_inputs(study: &Study, cell: &RunCell) -> Option<Difference> {
    if study.cells().any(|(_, planned)| planned.key == cell.key) {
        return None;
    }
    let alike = study.cells().find(|(part, planned)| {
        part.setting == cell.setting
            && planned.label == cell.experience
            && part.live(planned.live).record.slot == cell.live
    });
    let blocked = (study.parts.iter().flat_map(|part| &part.blocked))
        .find(|blocked| blocked.live == cell.live && blocked.experience == cell.experience);
    let found = match (alike, blocked) {
        (Some((_, planned)), _) => format!("{}: other inputs, parameters or algorithms", planned.key),
        (None, Some(blocked)) => format!("blocked: {}", blocked.reason),
        (None, None) => "no such cell".to_owned(),
    };
    Some(Difference { subject: named(cell), place: "key".to_owned(), expected: cell.key.to_string(), found })
}

/// Whether both stores' outcomes of a cell have the same id; `None` where the first has none.
fn compared(first: &Catalog, fresh: &Catalog, cell: &RunCell) -> Result<Option<Result<(), Difference>>, RunError> {
    let by_name = |outcome: Outcome| outcome.named(&cell.experience);
    let Some(expected) = first.outcome(cell.key)?.map(by_name) else { return Ok(None) };
    let Some(found) = fresh.outcome(cell.key)?.map(by_name) else {
        let (place, expected) = ("outcome".to_owned(), record_id(&expected)?.to_string());
        return Ok(Some(Err(Difference { subject: named(cell), place, expected, found: "none".to_owned() })));
    };
    Ok(Some(difference(named(cell), &expected, &found)?.map_or(Ok(()), Err)))
}
