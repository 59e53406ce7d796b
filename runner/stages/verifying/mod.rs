//! The verification stage: inliers of live frames against candidate nodes (thesis, figure 3.5). It knows two ways to
//! verify, and no place recogniser.

mod pairs;
mod verifier;
mod windows;

pub(crate) use pairs::pair_inliers;
pub(crate) use verifier::{Agreement, CalibrationInput, ThreeViews, Verifier, Visitor, visit};

use crate::RunError;
use crate::inputs::answers::{FrameMatches, Matches};
use crate::inputs::contender::Contender;
use crate::inputs::table::{column, encode};
use crate::inputs::traversals::LiveTraversal;
use crate::progress::{Counter, Progress, Stage, Subject};
use furrow_catalog::records::FeatureParameters;
use furrow_catalog::tables;
use furrow_catalog::{CatalogError, Objects, Views};
use furrow_model::{ObjectId, StereoRig};
use rayon::prelude::*;
use std::collections::BTreeMap;
use windows::{Asked, Window, room, windows};

/// What verification counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Counted {
    pub matches: u32,
    pub inliers: u32,
}

/// The counts of an experience's candidates: by live frame and node.
pub(crate) type Counts = BTreeMap<(u32, u32), Counted>;

/// An experience's matches, to be verified.
pub(crate) struct Unverified<'a> {
    pub contender: &'a Contender,
    pub matches: &'a Matches,
}

/// How answers are verified.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Asking {
    /// Each experience's best so many places.
    pub candidates: u32,
    pub features: FeatureParameters,
    /// Bytes to stay within.
    pub memory: u64,
}

/// Finds or computes the counts of several experiences' candidates for one live traversal. Each live frame is prepared
/// once for all of them.
pub(crate) fn verify_traversal(
    objects: &Objects,
    live: &LiveTraversal,
    experiences: &[Unverified<'_>],
    asking: Asking,
    progress: Progress<'_>,
) -> Result<Vec<Counts>, RunError> {
    visit(&live.record.rig, asking.features, Verification { objects, live, experiences, asking, progress })
}

/// The key of the counts of an experience's candidates for a live traversal.
pub(crate) fn counts_key(
    live: &LiveTraversal,
    contender: &Contender,
    matches: ObjectId,
    (candidates, features): (u32, FeatureParameters),
) -> Result<ObjectId, CatalogError> {
    visit(&live.record.rig, features, CountsKey { live, contender, matches, candidates })
}

struct CountsKey<'a> {
    live: &'a LiveTraversal,
    contender: &'a Contender,
    matches: ObjectId,
    candidates: u32,
}

impl Visitor for CountsKey<'_> {
    type Output = Result<ObjectId, CatalogError>;

    fn visit(self, verifier: &impl Verifier) -> Self::Output {
        verifier.key(self.live, self.contender, self.matches, self.candidates)
    }
}

/// What [`verify_traversal`] is asked for.
struct Verification<'a> {
    objects: &'a Objects,
    live: &'a LiveTraversal,
    experiences: &'a [Unverified<'a>],
    asking: Asking,
    progress: Progress<'a>,
}

impl Visitor for Verification<'_> {
    type Output = Result<Vec<Counts>, RunError>;

    fn visit(self, verifier: &impl Verifier) -> Self::Output {
        let Self { objects, live, experiences, asking, progress } = self;
        let key = |item: &Unverified<'_>| verifier.key(live, item.contender, item.matches.table, asking.candidates);
        let mut counts: Vec<Option<Counts>> = Vec::new();
        for item in experiences {
            let table = objects.derived(key(item)?)?;
            counts.push(table.map(|table| read(objects.read(table)?)).transpose()?);
        }
        let missing: Vec<usize> = (0..experiences.len()).filter(|i| counts[*i].is_none()).collect();
        let work: Vec<&Unverified<'_>> = missing.iter().map(|i| &experiences[*i]).collect();
        let fresh = count_all(verifier, objects, live, &work, asking, progress)?;
        for (i, found) in missing.into_iter().zip(fresh) {
            let table = objects.write(&write(&found)?)?;
            objects.remember(key(&experiences[i])?, table)?;
            counts[i] = Some(found);
        }
        Ok(counts.into_iter().flatten().collect())
    }
}

/// The nodes of one answer that are verified: the best few, unless it says new place.
pub(crate) fn to_verify(frame: &FrameMatches, candidates: u32) -> impl Iterator<Item = u32> + '_ {
    let count = if frame.new_place { 0 } else { candidates as usize };
    frame.candidates.iter().take(count).map(|candidate| candidate.node)
}

