//! The outings of a matrix' site, and what each axis entry finds among them.

use super::generated::Making;
use super::{Found, number_repeats, suggest};
use crate::RunError;
use crate::matrix::Matrix;
use furrow_catalog::index::TraversalRow;
use furrow_catalog::records::{TraversalRecord, record_id};
use furrow_catalog::tables::{self, Frame};
use furrow_catalog::{Catalog, Objects};
use furrow_ingest::outing::experience_of;
use furrow_model::{Experience, ExperienceId, ObjectId, Purpose, TimeSlot, Trajectory, TraversalId};
use std::collections::{BTreeMap, BTreeSet};

/// A pass with its frames and chain.
#[derive(Debug, Clone)]
pub struct LivePass {
    /// The traversal.
    pub id: TraversalId,
    /// Its record.
    pub record: TraversalRecord,
    /// Its frames.
    pub frames: Vec<Frame>,
    /// Its chain.
    pub chain: Trajectory,
}

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

impl LivePass {
    /// The left images of its frames, in order.
    pub(crate) fn images(&self) -> impl Iterator<Item = ObjectId> + '_ {
        self.frames.iter().map(|frame| frame.left)
    }

    /// How many left images are also nodes of an experience.
    pub(crate) fn shared_images(&self, contender: &Contender) -> usize {
        let nodes: BTreeSet<ObjectId> = contender.images().collect();
        self.images().filter(|image| nodes.contains(image)).count()
    }

    pub(crate) fn load(catalog: &Catalog, id: TraversalId) -> Result<Self, RunError> {
        let record = catalog.traversal(id)?;
        let (frames, chain) = load_frames(catalog.objects(), &record)?;
        Ok(Self { id, record, frames, chain })
    }
}

fn load_frames(objects: &Objects, record: &TraversalRecord) -> Result<(Vec<Frame>, Trajectory), RunError> {
    let frames = tables::frames_from_parquet(objects.read(record.frames)?)?;
    Ok((frames, tables::chain_from_parquet(objects.read(record.chain)?)?))
}

/// The traversals of one site.
pub(crate) struct Passes<'a> {
    catalog: &'a Catalog,
    matrix: &'a Matrix,
    rows: Vec<TraversalRow>,
    route: Option<String>,
}

impl<'a> Passes<'a> {
    pub fn of(catalog: &'a Catalog, matrix: &'a Matrix) -> Result<Self, RunError> {
        let all = catalog.traversals()?;
        let sites: BTreeSet<&str> = all.iter().map(|row| row.site.as_str()).collect();
        if !sites.contains(matrix.site.as_str()) {
            let hint = suggest::nearest(&matrix.site, sites.iter().copied());
            return Err(RunError::Plan(format!("site '{}' has no outing in this store{hint}", matrix.site)));
        }
        let rows: Vec<TraversalRow> = all.iter().filter(|row| row.site == matrix.site).cloned().collect();
        let judged = rows.iter().filter(|row| row.purpose != Purpose::Vocabulary);
        let routes: BTreeSet<&str> = judged.map(|row| row.route.as_str()).collect();
        let route = match &matrix.route {
            Some(route) if !routes.contains(route.as_str()) => {
                let hint = suggest::nearest(route, routes.iter().copied());
                return Err(RunError::Plan(format!(
                    "route '{route}' of site '{}' has no outing in this store{hint}",
                    matrix.site
                )));
            }
            Some(route) => Some(route.clone()),
            None if routes.len() > 1 => {
                let names = routes.iter().copied().collect::<Vec<_>>().join(", ");
                let reason =
                    format!("site '{}' has several routes ({names}): add route = \"…\" to the matrix", matrix.site);
                return Err(RunError::Plan(reason));
            }
            None => routes.first().map(|route| (*route).to_owned()),
        };
        Ok(Self { catalog, matrix, rows, route })
    }

    /// The passes of a purpose that `wanted` accepts.
    pub fn load(&self, purpose: Purpose, wanted: impl Fn(&TraversalRow) -> bool) -> Result<Vec<LivePass>, RunError> {
        let rows = self.rows.iter().filter(|row| row.purpose == purpose && wanted(row));
        rows.map(|row| LivePass::load(self.catalog, row.id)).collect()
    }

    fn on_route(&self, row: &TraversalRow) -> bool {
        self.route.as_ref().is_none_or(|route| *route == row.route)
    }

    /// The evaluation passes at a slot.
    pub fn live(&self, slot: TimeSlot) -> Result<Found<LivePass>, RunError> {
        let found = self.load(Purpose::Evaluation, |row| row.slot == slot && self.on_route(row))?;
        Ok(if found.is_empty() { Found::Nothing(self.no_pass(Purpose::Evaluation, slot)) } else { Found::Items(found) })
    }

    /// The recorded experiences at a slot, under the matrix' keyframe policy: one per chain, whatever versions the store holds.
    pub fn recorded(&self, slot: TimeSlot) -> Result<Found<Contender>, RunError> {
        let mut chains: BTreeMap<ObjectId, Contender> = BTreeMap::new();
        let rows =
            self.rows.iter().filter(|row| row.purpose == Purpose::Experience && row.slot == slot && self.on_route(row));
        for row in rows {
            let traversal = self.catalog.traversal(row.id)?;
            if chains.contains_key(&traversal.chain) {
                continue;
            }
            let (frames, chain) = load_frames(self.catalog.objects(), &traversal)?;
            let record = experience_of(&traversal, &frames, &chain, self.matrix.keyframes);
            let id = ExperienceId(record_id(&record).0);
            chains.insert(
                traversal.chain,
                Contender { label: slot.to_string(), slot, id, record, traversal, making: None },
            );
        }
        let mut found: Vec<Contender> = chains.into_values().collect();
        if found.is_empty() {
            return Ok(Found::Nothing(self.no_pass(Purpose::Experience, slot)));
        }
        let mut labels: Vec<String> = found.iter().map(|contender| contender.label.clone()).collect();
        number_repeats(&mut labels);
        found.iter_mut().zip(labels).for_each(|(contender, label)| contender.label = label);
        Ok(Found::Items(found))
    }

    /// The slots with a recorded experience, by hour.
    pub fn recorded_slots(&self) -> BTreeSet<TimeSlot> {
        let rows = self.rows.iter().filter(|row| row.purpose == Purpose::Experience && self.on_route(row));
        rows.map(|row| row.slot).collect()
    }

    fn no_pass(&self, purpose: Purpose, slot: TimeSlot) -> String {
        let rows = self.rows.iter().filter(|row| row.purpose == purpose && self.on_route(row));
        let slots: BTreeSet<TimeSlot> = rows.map(|row| row.slot).collect();
        let listed = slots.iter().map(TimeSlot::to_string).collect::<Vec<_>>().join(", ");
        let there = if slots.is_empty() { "there are none".to_owned() } else { format!("there are {listed}") };
        format!(
            "no {purpose} pass at {slot} for site '{}': {there}; ingest one with --pass {purpose} --slot {slot}",
            self.matrix.site
        )
    }

    /// Why there is no codebook.
    pub fn no_vocabulary(&self) -> String {
        let routes: BTreeSet<&str> =
            self.rows.iter().filter(|row| row.purpose == Purpose::Vocabulary).map(|row| row.route.as_str()).collect();
        let hint = suggest::nearest(&self.matrix.codebook.route, routes.into_iter());
        format!(
            "no vocabulary pass on route '{}' of site '{}'{hint}; ingest one with --pass vocabulary --route {}",
            self.matrix.codebook.route, self.matrix.site, self.matrix.codebook.route
        )
    }
}
