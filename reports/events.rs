//! The questions that figures ask of a table of events.

use crate::input::{CellInput, ReportError};
use furrow_model::outcome::event;
use polars::prelude::{BooleanChunked, ChunkAgg, ChunkCompareEq, DataFrame, DataType, PolarsError, PolarsResult};

/// An accepted localisation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Accepted {
    pub travelled_m: f64,
    pub inliers: Option<u32>,
    pub correct: Option<bool>,
    pub error_m: Option<f64>,
}

/// A verified candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Verified {
    pub inliers: u32,
    pub correct: Option<bool>,
}

fn of_cell<T>(cell: &CellInput, result: PolarsResult<T>) -> Result<T, ReportError> {
    result.map_err(|source| ReportError::Events { cell: cell.outcome.key, source })
}

/// The rows where `rows` holds, with these columns as these types.
fn select(events: &DataFrame, rows: &BooleanChunked, columns: &[(&str, DataType)]) -> Result<DataFrame, PolarsError> {
    let chosen = events.filter(rows)?;
    let columns =
        columns.iter().map(|(name, kind)| chosen.column(name)?.cast(kind)).collect::<PolarsResult<Vec<_>>>()?;
    DataFrame::new(chosen.height(), columns)
}

/// The cell's localisations, in the order driven.
pub(crate) fn accepted(cell: &CellInput) -> Result<Vec<Accepted>, ReportError> {
    let found = of_cell(cell, read_accepted(&cell.events))?;
    if found.len() != cell.outcome.evaluation.good as usize {
        let (cell, outcome, events) = (cell.outcome.key, cell.outcome.evaluation.good, found.len());
        return Err(ReportError::OtherEvents { cell, outcome, events });
    }
    Ok(found)
}

fn read_accepted(events: &DataFrame) -> PolarsResult<Vec<Accepted>> {
    let columns = [
        (event::TRAVELLED_M, DataType::Float64),
        (event::INLIERS, DataType::UInt32),
        (event::CORRECT, DataType::Boolean),
        (event::ERROR_M, DataType::Float64),
    ];
    let rows = select(events, &events.column(event::DECISION)?.str()?.equal(event::ACCEPTED), &columns)?;
    let inliers = rows.column(event::INLIERS)?.u32()?;
    let correct = rows.column(event::CORRECT)?.bool()?;
    let error_m = rows.column(event::ERROR_M)?.f64()?;
    let travelled = rows.column(event::TRAVELLED_M)?.f64()?;
    let row = |i: usize| {
        let (inliers, correct, error_m) = (inliers.get(i), correct.get(i), error_m.get(i));
        travelled.get(i).map(|travelled_m| Accepted { travelled_m, inliers, correct, error_m })
    };
    Ok((0..rows.height()).filter_map(row).collect())
}

/// Where the live pass was when it was asked: first and last travelled distance in metres; `None` in an empty table.
pub(crate) fn driven_m(cell: &CellInput) -> Result<Option<(f64, f64)>, ReportError> {
    let read = || {
        let travelled = cell.events.column(event::TRAVELLED_M)?.f64()?;
        Ok(travelled.min().zip(travelled.max()))
    };
    of_cell(cell, read())
}

/// Every candidate that was verified, with its inliers.
pub(crate) fn verified(cell: &CellInput) -> Result<Vec<Verified>, ReportError> {
    let read = || {
        let columns = [(event::INLIERS, DataType::UInt32), (event::CORRECT, DataType::Boolean)];
        let rows = select(&cell.events, &cell.events.column(event::INLIERS)?.is_not_null(), &columns)?;
        let correct = rows.column(event::CORRECT)?.bool()?;
        let inliers = rows.column(event::INLIERS)?.u32()?;
        let row = |i: usize| inliers.get(i).map(|inliers| Verified { inliers, correct: correct.get(i) });
        Ok((0..rows.height()).filter_map(row).collect())
    };
    of_cell(cell, read())
}

/// One live frame's best row: the accepted one, or else the verified candidate with most inliers.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FrameRow {
    pub live_stamp_ns: i64,
    pub travelled_m: f64,
    pub live_image: String,
    pub experience: String,
    pub node_stamp_ns: Option<i64>,
    pub node_image: Option<String>,
    pub inliers: Option<u32>,
    pub decision: String,
    pub correct: Option<bool>,
    pub error_m: Option<f64>,
}

