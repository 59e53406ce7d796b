//! The places of a catalogue (site, slot, purpose) as pages name and colour them.

use super::error::BrowseError;
use crate::chart::palette::Tones;
use furrow_catalog::index::PlaceRow;

/// The colour and dash of every slot in the store, the same on each page.
pub(super) fn tones(places: &[PlaceRow]) -> Tones {
    Tones::new(places.iter().map(|place| place.slot).collect())
}

/// How a site is called in addresses: names may hold anything.
pub(super) fn site_key(site: &str) -> String {
    furrow_catalog::digest(site.as_bytes()).short()
}

/// The site of a key among all places.
pub(super) fn site_of(places: &[PlaceRow], key: &str) -> Result<String, BrowseError> {
    let found = places.iter().find(|place| site_key(&place.site) == key);
    found.map(|place| place.site.clone()).ok_or_else(|| BrowseError::not_here("site", key))
}

/// How many traversals some places have.
pub(super) fn traversals<'p>(places: impl Iterator<Item = &'p PlaceRow>) -> u32 {
    places.map(|place| place.traversals).sum()
}
