//! What the experience axis comes to: experiences that are there, and those that are to be generated.

use crate::RunError;
use crate::inputs::making::Making;
use furrow_catalog::records::{TraversalRecord, record_id};
use furrow_catalog::{CatalogError, Objects, tables};
use furrow_model::{Experience, ExperienceId, ObjectId, TimeSlot};
use std::collections::BTreeMap;

/// An experience on the axis.
#[derive(Debug, Clone)]
pub struct Contender {
    /// What it is called.
    pub label: String,
    /// The slot it was recorded at, or mimics.
    pub slot: TimeSlot,
    /// Its id under the matrix' keyframe policy; of a generated one the key of its making, until it is made.
    pub id: ExperienceId,
    /// Its record.
    pub record: Experience,
    /// A traversal that it was made from, for its ground truth.
    pub traversal: TraversalRecord,
    /// How it is generated; none where it was recorded.
    pub making: Option<Making>,
}

impl Contender {
    /// The left images of its nodes, in order.
    pub(crate) fn images(&self) -> impl Iterator<Item = ObjectId> + '_ {
        self.record.nodes.iter().map(|node| node.left)
    }

    /// How far along its chain each node was taken, metres.
    pub(crate) fn travelled_m(&self, objects: &Objects) -> Result<Vec<f64>, RunError> {
        let chain = tables::chain_from_parquet(objects.read(self.record.chain)?)?.poses();
        // A node's stamp is one of its chain's, in the same order.
        let mut poses = chain.iter();
        let metres = |stamp_ns: i64| poses.find(|pose| pose.stamp_ns == stamp_ns).map_or(0.0, |pose| pose.travelled_m);
        Ok(self.record.nodes.iter().map(|node| node.stamp_ns).map(metres).collect())
    }
}

/// The recorded parent of a generated experience, as a contender.
pub(crate) fn parent_of(contender: &Contender) -> Result<Option<Contender>, CatalogError> {
    let Some(making) = &contender.making else { return Ok(None) };
    Ok(Some(Contender {
        label: making.parent_slot.to_string(),
        slot: making.parent_slot,
        id: ExperienceId(record_id(&making.parent)?.0),
        record: making.parent.clone(),
        traversal: contender.traversal.clone(),
        making: None,
    }))
}

/// Labels that occur once stay; others are numbered in order.
pub(crate) fn number_repeats(labels: &mut [String]) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    labels.iter().for_each(|label| *counts.entry(label.clone()).or_default() += 1);
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for label in labels {
        if counts[label.as_str()] > 1 {
            let number = seen.entry(label.clone()).or_default();
            *number += 1;
            *label = format!("{label} #{number}");
        }
    }
}
