//! Answers as a stored table.

use crate::RunError;
use crate::inputs::answers::{Candidate, FrameMatches, Matches};
use crate::inputs::table::{column, encode};
use furrow_catalog::{Objects, tables};
use furrow_localiser::ranking::Ranked;
use furrow_model::ObjectId;

/// Candidates kept of each answer: enough to see what the best was chosen from.
const KEPT: usize = 5;

/// Finds what was computed under `key`, or computes it.
pub(super) fn remembered(
    objects: &Objects,
    key: ObjectId,
    compute: impl FnOnce() -> Result<Vec<FrameMatches>, RunError>,
) -> Result<Matches, RunError> {
    if let Some(table) = objects.derived(key)? {
        return Ok(Matches { table, frames: read(objects.read(table)?)? });
    }
    let frames = compute()?;
    let table = objects.write(&write(&frames)?)?;
    objects.remember(key, table)?;
    Ok(Matches { table, frames })
}

/// How many candidates are remembered where so many are verified.
pub(super) fn kept(verified: u32) -> usize {
    KEPT.max(verified as usize)
}

/// The answers of a recogniser that ranks all places and knows no new one.
pub(super) fn of_ranked(ranked: Vec<Vec<Ranked>>) -> Vec<FrameMatches> {
    let candidate =
        |ranked: Ranked| Candidate { node: ranked.place as u32, log_likelihood: ranked.score, posterior: None };
    let frame = |ranked: Vec<Ranked>| FrameMatches {
        new_place: false,
        new_place_log_likelihood: None,
        new_place_posterior: None,
        candidates: ranked.into_iter().map(candidate).collect(),
    };
    ranked.into_iter().map(frame).collect()
}

/// A row for each frame's new place (no node), then one per candidate.
fn write(frames: &[FrameMatches]) -> Result<Vec<u8>, RunError> {
    let mut rows: Vec<(u32, bool, Option<u32>, f64, f64)> = Vec::new();
    for (i, frame) in (0..).zip(frames) {
        rows.push((
            i,
            frame.new_place,
            None,
            stored(frame.new_place_log_likelihood),
            stored(frame.new_place_posterior),
        ));
        let candidate = |c: &Candidate| (i, frame.new_place, Some(c.node), c.log_likelihood, stored(c.posterior));
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

/// In the table not a number stands for none.
fn stored(number: Option<f64>) -> f64 {
    number.unwrap_or(f64::NAN)
}

fn from_stored(number: f64) -> Option<f64> {
    Some(number).filter(|number| !number.is_nan())
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
                frame.candidates.push(Candidate {
                    node,
                    log_likelihood: log_likelihood[i],
                    posterior: from_stored(posterior[i]),
                });
            }
            _ => frames.push(FrameMatches {
                new_place: new_place[i],
                new_place_log_likelihood: from_stored(log_likelihood[i]),
                new_place_posterior: from_stored(posterior[i]),
                candidates: Vec::new(),
            }),
        }
    }
    Ok(frames)
}