/// The accepted and rejected rows, in the order driven.
pub(crate) fn judged(events: &DataFrame) -> PolarsResult<Vec<FrameRow>> {
    let decision = events.column(event::DECISION)?.str()?;
    let judged = decision.equal(event::ACCEPTED) | decision.equal(event::REJECTED);
    let columns = [
        (event::LIVE_STAMP_NS, DataType::Int64),
        (event::TRAVELLED_M, DataType::Float64),
        (event::LIVE_IMAGE, DataType::String),
        (event::EXPERIENCE, DataType::String),
        (event::NODE_STAMP_NS, DataType::Int64),
        (event::NODE_IMAGE, DataType::String),
        (event::INLIERS, DataType::UInt32),
        (event::DECISION, DataType::String),
        (event::CORRECT, DataType::Boolean),
        (event::ERROR_M, DataType::Float64),
    ];
    let rows = select(events, &judged, &columns)?;
    let text = |name: &str, i: usize| -> PolarsResult<Option<String>> {
        Ok(rows.column(name)?.str()?.get(i).map(str::to_owned))
    };
    let row = |i: usize| {
        Ok(FrameRow {
            live_stamp_ns: rows.column(event::LIVE_STAMP_NS)?.i64()?.get(i).unwrap_or_default(),
            travelled_m: rows.column(event::TRAVELLED_M)?.f64()?.get(i).unwrap_or_default(),
            live_image: text(event::LIVE_IMAGE, i)?.unwrap_or_default(),
            experience: text(event::EXPERIENCE, i)?.unwrap_or_default(),
            node_stamp_ns: rows.column(event::NODE_STAMP_NS)?.i64()?.get(i),
            node_image: text(event::NODE_IMAGE, i)?,
            inliers: rows.column(event::INLIERS)?.u32()?.get(i),
            decision: text(event::DECISION, i)?.unwrap_or_default(),
            correct: rows.column(event::CORRECT)?.bool()?.get(i),
            error_m: rows.column(event::ERROR_M)?.f64()?.get(i),
        })
    };
    (0..rows.height()).map(row).collect()
}

/// What became of one live frame: its accepted row, else the row with most inliers, else its first.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FrameFact {
    pub live_stamp_ns: i64,
    pub travelled_m: f64,
    pub node_stamp_ns: Option<i64>,
    pub inliers: Option<u32>,
    pub decision: String,
    pub correct: Option<bool>,
    /// The live frame's true position, metres east and north, where a ground truth tells.
    pub position_m: Option<[f64; 2]>,
}

/// A fact for every live frame, in the order driven.
pub(crate) fn frames(cell: &CellInput) -> Result<Vec<FrameFact>, ReportError> {
    of_cell(cell, read_frames(&cell.events))
}

fn read_frames(events: &DataFrame) -> PolarsResult<Vec<FrameFact>> {
    let column = |name: &str, kind: DataType| events.column(name)?.cast(&kind);
    let (stamp, travelled) =
        (column(event::LIVE_STAMP_NS, DataType::Int64)?, column(event::TRAVELLED_M, DataType::Float64)?);
    let (node, inliers) = (column(event::NODE_STAMP_NS, DataType::Int64)?, column(event::INLIERS, DataType::UInt32)?);
    let (decision, correct) = (column(event::DECISION, DataType::String)?, column(event::CORRECT, DataType::Boolean)?);
    let (stamp, travelled, node) = (stamp.i64()?, travelled.f64()?, node.i64()?);
    let (inliers, decision, correct) = (inliers.u32()?, decision.str()?, correct.bool()?);
    let position = position(events)?;
    let mut facts: Vec<FrameFact> = Vec::new();
    for i in 0..events.height() {
        let Some((live_stamp_ns, travelled_m)) = stamp.get(i).zip(travelled.get(i)) else { continue };
        let fact = FrameFact {
            live_stamp_ns,
            travelled_m,
            node_stamp_ns: node.get(i),
            inliers: inliers.get(i),
            decision: decision.get(i).unwrap_or_default().to_owned(),
            correct: correct.get(i),
            position_m: position.as_ref().and_then(|[east, north]| Some([east[i]?, north[i]?])),
        };
        let weight = |fact: &FrameFact| (fact.decision == event::ACCEPTED, fact.inliers);
        match facts.last_mut().filter(|last| last.live_stamp_ns == live_stamp_ns) {
            Some(last) if weight(&fact) > weight(last) => *last = fact,
            Some(_) => {}
            None => facts.push(fact),
        }
    }
    Ok(facts)
}

/// East and north of every row; none in a table without these columns.
fn position(events: &DataFrame) -> PolarsResult<Option<[Vec<Option<f64>>; 2]>> {
    let column = |name: &str| -> PolarsResult<Vec<Option<f64>>> {
        let values = events.column(name)?.cast(&DataType::Float64)?;
        Ok(values.f64()?.iter().collect())
    };
    if events.column(event::EAST_M).is_err() || events.column(event::NORTH_M).is_err() {
        return Ok(None);
    }
    Ok(Some([column(event::EAST_M)?, column(event::NORTH_M)?]))
}
