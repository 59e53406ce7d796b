//! The traversals of a matrix' site, and what each axis entry finds among them.

use crate::inputs::contender::{Contender, number_repeats};
use crate::inputs::zone::SiteClock;
use crate::matrix::{Matrix, TraversalEntry};
use crate::{RunError, suggest};
use furrow_catalog::index::TraversalRow;
use furrow_catalog::records::{TraversalRecord, record_id};
use furrow_catalog::tables::{self, Frame};
use furrow_catalog::{Catalog, Objects};
use furrow_ingest::traversal::experience_of;
use furrow_model::{ExperienceId, ObjectId, Purpose, TimeSlot, Trajectory, TraversalId};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

/// A traversal with its frames and chain.
#[derive(Debug, Clone)]
pub struct LiveTraversal {
    /// The traversal.
    pub id: TraversalId,
    /// Its record.
    pub record: TraversalRecord,
    /// Its frames.
    pub frames: Vec<Frame>,
    /// Its chain.
    pub chain: Trajectory,
}

impl LiveTraversal {
    /// The left images of its frames, in order.
    pub(crate) fn images(&self) -> impl Iterator<Item = ObjectId> + '_ {
        self.frames.iter().map(|frame| frame.left)
    }

    /// How far along its chain each frame was taken, metres.
    pub(crate) fn travelled_m(&self) -> Vec<f64> {
        self.chain.poses().iter().map(|pose| pose.travelled_m).collect()
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

/// What an entry of an axis came to.
pub(crate) enum Found<T> {
    Items(Vec<T>),
    Nothing(String),
}

fn load_frames(objects: &Objects, record: &TraversalRecord) -> Result<(Vec<Frame>, Trajectory), RunError> {
    let frames = tables::frames_from_parquet(objects.read(record.frames)?)?;
    Ok((frames, tables::chain_from_parquet(objects.read(record.chain)?)?))
}

/// Traversals that were read, for all settings of a matrix.
pub(crate) type Known = RefCell<BTreeMap<TraversalId, LiveTraversal>>;

/// The traversals of one site.
pub(crate) struct SiteTraversals<'a> {
    catalog: &'a Catalog,
    known: &'a Known,
    matrix: &'a Matrix,
    rows: Vec<TraversalRow>,
    route: Option<String>,
}

impl<'a> SiteTraversals<'a> {
    pub fn of(catalog: &'a Catalog, known: &'a Known, matrix: &'a Matrix) -> Result<Self, RunError> {
        let all = catalog.traversals()?;
        let sites: BTreeSet<&str> = all.iter().map(|row| row.site.as_str()).collect();
        if !sites.contains(matrix.site.as_str()) {
            let hint = suggest::nearest(&matrix.site, sites.iter().copied());
            return Err(RunError::Site(format!("site '{}' has no traversal in this store{hint}", matrix.site)));
        }
        let rows: Vec<TraversalRow> = all.iter().filter(|row| row.site == matrix.site).cloned().collect();
        let judged = rows.iter().filter(|row| row.purpose != Purpose::Vocabulary);
        let routes: BTreeSet<&str> = judged.map(|row| row.route.as_str()).collect();
        let route = match &matrix.route {
            Some(route) if !routes.contains(route.as_str()) => {
                let hint = suggest::nearest(route, routes.iter().copied());
                return Err(RunError::Site(format!(
                    "route '{route}' of site '{}' has no traversal in this store{hint}",
                    matrix.site
                )));
            }
            Some(route) => Some(route.clone()),
            None if routes.len() > 1 => {
                let names = routes.iter().copied().collect::<Vec<_>>().join(", ");
                let reason =
                    format!("site '{}' has several routes ({names}): add route = \"…\" to the matrix", matrix.site);
                return Err(RunError::Site(reason));
            }
            None => routes.first().map(|route| (*route).to_owned()),
        };
        Ok(Self { catalog, known, matrix, rows, route })
    }

    /// The traversals of a purpose that `wanted` accepts.
    pub fn load(
        &self,
        purpose: Purpose,
        wanted: impl Fn(&TraversalRow) -> bool,
    ) -> Result<Vec<LiveTraversal>, RunError> {
        let rows = self.rows.iter().filter(|row| row.purpose == purpose && wanted(row));
        rows.map(|row| self.traversal(row.id)).collect()
    }

    /// A traversal, read once.
    fn traversal(&self, id: TraversalId) -> Result<LiveTraversal, RunError> {
        if let Some(traversal) = self.known.borrow().get(&id) {
            return Ok(traversal.clone());
        }
        let traversal = LiveTraversal::load(self.catalog, id)?;
        self.known.borrow_mut().insert(id, traversal.clone());
        Ok(traversal)
    }

    fn on_route(&self, row: &TraversalRow) -> bool {
        self.route.as_ref().is_none_or(|route| *route == row.route)
    }

    /// The traversals of a purpose at one slot that an entry names, with their numbers; not narrowed, they need not be
    /// read.
    fn chosen(&self, purpose: Purpose, slot: TimeSlot, entry: &TraversalEntry) -> Result<Vec<TraversalId>, RunError> {
        let rows = self.rows.iter().filter(|row| row.purpose == purpose && row.slot == slot && self.on_route(row));
        let ids: Vec<TraversalId> = rows.map(|row| row.id).collect();
        if !entry.narrows() {
            return Ok(ids);
        }
        let mut driven = ids.iter().map(|id| self.driven(*id, slot)).collect::<Result<Vec<_>, _>>()?;
        driven.sort();
        let numbered = (1..).zip(driven);
        let wanted = numbered.filter(|(number, (_, date, _))| {
            entry.number.is_none_or(|wanted| wanted == *number)
                && entry.date.as_ref().is_none_or(|wanted| wanted == date)
        });
        Ok(wanted.map(|(_, (_, _, id))| id).collect())
    }

