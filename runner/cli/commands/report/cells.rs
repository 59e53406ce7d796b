//! The cells of a report, their codebooks, and odometry beside the ground truth.

use crate::ending::Failure;
use furrow_catalog::records::{self, CodebookRecord, RunRecord};
use furrow_catalog::{Catalog, tables};
use furrow_model::{CellKey, CodebookId, ObjectId, TraversalId};
use furrow_reports::{CellInput, MissingCell, TrackInput, Training};
use furrow_runner::evaluate::tracks::laid_over_truth;
use std::collections::{BTreeMap, BTreeSet};

/// The most tracks beside their ground truth.
const TRACKS_IN_ALL: usize = 14;
/// The most timings of trainings that are read.
const TIMINGS: u32 = 10_000;

/// The finished cells, still without pictures, and those that are missing.
pub fn read_cells(catalog: &Catalog, record: &RunRecord) -> Result<(Vec<CellInput>, Vec<MissingCell>), Failure> {
    let (mut cells, mut missing) = (Vec::new(), Vec::new());
    let mut names: BTreeMap<CellKey, &str> = BTreeMap::new();
    for cell in &record.cells {
        let label = || format!("live {} against {}", cell.live, cell.experience);
        if let Some(name) = names.get(&cell.key) {
            // Said once for several live traversals of one slot.
            let twin = MissingCell {
                label: label(),
                reason: format!("it has the members of {name} and answers alike: shown under that name"),
            };
            if !missing.contains(&twin) {
                missing.push(twin);
            }
            continue;
        }
        names.insert(cell.key, &cell.experience);
        match catalog.outcome(cell.key)? {
            Some(outcome) => {
                let outcome = outcome.named(&cell.experience);
                let events = tables::from_parquet("events", catalog.objects().read(outcome.events)?)?;
                cells.push(CellInput { outcome, events, tiles: Vec::new() });
            }
            None => {
                missing.push(MissingCell { label: label(), reason: "not finished: run the matrix again".to_owned() })
            }
        }
    }
    missing.extend(record.blocked.iter().map(|blocked| MissingCell {
        label: format!("live {} against {}", blocked.live, blocked.experience),
        reason: blocked.reason.clone(),
    }));
    Ok((cells, missing))
}

/// The codebooks of the cells, with the time of their training if it was in this store.
pub fn read_trainings(catalog: &Catalog, cells: &[CellInput]) -> Result<Vec<Training>, Failure> {
    let timings = catalog.timings("codebook", TIMINGS)?;
    let codebooks: BTreeSet<_> = cells.iter().filter_map(|cell| cell.outcome.codebook).collect();
    let training = |id: &CodebookId| {
        let record: CodebookRecord = records::read(catalog.objects(), ObjectId(id.0))?;
        let mut own =
            timings.iter().filter(|timing| timing.subject == id.to_string()).map(|timing| timing.seconds).peekable();
        Ok(Training {
            codebook: id.short(),
            trainer: record.trainer,
            images: u32::try_from(record.images.len()).unwrap_or(u32::MAX),
            words: record.words,
            seconds: own.peek().is_some().then(|| own.sum()),
        })
    };
    codebooks.iter().map(training).collect()
}

/// Odometry's track of each live traversal that has a ground truth.
pub fn read_tracks(catalog: &Catalog, cells: &[CellInput]) -> Result<Vec<TrackInput>, Failure> {
    let mut traversals: Vec<TraversalId> = Vec::new();
    for cell in cells {
        if !traversals.contains(&cell.outcome.live_traversal) {
            traversals.push(cell.outcome.live_traversal);
        }
    }
    let mut tracks = Vec::new();
    for id in traversals.into_iter().take(TRACKS_IN_ALL) {
        let record = catalog.traversal(id)?;
        if let Some(track) = laid_over_truth(catalog.objects(), &record)? {
            tracks.push(TrackInput {
                name: format!("Live {}, traversal {}", record.slot, id.short()),
                source: track.source,
                truth_m: track.truth_m,
                odometry_m: track.chain_m,
                rms_m: track.rms_m,
                length_m: track.length_m,
            });
        }
    }
    Ok(tracks)
}
