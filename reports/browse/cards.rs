//! Outings in a word and a picture.

use crate::browse::BrowseError;
use crate::browse::store::Store;
use crate::palette::Tones;
use crate::wording;
use furrow_catalog::Catalog;
use furrow_catalog::index::{PlaceRow, TraversalRow};
use serde::Serialize;

/// An outing on a page.
#[derive(Serialize)]
pub(crate) struct Card {
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
    /// Why nothing can be told of it.
    trouble: Option<String>,
}

/// The outing of a row. What is damaged is told on its card: the others are there all the same.
pub(crate) fn card(store: &Store, catalog: &Catalog, row: &TraversalRow) -> Card {
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
        Ok((record, first))
    };
    match read() {
        Err(error) => Card { trouble: Some(wording::shown(&error.to_string())), ..blank },
        Ok((record, first)) => {
            let counts = record.counts;
            let faults = [
                (counts.failed_steps, "step failed", "steps failed"),
                (counts.dropped, "frame dropped", "frames dropped"),
            ];
            let faults = faults.into_iter().filter(|(count, ..)| *count > 0);
            Card {
                day: first.map_or("–".to_owned(), |stamp| store.insight.day(stamp, row.slot)),
                frames: wording::count(counts.frames),
                length: wording::tenths(counts.length_m),
                faults: faults.map(|(count, one, many)| wording::counted(count as usize, one, many)).collect(),
                ..blank
            }
        }
    }
}

/// The colour and dash of every slot in the store, the same on each page.
pub(crate) fn tones(places: &[PlaceRow]) -> Tones {
    Tones::new(places.iter().map(|place| place.slot).collect())
}

/// How a site is called in addresses: names may hold anything.
pub(crate) fn site_key(site: &str) -> String {
    furrow_catalog::digest(site.as_bytes()).short()
}

/// The site of a key among all places.
pub(crate) fn site_of(places: &[PlaceRow], key: &str) -> Result<String, BrowseError> {
    let found = places.iter().find(|place| site_key(&place.site) == key);
    found.map(|place| place.site.clone()).ok_or_else(|| BrowseError::not_here("site", key))
}
