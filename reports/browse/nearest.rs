//! A family node by node: what was recorded nearest to each node at the hours that the children mimic.

use super::error::BrowseError;
use super::family::Family;
use super::reply::Reply;
use super::store::Store;
use super::track::Track;
use furrow_catalog::Catalog;
use furrow_catalog::tables::Frame;
use furrow_model::{Experience, ExperienceId, Purpose, TimeSlot};
use serde_json::json;
use std::collections::{BTreeMap, BTreeSet};

/// Traversals of an hour that are searched for one on the same route.
const SEARCHED: u32 = 60;
/// A recorded node this far away is not at the same place.
const NEAR_M: f64 = 5.0;

/// The parent's nodes, the children as they can be looked at, and the nearest recorded nodes.
pub(super) fn family(store: &Store, typed: String) -> Result<Reply, BrowseError> {
    let catalog = store.catalog()?;
    let (id, _) = store.experience(&typed)?;
    let family = Family::of(store, &catalog, id)?;
    let (_, parent) = store.experience(&family.parent_id.to_string())?;
    let mut recorded = BTreeMap::new();
    let members = family.generators.iter().flat_map(|generated| &generated.members);
    for slot in members.map(|member| member.slot.clone()).collect::<BTreeSet<String>>() {
        let Ok(hour) = slot.parse::<TimeSlot>() else { continue };
        if hour != parent.slot
            && let Some((other, nearest)) = nearest(store, &catalog, (family.parent_id, &parent), hour)?
        {
            recorded.insert(slot, json!({ "experience": other.to_string(), "nearest": nearest }));
        }
    }
    let stamps: Vec<String> = parent.nodes.iter().map(|node| node.stamp_ns.to_string()).collect();
    Ok(Reply::json(&json!({ "family": family, "stamps_ns": stamps, "recorded": recorded })))
}

/// For each node the nearest recorded one and how far away it is, metres.
type Nearest = Vec<Option<(usize, f64)>>;

/// The experience recorded at an hour on the same route, and its nodes nearest to each node; `None` where no ground
/// truth tells.
fn nearest(
    store: &Store,
    catalog: &Catalog,
    (parent_id, parent): (ExperienceId, &Experience),
    hour: TimeSlot,
) -> Result<Option<(ExperienceId, Nearest)>, BrowseError> {
    let Some(own) = catalog.traversals_of(parent_id)?.into_iter().next() else { return Ok(None) };
    let own = catalog.traversal(own.id)?;
    let there = catalog.traversals_at(&parent.site, hour, (0, SEARCHED))?;
    let there = there.iter().find(|row| row.purpose == Purpose::Experience && row.route == parent.route);
    let Some((other, row)) = there.and_then(|row| Some((row.experience?, row))) else { return Ok(None) };
    let record = catalog.traversal(row.id)?;
    let (_, experience) = store.experience(&other.to_string())?;
    let (here, there) = (Track::of(store, &own, None)?, Track::of(store, &record, Some(&own))?);
    if !here.is_true() || !there.is_true() {
        return Ok(None);
    }
    let (own_frames, frames) = (store.frames(&own)?, store.frames(&record)?);
    let at = |track: &Track, frames: &[Frame], stamp_ns: i64| {
        let frame = frames.binary_search_by_key(&stamp_ns, |frame| frame.stamp_ns).ok()?;
        track.points.get(frame).copied().flatten()
    };
    let positions: Vec<Option<[f64; 2]>> =
        experience.nodes.iter().map(|node| at(&there, &frames, node.stamp_ns)).collect();
    let nearest = |stamp_ns: i64| {
        let [x, y] = at(&here, &own_frames, stamp_ns)?;
        let far = |position: &Option<[f64; 2]>| position.map(|[east, north]| (east - x).hypot(north - y));
        let all = positions.iter().enumerate().filter_map(|(node, position)| Some((node, far(position)?)));
        all.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, metres)| *metres <= NEAR_M)
    };
    Ok(Some((other, parent.nodes.iter().map(|node| nearest(node.stamp_ns)).collect())))
}