    /// When a traversal was driven: the first frame's stamp, and the day by the site's clocks.
    fn driven(&self, id: TraversalId, slot: TimeSlot) -> Result<(i64, String, TraversalId), RunError> {
        let traversal = self.traversal(id)?;
        let stamp_ns = traversal.frames.first().map_or(0, |frame| frame.stamp_ns);
        Ok((stamp_ns, SiteClock::of(self.catalog, &traversal.record)?.day(stamp_ns, slot), id))
    }

    /// The slots that an entry means.
    fn slots_of(&self, purpose: Purpose, entry: &TraversalEntry) -> Vec<TimeSlot> {
        match entry.slot {
            Some(slot) => vec![slot],
            None => self.slots(purpose).into_iter().collect(),
        }
    }

    /// The evaluation traversals that an entry names.
    pub fn live(&self, entry: &TraversalEntry) -> Result<Found<LiveTraversal>, RunError> {
        let mut found = Vec::new();
        for slot in self.slots_of(Purpose::Evaluation, entry) {
            for id in self.chosen(Purpose::Evaluation, slot, entry)? {
                found.push(self.traversal(id)?);
            }
        }
        Ok(if found.is_empty() {
            Found::Nothing(self.no_traversal(Purpose::Evaluation, entry)?)
        } else {
            Found::Items(found)
        })
    }

    /// The recorded experiences that an entry names, under the matrix' keyframe policy: one per chain, whatever
    /// versions the store holds.
    pub fn recorded(&self, entry: &TraversalEntry) -> Result<Found<Contender>, RunError> {
        let mut all = Vec::new();
        for slot in self.slots_of(Purpose::Experience, entry) {
            let mut chains: BTreeMap<ObjectId, Contender> = BTreeMap::new();
            for id in self.chosen(Purpose::Experience, slot, entry)? {
                let LiveTraversal { record: traversal, frames, chain, .. } = self.traversal(id)?;
                if chains.contains_key(&traversal.chain) {
                    continue;
                }
                let record = experience_of(&traversal, &frames, &chain, self.matrix.keyframes);
                let id = ExperienceId(record_id(&record)?.0);
                let label = TraversalEntry { slot: Some(slot), ..entry.clone() }.to_string();
                chains.insert(traversal.chain, Contender { label, slot, id, record, traversal, making: None });
            }
            let mut found: Vec<Contender> = chains.into_values().collect();
            let mut labels: Vec<String> = found.iter().map(|contender| contender.label.clone()).collect();
            number_repeats(&mut labels);
            found.iter_mut().zip(labels).for_each(|(contender, label)| contender.label = label);
            all.extend(found);
        }
        Ok(if all.is_empty() {
            Found::Nothing(self.no_traversal(Purpose::Experience, entry)?)
        } else {
            Found::Items(all)
        })
    }

    /// The slots with a traversal of a purpose, by hour.
    fn slots(&self, purpose: Purpose) -> BTreeSet<TimeSlot> {
        let rows = self.rows.iter().filter(|row| row.purpose == purpose && self.on_route(row));
        rows.map(|row| row.slot).collect()
    }

    fn no_traversal(&self, purpose: Purpose, entry: &TraversalEntry) -> Result<String, RunError> {
        let site = &self.matrix.site;
        let slots = self.slots(purpose);
        if let Some(slot) = entry.slot.filter(|slot| slots.contains(slot) && entry.narrows()) {
            let mut driven = Vec::new();
            for id in self.chosen(purpose, slot, &TraversalEntry::at(slot))? {
                driven.push(self.driven(id, slot)?);
            }
            driven.sort();
            let there: Vec<String> =
                (1..).zip(driven).map(|(n, (_, date, _))| format!("number {n} on {date}")).collect();
            return Ok(format!(
                "no {purpose} traversal is \"{entry}\" for site '{site}': there is {}",
                there.join(", ")
            ));
        }
        let listed = slots.iter().map(TimeSlot::to_string).collect::<Vec<_>>().join(", ");
        let there = if slots.is_empty() { "there are none".to_owned() } else { format!("there are {listed}") };
        let at = entry.slot.map_or("HH:MM".to_owned(), |slot| slot.to_string());
        Ok(format!(
            "no {purpose} traversal at {entry} for site '{site}': {there}; ingest one with --purpose {purpose} --slot {at}"
        ))
    }

    /// Why there is no codebook.
    pub fn no_vocabulary(&self) -> String {
        let routes: BTreeSet<&str> =
            self.rows.iter().filter(|row| row.purpose == Purpose::Vocabulary).map(|row| row.route.as_str()).collect();
        let hint = suggest::nearest(&self.matrix.codebook.route, routes.into_iter());
        format!(
            "no vocabulary traversal on route '{}' of site '{}'{hint}; ingest one with --purpose vocabulary --route {}",
            self.matrix.codebook.route, self.matrix.site, self.matrix.codebook.route
        )
    }
}
