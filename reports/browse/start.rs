//! The first page: what there is, what is missing, what was run.

use crate::browse::BrowseError;
use crate::browse::answer::Answer;
use crate::browse::cards::{Card, card, site_key, tones};
use crate::browse::kept::{self, KeptReport};
use crate::browse::run::{RunLine, line};
use crate::browse::store::Store;
use crate::wording;
use furrow_catalog::Catalog;
use furrow_catalog::browsing::SiteCounts;
use furrow_catalog::index::PlaceRow;
use furrow_model::{Purpose, TimeSlot};
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Outings with a picture: so many of a slot, and on the whole page; the others are a click away.
const OF_SLOT: usize = 6;
const IN_ALL: usize = 96;
/// Runs on the page, the latest first.
const RUNS: usize = 8;

#[derive(Serialize)]
struct View {
    sites: Vec<SiteView>,
    runs: Vec<RunLine>,
    more_runs: usize,
    reports: Vec<KeptReport>,
}

#[derive(Serialize)]
struct SiteView {
    name: String,
    key: String,
    outings: String,
    experiences: String,
    nodes: String,
    coverage: Coverage,
    slots: Vec<SlotView>,
}

/// Outings of a slot.
#[derive(Serialize)]
pub(crate) struct SlotView {
    pub slot: String,
    pub cards: Vec<Card>,
    pub more: u32,
}

/// What there is of a site by purpose and slot, and in words what is missing.
#[derive(Serialize)]
pub(crate) struct Coverage {
    slots: Vec<String>,
    rows: Vec<(String, Vec<u32>)>,
    missing: Vec<String>,
}

pub(crate) fn page(store: &Store) -> Result<Answer, BrowseError> {
    let catalog = store.catalog()?;
    let places = catalog.places()?;
    let counts: BTreeMap<String, SiteCounts> =
        catalog.site_counts()?.into_iter().map(|counts| (counts.site.clone(), counts)).collect();
    let slots: BTreeSet<(&str, TimeSlot)> = places.iter().map(|place| (place.site.as_str(), place.slot)).collect();
    let share = (IN_ALL / slots.len().max(1)).clamp(1, OF_SLOT);
    let mut room = IN_ALL;
    let mut sites = Vec::new();
    for name in slots.iter().map(|(site, _)| *site).collect::<BTreeSet<_>>() {
        let own: Vec<&PlaceRow> = places.iter().filter(|place| place.site == name).collect();
        let shown = share.min(room);
        let slots = slots_of(store, &catalog, name, &own, shown)?;
        room -= slots.iter().map(|slot| slot.cards.len()).sum::<usize>().min(room);
        let outings: u32 = own.iter().map(|place| place.outings).sum();
        let of = |count: fn(&SiteCounts) -> u64| counts.get(name).map_or(0, count) as usize;
        let (recorded, generated) = (of(|of| of.recorded.into()), of(|of| of.generated.into()));
        sites.push(SiteView {
            name: wording::shown(name),
            key: site_key(name),
            outings: wording::counted(outings as usize, "outing", "outings"),
            experiences: format!(
                "{} recorded and {} generated experiences",
                wording::count(recorded as u32),
                wording::count(generated as u32)
            ),
            nodes: wording::counted(of(|of| of.nodes), "place", "places"),
            coverage: coverage(&own),
            slots,
        });
    }
    let all = catalog.runs()?;
    let runs = all.iter().rev().take(RUNS).map(|row| line(&catalog, row)).collect::<Result<_, _>>()?;
    let reports = kept::list(&catalog);
    store.render("start.html", View { sites, runs, more_runs: all.len().saturating_sub(RUNS), reports })
}

/// The slots of a site by hour, each with its first outings.
pub(crate) fn slots_of(
    store: &Store,
    catalog: &Catalog,
    site: &str,
    places: &[&PlaceRow],
    most: usize,
) -> Result<Vec<SlotView>, BrowseError> {
    let slots: BTreeSet<TimeSlot> = places.iter().map(|place| place.slot).collect();
    let view = |slot: TimeSlot| -> Result<SlotView, BrowseError> {
        let all: u32 = places.iter().filter(|place| place.slot == slot).map(|place| place.outings).sum();
        let rows = catalog.traversals_at(site, slot, (0, most as u32))?;
        let cards: Vec<Card> = rows.iter().map(|row| card(store, catalog, row)).collect();
        Ok(SlotView { slot: slot.to_string(), more: all.saturating_sub(cards.len() as u32), cards })
    };
    slots.into_iter().map(view).collect()
}

/// What there is of a site by purpose and slot.
pub(crate) fn coverage(places: &[&PlaceRow]) -> Coverage {
    let slots: BTreeSet<TimeSlot> = places.iter().map(|place| place.slot).collect();
    let of = |purpose: Purpose, slot: TimeSlot| {
        places.iter().filter(|place| (place.purpose, place.slot) == (purpose, slot)).map(|place| place.outings).sum()
    };
    let row = |purpose: Purpose| (purpose.to_string(), slots.iter().map(|slot| of(purpose, *slot)).collect());
    let rows: Vec<(String, Vec<u32>)> = Purpose::ALL.into_iter().map(row).collect();
    let mut missing = Vec::new();
    for purpose in [Purpose::Experience, Purpose::Evaluation] {
        // A slot that only serves a vocabulary asks for nothing more.
        let other = if purpose == Purpose::Experience { Purpose::Evaluation } else { Purpose::Experience };
        let lacking = slots.iter().filter(|slot| of(purpose, **slot) == 0 && of(other, **slot) > 0);
        let lacking: Vec<String> = lacking.map(TimeSlot::to_string).collect();
        if !lacking.is_empty() {
            missing.push(format!("no {purpose} pass at {}", lacking.join(", ")));
        }
    }
    if rows.last().is_some_and(|(_, counts)| counts.iter().all(|count| *count == 0)) {
        missing.push("no vocabulary pass".to_owned());
    }
    Coverage { slots: slots.iter().map(TimeSlot::to_string).collect(), rows, missing }
}

/// The style sheet.
pub(crate) fn style(store: &Store) -> Result<Answer, BrowseError> {
    store.style(tones(&store.catalog()?.places()?).all())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coverage_is_by_hour_and_says_what_is_missing() {
        let place = |slot: &str, purpose, outings| PlaceRow {
            site: "zoo".to_owned(),
            slot: slot.parse().unwrap(),
            purpose,
            outings,
        };
        let places = [
            place("16:00", Purpose::Experience, 1),
            place("08:00", Purpose::Evaluation, 3),
            place("10:00", Purpose::Experience, 2),
            place("10:00", Purpose::Evaluation, 1),
        ];
        let found = coverage(&places.iter().collect::<Vec<_>>());
        assert_eq!(found.slots, ["08:00", "10:00", "16:00"]);
        let counts: Vec<&[u32]> = found.rows.iter().map(|(_, counts)| counts.as_slice()).collect();
        assert_eq!(counts, [[0, 2, 1], [3, 1, 0], [0, 0, 0]]);
        let expected = ["no experience pass at 08:00", "no evaluation pass at 16:00", "no vocabulary pass"];
        assert_eq!(found.missing, expected);
    }
}
