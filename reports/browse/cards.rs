//! Traversals as cards: a few words and an image.

use super::error::BrowseError;
use super::store::Store;
use crate::wording;
use furrow_catalog::Catalog;
use furrow_catalog::index::TraversalRow;
use serde::Serialize;

/// A traversal on a page.
#[derive(Serialize)]
pub(super) struct Card {
    pub id: String,
    short: String,
    purpose: String,
    route: String,
    slot: String,
    day: String,
    frames: String,
    length: String,
    /// What is wrong with it, at a glance.
    faults: Vec<String>,
    /// Why it cannot be read.
    trouble: Option<String>,
}

/// The traversal of a row. Damage is named on its card; the other cards are not affected.
pub(super) fn card(store: &Store, catalog: &Catalog, row: &TraversalRow) -> Card {
    let blank = Card {
        id: row.id.to_string(),
        short: row.id.short(),
        purpose: row.purpose.to_string(),
        route: wording::shown(&row.route),
        slot: row.slot.to_string(),
        day: "–".to_owned(),
        frames: "–".to_owned(),
        length: "–".to_owned(),
        faults: Vec::new(),
        trouble: None,
    };
    let read = || -> Result<_, BrowseError> {
        let record = catalog.traversal(row.id)?;
        let first = store.frames(&record)?.first().map(|frame| frame.stamp_ns);
        let day = first.map_or(Ok("–".to_owned()), |stamp| store.insight.day(catalog, &record, stamp))?;
        Ok((record, day))
    };
    match read() {
        Err(error) => Card { trouble: Some(wording::shown(&error.to_string())), ..blank },
        Ok((record, day)) => {
            let counts = record.counts;
            let faults = [
                (counts.failed_steps, "step failed", "steps failed"),
                (counts.dropped, "frame dropped", "frames dropped"),
            ];
            let faults = faults.into_iter().filter(|(count, ..)| *count > 0);
            Card {
                day,
                frames: wording::count(counts.frames),
                length: wording::tenths(counts.length_m),
                faults: faults.map(|(count, one, many)| wording::counted(count as usize, one, many)).collect(),
                ..blank
            }
        }
    }
}
