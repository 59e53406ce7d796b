//! The verification stage: inliers of live frames against candidate nodes (SPEC 7).

mod verifier;

pub(crate) use verifier::{AnyVerifier, CalibrationInput, ThreeViews, Verifier};

use crate::RunError;
use crate::matching::{FrameMatches, Matches};
use crate::plan::{Contender, LivePass};
use crate::progress::{Counter, Progress};
use crate::table::{column, encode};
use furrow_catalog::records::FeatureParameters;
use furrow_catalog::tables::{self, Frame};
use furrow_catalog::{Objects, Views};
use furrow_model::ObjectId;
use rayon::prelude::*;
use std::collections::BTreeMap;

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

/// Finds or computes the counts of several experiences' candidates for one live pass. Each live frame is prepared once for all of them.
pub(crate) fn verify_pass(
    objects: &Objects,
    live: &LivePass,
    experiences: &[Unverified<'_>],
    (candidates, features): (u32, FeatureParameters),
    progress: Progress<'_>,
) -> Result<Vec<Counts>, RunError> {
    match AnyVerifier::of(&live.record.rig, features) {
        AnyVerifier::Three(verifier) => verify_by(&verifier, objects, live, experiences, candidates, progress),
        AnyVerifier::Two(verifier) => verify_by(&verifier, objects, live, experiences, candidates, progress),
    }
}

fn verify_by(
    verifier: &impl Verifier,
    objects: &Objects,
    live: &LivePass,
    experiences: &[Unverified<'_>],
    candidates: u32,
    progress: Progress<'_>,
) -> Result<Vec<Counts>, RunError> {
    let key = |item: &Unverified<'_>| verifier.key(live, item.contender, item.matches.table, candidates);
    let mut counts: Vec<Option<Counts>> = Vec::new();
    for item in experiences {
        let table = objects.derived(key(item))?;
        counts.push(table.map(|table| read(objects.read(table)?)).transpose()?);
    }
    let missing: Vec<usize> = (0..experiences.len()).filter(|i| counts[*i].is_none()).collect();
    let work: Vec<&Unverified<'_>> = missing.iter().map(|i| &experiences[*i]).collect();
    let fresh = count_all(verifier, objects, live, &work, candidates, progress)?;
    for (i, found) in missing.into_iter().zip(fresh) {
        let table = objects.write(&write(&found)?)?;
        objects.remember(key(&experiences[i]), table)?;
        counts[i] = Some(found);
    }
    Ok(counts.into_iter().flatten().collect())
}

/// The nodes of one answer that are verified: the best few, unless it says new place.
pub(crate) fn to_verify(frame: &FrameMatches, candidates: u32) -> impl Iterator<Item = u32> + '_ {
    let count = if frame.new_place { 0 } else { candidates as usize };
    frame.candidates.iter().take(count).map(|candidate| candidate.node)
}

fn count_all<V: Verifier>(
    verifier: &V,
    objects: &Objects,
    live: &LivePass,
    work: &[&Unverified<'_>],
    candidates: u32,
    progress: Progress<'_>,
) -> Result<Vec<Counts>, RunError> {
    if work.is_empty() {
        return Ok(Vec::new());
    }
    let nodes = node_features(verifier, objects, work, candidates, progress)?;
    let views = Views::load(objects, live.record.calibration)?;
    let counter = Counter::new(progress, "verifying", live.frames.len());
    let found = (0..live.frames.len() as u32)
        .into_par_iter()
        .map(|frame| {
            let asked: Vec<(usize, u32)> = (0..work.len())
                .flat_map(|i| to_verify(&work[i].matches.frames[frame as usize], candidates).map(move |node| (i, node)))
                .collect();
            let mut found = Vec::with_capacity(asked.len());
            if !asked.is_empty() {
                let prepared = verifier.live(objects, &views, &live.frames[frame as usize])?;
                for (i, node) in asked {
                    let agreement = verifier.agree(&prepared, &nodes[&(i, node)]);
                    let counted = Counted { matches: agreement.matches, inliers: agreement.inliers };
                    found.push((i, (frame, node), counted));
                }
            }
            counter.tick();
            Ok(found)
        })
        .collect::<Result<Vec<_>, RunError>>()?;
    let mut counts = vec![Counts::new(); work.len()];
    for (i, place, counted) in found.into_iter().flatten() {
        counts[i].insert(place, counted);
    }
    Ok(counts)
}

/// The features of every node that some frame asks for.
fn node_features<V: Verifier>(
    verifier: &V,
    objects: &Objects,
    work: &[&Unverified<'_>],
    candidates: u32,
    progress: Progress<'_>,
) -> Result<BTreeMap<(usize, u32), V::Node>, RunError> {
    let mut asked: Vec<(usize, u32)> = (0..work.len())
        .flat_map(|i| {
            work[i].matches.frames.iter().flat_map(move |f| to_verify(f, candidates).map(move |node| (i, node)))
        })
        .collect();
    asked.sort_unstable();
    asked.dedup();
    let views = work
        .iter()
        .map(|item| Views::load(objects, item.contender.record.calibration))
        .collect::<Result<Vec<_>, _>>()?;
    let counter = Counter::new(progress, "features of candidate nodes", asked.len());
    asked
        .par_iter()
        .map(|&(i, node)| {
            let image = work[i].contender.record.nodes[node as usize].left;
            let features = verifier.node(objects, &views[i], image)?;
            counter.tick();
            Ok(((i, node), features))
        })
        .collect()
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

/// The inliers of pairs of frames of one pass: live frame, candidate frame, both as indices into `frames`.
pub(crate) fn pair_inliers<V: Verifier>(
    verifier: &V,
    objects: &Objects,
    calibration: ObjectId,
    frames: &[Frame],
    pairs: &[(usize, usize)],
    progress: Progress<'_>,
) -> Result<Vec<u32>, RunError> {
    let views = Views::load(objects, calibration)?;
    let counter = Counter::new(progress, "calibrating the threshold", frames.len() + pairs.len());
    let prepared = frames
        .par_iter()
        .map(|frame| {
            let both = (verifier.live(objects, &views, frame)?, verifier.node(objects, &views, frame.left)?);
            counter.tick();
            Ok(both)
        })
        .collect::<Result<Vec<(V::Live, V::Node)>, RunError>>()?;
    let inliers = pairs.par_iter().map(|&(live, candidate)| {
        let agreement = verifier.agree(&prepared[live].0, &prepared[candidate].1);
        counter.tick();
        agreement.inliers
    });
    Ok(inliers.collect())
}
