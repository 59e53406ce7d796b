//! The first page: what there is, what is missing, what was run.

use super::coverage::Coverage;
use super::error::BrowseError;
use super::kept::{self, KeptReport};
use super::places::{self, site_key, tones};
use super::reply::Reply;
use super::runs::{RunLine, line};
use super::slots::{SlotView, slots_of};
use super::store::Store;
use crate::wording::{self, counted};
use furrow_catalog::index::PlaceRow;
use furrow_catalog::store::experiences::SiteCounts;
use furrow_model::TimeSlot;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// Traversals with an image: so many of a slot, and on the whole page; the others are a click away.
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
    traversals: String,
    experiences: String,
    nodes: String,
    coverage: Coverage,
    slots: Vec<SlotView>,
}

pub(super) fn page(store: &Store) -> Result<Reply, BrowseError> {
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
        let (recorded, generated, nodes) =
            counts.get(name).map_or((0, 0, 0), |counts| (counts.recorded, counts.generated, counts.nodes as usize));
        sites.push(SiteView {
            name: wording::shown(name),
            key: site_key(name),
            traversals: counted(places::traversals(own.iter().copied()) as usize, "traversal", "traversals"),
            experiences: format!(
                "{} recorded and {} generated experiences",
                wording::count(recorded),
                wording::count(generated)
            ),
            nodes: counted(nodes, "node", "nodes"),
            coverage: Coverage::of(&own),
            slots,
        });
    }
    let all = catalog.runs()?;
    let runs = all.iter().rev().take(RUNS).map(|row| line(&catalog, row)).collect::<Result<_, _>>()?;
    let reports = kept::list(&catalog);
    store.render("start.html", View { sites, runs, more_runs: all.len().saturating_sub(RUNS), reports })
}

/// The style sheet.
pub(super) fn style(store: &Store) -> Result<Reply, BrowseError> {
    store.style(tones(&store.catalog()?.places()?).all())
}
