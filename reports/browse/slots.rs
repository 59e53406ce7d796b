//! The slots of a site by hour, each with its first traversals.

use super::cards::{Card, card};
use super::error::BrowseError;
use super::places;
use super::store::Store;
use furrow_catalog::Catalog;
use furrow_catalog::index::PlaceRow;
use furrow_model::TimeSlot;
use serde::Serialize;
use std::collections::BTreeSet;

/// Traversals of a slot.
#[derive(Serialize)]
pub(super) struct SlotView {
    slot: String,
    pub cards: Vec<Card>,
    more: u32,
}

/// Views of all slots among the places of one site, with at most `most` cards each.
pub(super) fn slots_of(
    store: &Store,
    catalog: &Catalog,
    site: &str,
    places: &[&PlaceRow],
    most: usize,
) -> Result<Vec<SlotView>, BrowseError> {
    let slots: BTreeSet<TimeSlot> = places.iter().map(|place| place.slot).collect();
    let view = |slot: TimeSlot| -> Result<SlotView, BrowseError> {
        let all = places::traversals(places.iter().copied().filter(|place| place.slot == slot));
        let rows = catalog.traversals_at(site, slot, (0, most as u32))?;
        let cards: Vec<Card> = rows.iter().map(|row| card(store, catalog, row)).collect();
        Ok(SlotView { slot: slot.to_string(), more: all.saturating_sub(cards.len() as u32), cards })
    };
    slots.into_iter().map(view).collect()
}
