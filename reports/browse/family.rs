//! A recorded experience and those that were generated from it.

use super::error::BrowseError;
use super::insight::GateReading;
use super::store::Store;
use crate::wording;
use furrow_catalog::Catalog;
use furrow_model::{ExperienceId, ExperienceKind, ObjectId, TimeSlot};
use serde::Serialize;
use std::collections::BTreeMap;

/// Children that are shown.
const MOST: usize = 60;

/// The parent and its children, by generator.
#[derive(Serialize)]
pub(super) struct Family {
    #[serde(skip)]
    pub parent_id: ExperienceId,
    parent: Member,
    pub generators: Vec<Generated>,
    left_out: usize,
}

/// One generator's children, by z.
#[derive(Serialize)]
pub(super) struct Generated {
    name: String,
    pub members: Vec<Member>,
}

#[derive(Serialize)]
pub(super) struct Member {
    id: String,
    short: String,
    z: f64,
    pub slot: String,
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
        // Trained generators come first: they have several z.
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
