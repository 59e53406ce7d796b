//! What the page's own script knows: which cells there are, and the facts of every live frame.

use crate::error::ReportError;
use crate::figures::arrange::Setting;
use crate::figures::events::{EventRow, Events};
use crate::input::CellInput;
use crate::wording::{self, thousandths};
use furrow_model::outcome::event;
use serde::Serialize;
use std::collections::BTreeMap;

/// Frames of all cells together whose facts a page carries, in the order of its cells; about ten bytes each.
const FRAMES_AT_MOST: usize = 40_000;

/// All of it, as JSON in the page.
#[derive(Serialize)]
pub(super) struct PageData {
    cells: Vec<CellData>,
    traversals: Vec<TraversalData>,
    /// Stamps of nodes, ns as text, since they do not fit a JavaScript number.
    nodes: Vec<String>,
    decisions: [&'static str; 7],
}

#[derive(Serialize)]
struct CellData {
    id: String,
    live: String,
    experience: String,
    setting: String,
    threshold: u32,
    traversal: Option<usize>,
    frames: Option<FrameData>,
    /// Lost stretches: metres travelled where each begins and ends.
    lost: Vec<[f64; 2]>,
}

/// When and where the frames of a live traversal were taken.
#[derive(Serialize, PartialEq)]
struct TraversalData {
    first_ns: String,
    after_ns: Vec<i64>,
    metres: Vec<f64>,
}

/// One entry per frame of the traversal.
#[derive(Serialize, Default)]
struct FrameData {
    inliers: Vec<Option<u32>>,
    /// Indices into `decisions`, a digit each.
    decision: String,
    /// `1` right, `0` wrong, `-` not judged.
    correct: String,
    /// Indices into `nodes`.
    node: Vec<Option<usize>>,
}

const DECISIONS: [&str; 7] = [
    event::ACCEPTED,
    event::REJECTED,
    event::NEW_PLACE,
    event::OUTVOTED,
    event::ALONE,
    event::OVERRULED,
    event::NOT_VERIFIED,
];

/// Collects the facts of all cells, of as many frames as a page can carry.
pub(super) fn page_data(settings: &[Setting<'_>]) -> Result<PageData, ReportError> {
    let mut data = PageData { cells: Vec::new(), traversals: Vec::new(), nodes: Vec::new(), decisions: DECISIONS };
    let mut nodes = BTreeMap::new();
    let mut room = FRAMES_AT_MOST;
    for setting in settings {
        for (row, column, cell) in setting.places() {
            let outcome = &cell.outcome;
            let events = events_within(cell, &mut room)?;
            let frames = events.as_ref().map(Events::best_of_each_frame);
            let traversal = frames.as_deref().and_then(|frames| data.traversal(frames));
            let lost = outcome.evaluation.lost.stretches.iter().filter(|_| traversal.is_some());
            data.cells.push(CellData {
                id: outcome.key.short(),
                live: row.label.clone(),
                experience: column.label.clone(),
                setting: wording::shown(&setting.title),
                threshold: outcome.threshold_inliers,
                traversal,
                frames: frames.as_deref().map(|frames| frame_data(frames, &mut nodes)),
                lost: lost.map(|stretch| [thousandths(stretch.from_m), thousandths(stretch.to_m)]).collect(),
            });
        }
    }
    let mut stamps: Vec<(usize, String)> =
        nodes.into_iter().map(|(stamp, at): (i64, usize)| (at, stamp.to_string())).collect();
    stamps.sort_unstable();
    data.nodes = stamps.into_iter().map(|(_, stamp)| stamp).collect();
    Ok(data)
}

fn events_within(cell: &CellInput, room: &mut usize) -> Result<Option<Events>, ReportError> {
    let frames = cell.outcome.evaluation.frames as usize;
    if frames > *room {
        return Ok(None);
    }
    *room -= frames;
    Events::of(cell).map(Some)
}

impl PageData {
    /// The traversal with these frames, entered where it is new; none without frames.
    fn traversal(&mut self, frames: &[EventRow<'_>]) -> Option<usize> {
        let first = frames.first()?.live_stamp_ns;
        let traversal = TraversalData {
            first_ns: first.to_string(),
            after_ns: frames.iter().map(|frame| frame.live_stamp_ns.wrapping_sub(first)).collect(),
            metres: frames.iter().map(|frame| thousandths(frame.travelled_m)).collect(),
        };
        let known = self.traversals.iter().position(|other| *other == traversal);
        Some(known.unwrap_or_else(|| {
            self.traversals.push(traversal);
            self.traversals.len() - 1
        }))
    }
}

fn frame_data(frames: &[EventRow<'_>], nodes: &mut BTreeMap<i64, usize>) -> FrameData {
    let mut data = FrameData::default();
    for frame in frames {
        let next = nodes.len();
        data.inliers.push(frame.inliers);
        data.node.push(frame.node_stamp_ns.map(|stamp| *nodes.entry(stamp).or_insert(next)));
        let decision = DECISIONS.iter().position(|decision| *decision == frame.decision).unwrap_or(DECISIONS.len() - 1);
        data.decision.push_str(&decision.to_string());
        data.correct.push(match frame.correct {
            Some(true) => '1',
            Some(false) => '0',
            None => '-',
        });
    }
    data
}
