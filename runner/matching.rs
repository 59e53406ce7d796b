//! The matching stage: each live frame's words against an experience's nodes by FAB-MAP 2.0.

use crate::RunError;
use crate::codebook::ReadyCodebook;
use crate::key::{MATCHES, key_of};
use crate::table::{column, encode};
use crate::words::Words;
use furrow_catalog::{Objects, tables};
use furrow_localiser::FabMap;
use furrow_localiser::fabmap::{Answer, Best, FabMapParams};
use furrow_model::ObjectId;
use rayon::prelude::*;

/// A node on offer for a live frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Candidate {
    pub node: u32,
    pub log_likelihood: f64,
    pub posterior: f64,
}

/// What an experience answers one live frame.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FrameMatches {
    pub new_place: bool,
    pub new_place_log_likelihood: f64,
    pub new_place_posterior: f64,
    /// The most likely nodes, best first.
    pub candidates: Vec<Candidate>,
}

/// The answers to a live pass, and the object that holds them.
pub(crate) struct Matches {
    pub table: ObjectId,
    pub frames: Vec<FrameMatches>,
}

/// Candidates kept of each answer: enough to see what the best was chosen from.
const KEPT: usize = 5;

/// Finds or computes an experience's answers to a live pass. `kept` candidates at least are remembered.
pub(crate) fn matches(
    objects: &Objects,
    live: &Words,
    map: &Words,
    codebook: &ReadyCodebook,
    verified: u32,
) -> Result<Matches, RunError> {
    let kept = KEPT.max(verified as usize);
    let params = FabMapParams::OPENFABMAP;
    let key =
        key_of(MATCHES, &(live.table, map.table, live.presences.len(), map.presences.len(), codebook.id, params, kept));
    if let Some(table) = objects.derived(key)? {
        return Ok(Matches { table, frames: read(objects.read(table)?)? });
    }
    let wrong = |error: furrow_localiser::fabmap::FabMapError| RunError::Codebook(error.to_string());
    let mut places = FabMap::new(&codebook.codebook.tree, params, &codebook.codebook.samples).map_err(wrong)?;
    for place in &map.presences {
        places.add_place(place).map_err(wrong)?;
    }
    let frames = live
        .presences
        .par_iter()
        .map_init(Answer::default, |answer, presence| {
            places.query_into(presence, answer).map_err(wrong)?;
            Ok(frame_matches(answer, kept))
        })
        .collect::<Result<Vec<_>, RunError>>()?;
    let table = objects.write(&write(&frames)?)?;
    objects.remember(key, table)?;
    Ok(Matches { table, frames })
}

fn frame_matches(answer: &Answer, kept: usize) -> FrameMatches {
    let candidate = |node: usize| Candidate {
        node: node as u32,
        log_likelihood: answer.log_likelihoods[node],
        posterior: answer.posteriors[node],
    };
    FrameMatches {
        new_place: answer.best() == Best::NewPlace,
        new_place_log_likelihood: answer.new_place_log_likelihood,
        new_place_posterior: answer.new_place_posterior,
        candidates: answer.ranked(kept).into_iter().map(candidate).collect(),
    }
}

/// A row for each frame's new place (no node), then one per candidate.
fn write(frames: &[FrameMatches]) -> Result<Vec<u8>, RunError> {
    let mut rows: Vec<(u32, bool, Option<u32>, f64, f64)> = Vec::new();
    for (i, frame) in (0..).zip(frames) {
        rows.push((i, frame.new_place, None, frame.new_place_log_likelihood, frame.new_place_posterior));
        let candidate = |c: &Candidate| (i, frame.new_place, Some(c.node), c.log_likelihood, c.posterior);
        rows.extend(frame.candidates.iter().map(candidate));
    }
    let columns = vec![
        column("frame", rows.iter().map(|row| row.0)),
        column("new_place", rows.iter().map(|row| row.1)),
        column("node", rows.iter().map(|row| row.2)),
        column("log_likelihood", rows.iter().map(|row| row.3)),
        column("posterior", rows.iter().map(|row| row.4)),
    ];
    Ok(encode("matches", rows.len(), columns)?)
}

fn read(bytes: Vec<u8>) -> Result<Vec<FrameMatches>, RunError> {
    let table = tables::from_parquet("matches", bytes)?;
    let new_place = tables::bools(&table, "new_place")?;
    let nodes = tables::optional_u32s(&table, "node")?;
    let (log_likelihood, posterior) = (tables::f64s(&table, "log_likelihood")?, tables::f64s(&table, "posterior")?);
    let mut frames: Vec<FrameMatches> = Vec::new();
    for i in 0..table.height() {
        match (nodes[i], frames.last_mut()) {
            (Some(node), Some(frame)) => {
                frame.candidates.push(Candidate { node, log_likelihood: log_likelihood[i], posterior: posterior[i] });
            }
            _ => frames.push(FrameMatches {
                new_place: new_place[i],
                new_place_log_likelihood: log_likelihood[i],
                new_place_posterior: posterior[i],
                candidates: Vec::new(),
            }),
        }
    }
    Ok(frames)
}
