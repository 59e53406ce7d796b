//! A recorded experience and what was generated from it, place by place.

use crate::browse::BrowseError;
use crate::browse::answer::Answer;
use crate::browse::insight::GateReading;
use crate::browse::store::Store;
use crate::browse::track::{Ground, Track};
use crate::wording;
use furrow_catalog::Catalog;
use furrow_model::{Experience, ExperienceId, ExperienceKind, ObjectId, Purpose, TimeSlot};
use serde::Serialize;
use serde_json::json;
use std::collections::BTreeMap;

/// Children that are shown.
const MOST: usize = 60;
/// A recorded place this far away is not the same one.
const NEAR_M: f64 = 5.0;

/// The parent and its children, by generator.
#[derive(Serialize)]
pub(crate) struct Family {
    #[serde(skip)]
    pub parent_id: ExperienceId,
    parent: Member,
    generators: Vec<Generated>,
    left_out: usize,
}

/// One generator's children, by z.
#[derive(Serialize)]
struct Generated {
    name: String,
    members: Vec<Member>,
}

#[derive(Serialize)]
struct Member {
    id: String,
    short: String,
    z: f64,
    slot: String,
    gate: Option<Gate>,
}

/// What the quality gate says; `trouble` where its record cannot be read.
#[derive(Serialize)]
struct Gate {
    doubts: Vec<String>,
    figures: Vec<(String, String)>,
    trouble: Option<String>,
}

impl Family {
    /// Of an experience, or of its parent where it was generated.
    pub fn of(store: &Store, catalog: &Catalog, id: ExperienceId) -> Result<Self, BrowseError> {
        let (_, record) = store.experience(&id.to_string())?;
        let parent_id = match record.kind {
            ExperienceKind::Recorded => id,
            ExperienceKind::Generated { parent, .. } => parent,
        };
        let (_, parent) = store.experience(&parent_id.to_string())?;
        let rows = catalog.children(parent_id)?;
        let names: BTreeMap<ObjectId, String> =
            catalog.generators()?.into_iter().map(|row| (row.id, row.name)).collect();
        let mut found: BTreeMap<ObjectId, Vec<Member>> = BTreeMap::new();
        for row in rows.iter().take(MOST) {
            let (_, child) = store.experience(&row.id.to_string())?;
            let ExperienceKind::Generated { generator, domainness, mimics, .. } = &child.kind else { continue };
            found.entry(*generator).or_default().push(member(row.id, domainness.0, *mimics));
        }
        let mut generators = Vec::new();
        for (generator, mut members) in found {
            for gate in catalog.gates(generator)?.iter().filter(|gate| gate.parent == parent_id) {
                for member in members.iter_mut().filter(|member| member.z == gate.domainness) {
                    member.gate = Some(read_gate(store, gate.object));
                }
            }
            members.sort_by(|a, b| a.z.total_cmp(&b.z));
            let name = names.get(&generator).cloned().unwrap_or_else(|| generator.short());
            generators.push(Generated { name: wording::shown(&name), members });
        }
        // Those that were trained say most: they paint several z.
        generators.sort_by(|a, b| b.members.len().cmp(&a.members.len()).then(a.name.cmp(&b.name)));
        let left_out = rows.len().saturating_sub(MOST);
        Ok(Self { parent_id, parent: member(parent_id, 0.0, parent.slot), generators, left_out })
    }
}

fn member(id: ExperienceId, z: f64, slot: TimeSlot) -> Member {
    Member { id: id.to_string(), short: id.short(), z, slot: slot.to_string(), gate: None }
}

fn read_gate(store: &Store, object: ObjectId) -> Gate {
    match store.insight.gate(store.objects(), object) {
        Ok(GateReading { doubts, figures }) => {
            Gate { doubts: doubts.iter().map(|doubt| wording::shown(doubt)).collect(), figures, trouble: None }
        }
        Err(error) => {
            Gate { doubts: Vec::new(), figures: Vec::new(), trouble: Some(wording::shown(&error.to_string())) }
        }
    }
}

/// The parent's places, the children as they can be looked at, and what was really recorded nearest to each place at the hours they mimic.
pub(crate) fn family(store: &Store, typed: String) -> Result<Answer, BrowseError> {
    let catalog = store.catalog()?;
    let (id, _) = store.experience(&typed)?;
    let family = Family::of(store, &catalog, id)?;
    let (_, parent) = store.experience(&family.parent_id.to_string())?;
    let mut recorded = BTreeMap::new();
    let slots = family.generators.iter().flat_map(|generated| &generated.members).map(|member| member.slot.clone());
    for slot in slots.collect::<std::collections::BTreeSet<String>>() {
        let Ok(hour) = slot.parse::<TimeSlot>() else { continue };
        if hour != parent.slot
            && let Some((other, nearest)) = nearest(store, &catalog, (family.parent_id, &parent), hour)?
        {
            recorded.insert(slot, json!({ "experience": other.to_string(), "nearest": nearest }));
        }
    }
    let stamps: Vec<String> = parent.nodes.iter().map(|node| node.stamp_ns.to_string()).collect();
    Ok(Answer::json(&json!({ "family": family, "stamps_ns": stamps, "recorded": recorded })))
}

/// Of each place the nearest recorded one and how far away it is, metres.
type Nearest = Vec<Option<(usize, f64)>>;

/// What was recorded at an hour on the same route, nearest to each place; `None` where no ground truth tells.
fn nearest(
    store: &Store,
    catalog: &Catalog,
    (parent_id, parent): (ExperienceId, &Experience),
    hour: TimeSlot,
) -> Result<Option<(ExperienceId, Nearest)>, BrowseError> {
    let Some(own) = catalog.traversals_of(parent_id)?.into_iter().next() else { return Ok(None) };
    let own = catalog.traversal(own.id)?;
    let there = catalog.traversals_at(&parent.site, hour, (0, MOST as u32))?;
    let there = there.iter().find(|row| row.purpose == Purpose::Experience && row.route == parent.route);
    let Some((other, row)) = there.and_then(|row| Some((row.experience?, row))) else { return Ok(None) };
    let record = catalog.traversal(row.id)?;
    let (_, experience) = store.experience(&other.to_string())?;
    let (here, there) = (Track::of(store, &own, None)?, Track::of(store, &record, Some(&own))?);
    let comparable = |track: &Track| matches!(track.ground, Ground::Truth { .. });
    if !comparable(&here) || !comparable(&there) {
        return Ok(None);
    }
    let (own_frames, frames) = (store.frames(&own)?, store.frames(&record)?);
    let at = |track: &Track, frames: &[furrow_catalog::tables::Frame], stamp_ns: i64| {
        let frame = frames.binary_search_by_key(&stamp_ns, |frame| frame.stamp_ns).ok()?;
        track.points.get(frame).copied().flatten()
    };
    let places: Vec<Option<[f64; 2]>> =
        experience.nodes.iter().map(|node| at(&there, &frames, node.stamp_ns)).collect();
    let of = |stamp_ns: i64| {
        let [x, y] = at(&here, &own_frames, stamp_ns)?;
        let far = |place: &Option<[f64; 2]>| place.map(|[east, north]| (east - x).hypot(north - y));
        let all = places.iter().enumerate().filter_map(|(node, place)| Some((node, far(place)?)));
        all.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, metres)| *metres <= NEAR_M)
    };
    Ok(Some((other, parent.nodes.iter().map(|node| of(node.stamp_ns)).collect())))
}
