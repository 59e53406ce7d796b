//! Tables of events: their rows, and those that figures and pages ask for.

use crate::error::ReportError;
use crate::input::CellInput;
use furrow_model::outcome::event;
use polars::prelude::{
    BooleanChunked, Column, DataFrame, DataType, Float64Chunked, Int64Chunked, PolarsResult, StringChunked,
    UInt32Chunked,
};

/// A table of events by column; [`event`] says what each holds.
pub(crate) struct Events {
    live_stamp_ns: Int64Chunked,
    travelled_m: Float64Chunked,
    live_image: StringChunked,
    experience: StringChunked,
    node_stamp_ns: Int64Chunked,
    node_image: StringChunked,
    inliers: UInt32Chunked,
    decision: StringChunked,
    correct: BooleanChunked,
    error_m: Float64Chunked,
}

/// One row: a live frame and a candidate, or a new place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct EventRow<'t> {
    pub live_stamp_ns: i64,
    pub travelled_m: f64,
    pub live_image: &'t str,
    pub experience: &'t str,
    pub node_stamp_ns: Option<i64>,
    pub node_image: Option<&'t str>,
    pub inliers: Option<u32>,
    pub decision: &'t str,
    pub correct: Option<bool>,
    pub error_m: Option<f64>,
}

impl EventRow<'_> {
    pub fn is_accepted(&self) -> bool {
        self.decision == event::ACCEPTED
    }

    /// Orders a frame's rows: the accepted one first, then by inliers.
    pub fn rank(&self) -> (bool, Option<u32>) {
        (self.is_accepted(), self.inliers)
    }
}

impl Events {
    /// The columns of a table.
    pub fn read(table: &DataFrame) -> PolarsResult<Self> {
        let column = |name: &str, kind: DataType| -> PolarsResult<Column> { table.column(name)?.cast(&kind) };
        let text = |name: &str| -> PolarsResult<StringChunked> { Ok(column(name, DataType::String)?.str()?.clone()) };
        let real = |name: &str| -> PolarsResult<Float64Chunked> { Ok(column(name, DataType::Float64)?.f64()?.clone()) };
        let stamp = |name: &str| -> PolarsResult<Int64Chunked> { Ok(column(name, DataType::Int64)?.i64()?.clone()) };
        Ok(Self {
            live_stamp_ns: stamp(event::LIVE_STAMP_NS)?,
            travelled_m: real(event::TRAVELLED_M)?,
            live_image: text(event::LIVE_IMAGE)?,
            experience: text(event::EXPERIENCE)?,
            node_stamp_ns: stamp(event::NODE_STAMP_NS)?,
            node_image: text(event::NODE_IMAGE)?,
            inliers: column(event::INLIERS, DataType::UInt32)?.u32()?.clone(),
            decision: text(event::DECISION)?,
            correct: column(event::CORRECT, DataType::Boolean)?.bool()?.clone(),
            error_m: real(event::ERROR_M)?,
        })
    }

    /// The events of a cell; an error where they are not those that its outcome counted.
    pub fn of(cell: &CellInput) -> Result<Self, ReportError> {
        let wrong_table = |source| ReportError::Events { cell: cell.outcome.key, source };
        let events = Self::read(&cell.events).map_err(wrong_table)?;
        let (accepted, good) = (events.accepted().count(), cell.outcome.evaluation.good);
        if accepted != good as usize {
            return Err(ReportError::OtherEvents { cell: cell.outcome.key, outcome: good, events: accepted });
        }
        Ok(events)
    }

    /// All rows, in order of frame; rows without a stamp or distance are skipped.
    pub fn rows(&self) -> impl Iterator<Item = EventRow<'_>> {
        (0..self.decision.len()).filter_map(|i| self.row(i))
    }

    fn row(&self, i: usize) -> Option<EventRow<'_>> {
        Some(EventRow {
            live_stamp_ns: self.live_stamp_ns.get(i)?,
            travelled_m: self.travelled_m.get(i)?,
            live_image: self.live_image.get(i).unwrap_or(""),
            experience: self.experience.get(i).unwrap_or(""),
            node_stamp_ns: self.node_stamp_ns.get(i),
            node_image: self.node_image.get(i),
            inliers: self.inliers.get(i),
            decision: self.decision.get(i).unwrap_or(""),
            correct: self.correct.get(i),
            error_m: self.error_m.get(i),
        })
    }

    /// The localisations.
    pub fn accepted(&self) -> impl Iterator<Item = EventRow<'_>> {
        self.decided(&[event::ACCEPTED])
    }

    /// The accepted and the rejected.
    pub fn judged(&self) -> impl Iterator<Item = EventRow<'_>> {
        self.decided(&[event::ACCEPTED, event::REJECTED])
    }

    fn decided(&self, wanted: &'static [&'static str]) -> impl Iterator<Item = EventRow<'_>> {
        let is_wanted = |decision: Option<&str>| decision.is_some_and(|decision| wanted.contains(&decision));
        let rows = self.decision.iter().enumerate().filter(move |(_, decision)| is_wanted(*decision));
        rows.filter_map(|(i, _)| self.row(i))
    }

    /// Every candidate that was verified: its inliers, and whether it is right.
    pub fn verified(&self) -> impl Iterator<Item = (u32, Option<bool>)> {
        self.inliers.iter().zip(self.correct.iter()).filter_map(|(inliers, correct)| Some((inliers?, correct)))
    }

    /// The row of highest rank for each live frame, the first among equals.
    pub fn best_of_each_frame(&self) -> Vec<EventRow<'_>> {
        let mut best: Vec<EventRow<'_>> = Vec::new();
        for row in self.rows() {
            match best.last_mut().filter(|last| last.live_stamp_ns == row.live_stamp_ns) {
                Some(last) if row.rank() > last.rank() => *last = row,
                Some(_) => {}
                None => best.push(row),
            }
        }
        best
    }

    /// Distance travelled at the first and the last live frame, metres; none in an empty table.
    pub fn travelled_range_m(&self) -> Option<(f64, f64)> {
        let metres = || self.travelled_m.iter().flatten();
        metres().reduce(f64::min).zip(metres().reduce(f64::max))
    }
}