fn count_all<V: Verifier>(
    verifier: &V,
    objects: &Objects,
    live: &LiveTraversal,
    work: &[&Unverified<'_>],
    asking: Asking,
    progress: Progress<'_>,
) -> Result<Vec<Counts>, RunError> {
    let mut counts = vec![Counts::new(); work.len()];
    if work.is_empty() {
        return Ok(counts);
    }
    let asked = asked_by_frame(work, live.frames.len(), asking.candidates);
    let needed = asked.iter().map(Vec::len).max().unwrap_or(0);
    let room = room(asking.memory, rayon::current_num_threads(), &largest(live, work), needed)?;
    let at_work = AtWork { verifier, objects, live, work, views: node_views(objects, work)?, progress };
    let views = Views::load(objects, live.record.calibration)?;
    let mut nodes: BTreeMap<Asked, V::Node> = BTreeMap::new();
    for Window { frames, fresh, dropped } in windows(&asked, room) {
        dropped.iter().for_each(|node| _ = nodes.remove(node));
        nodes.extend(at_work.prepared(&fresh)?);
        for found in at_work.counted(&views, frames.start, &asked[frames], &nodes)? {
            counts[found.experience].insert(found.place, found.counted);
        }
    }
    Ok(counts)
}

/// The nodes that each live frame asks for.
fn asked_by_frame(work: &[&Unverified<'_>], frames: usize, candidates: u32) -> Vec<Vec<Asked>> {
    let asked_of = |frame: usize| {
        let nodes = |i: usize| to_verify(&work[i].matches.frames[frame], candidates).map(move |node| (i, node));
        (0..work.len()).flat_map(nodes).collect()
    };
    (0..frames).map(asked_of).collect()
}

/// The rig with the largest images among all that are looked through.
fn largest(live: &LiveTraversal, work: &[&Unverified<'_>]) -> StereoRig {
    let rigs = work.iter().map(|item| item.contender.record.rig);
    rigs.fold(live.record.rig, |most, rig| {
        if u64::from(rig.width) * u64::from(rig.height) > u64::from(most.width) * u64::from(most.height) {
            rig
        } else {
            most
        }
    })
}

fn node_views(objects: &Objects, work: &[&Unverified<'_>]) -> Result<Vec<Views>, RunError> {
    let views = work.iter().map(|item| Views::load(objects, item.contender.record.calibration));
    Ok(views.collect::<Result<_, _>>()?)
}

/// The counts of one candidate: of which experience at work, for which live frame and node.
struct Found {
    experience: usize,
    place: (u32, u32),
    counted: Counted,
}

/// A live traversal and the experiences that it is verified against.
struct AtWork<'a, V: Verifier> {
    verifier: &'a V,
    objects: &'a Objects,
    live: &'a LiveTraversal,
    work: &'a [&'a Unverified<'a>],
    /// Of each experience.
    views: Vec<Views>,
    progress: Progress<'a>,
}

impl<V: Verifier> AtWork<'_, V> {
    /// The features of nodes.
    fn prepared(&self, nodes: &[Asked]) -> Result<Vec<(Asked, V::Node)>, RunError> {
        let counter = Counter::new(self.progress, (Stage::NodeFeatures, Subject::Whole), nodes.len());
        nodes
            .par_iter()
            .map(|&(i, node)| {
                let image = self.work[i].contender.record.nodes[node as usize].left;
                let features = self.verifier.node(self.objects, &self.views[i], image)?;
                counter.tick();
                Ok(((i, node), features))
            })
            .collect()
    }

    /// The counts of some live frames, of which `first` is the first.
    fn counted(
        &self,
        views: &Views,
        first: usize,
        asked: &[Vec<Asked>],
        nodes: &BTreeMap<Asked, V::Node>,
    ) -> Result<Vec<Found>, RunError> {
        let counter = Counter::new(self.progress, (Stage::Verification, Subject::Whole), asked.len());
        let of_frame = |(offset, asked): (usize, &Vec<Asked>)| {
            let frame = first + offset;
            let mut found = Vec::with_capacity(asked.len());
            if !asked.is_empty() {
                let prepared = self.verifier.live(self.objects, views, &self.live.frames[frame])?;
                for &(i, node) in asked {
                    let agreement = self.verifier.agree(&prepared, &nodes[&(i, node)]);
                    let counted = Counted { matches: agreement.matches, inliers: agreement.inliers };
                    found.push(Found { experience: i, place: (frame as u32, node), counted });
                }
            }
            counter.tick();
            Ok(found)
        };
        let found = asked.par_iter().enumerate().map(of_frame).collect::<Result<Vec<_>, RunError>>()?;
        Ok(found.into_iter().flatten().collect())
    }
}

fn write(counts: &Counts) -> Result<Vec<u8>, RunError> {
    let columns = vec![
        column("frame", counts.keys().map(|place| place.0)),
        column("node", counts.keys().map(|place| place.1)),
        column("matches", counts.values().map(|counted| counted.matches)),
        column("inliers", counts.values().map(|counted| counted.inliers)),
    ];
    Ok(encode("verification", counts.len(), columns)?)
}

fn read(bytes: Vec<u8>) -> Result<Counts, RunError> {
    let table = tables::from_parquet("verification", bytes)?;
    let places = tables::u32s(&table, "frame")?.into_iter().zip(tables::u32s(&table, "node")?);
    let counted = tables::u32s(&table, "matches")?.into_iter().zip(tables::u32s(&table, "inliers")?);
    Ok(places.zip(counted.map(|(matches, inliers)| Counted { matches, inliers })).collect())
}
