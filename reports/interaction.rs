//! What the page's own script knows: which cells there are, and the facts of every live frame.
//!
//! The script itself is `templates/page/*.js`, inlined once. It only shows what is here and in the figures, and sends nothing anywhere.

use crate::arrange::Setting;
use crate::events::{self, FrameFact};
use crate::input::{CellInput, ReportError};
use crate::wording;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use furrow_model::outcome::event;
use serde::Serialize;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

const SOURCE: &str = concat!(
    "(() => {\n'use strict';\n",
    include_str!("templates/page/base.js"),
    include_str!("templates/page/tips.js"),
    include_str!("templates/page/zoom.js"),
    include_str!("templates/page/filter.js"),
    include_str!("templates/page/frames.js"),
    "})();\n"
);

/// Frames of all cells together whose facts a page carries, in the order of its cells; about ten bytes each.
const FRAMES_AT_MOST: usize = 40_000;

/// The page's script: `templates/page/*.js` without indentation and comments.
pub(crate) fn script() -> String {
    let kept = |line: &&str| !line.is_empty() && !line.starts_with("//");
    SOURCE.lines().map(str::trim_start).filter(kept).flat_map(|line| [line, "\n"]).collect()
}

/// The source of a script as the page's policy allows it, by its digest: no other script runs.
pub(crate) fn source_of(script: &str) -> String {
    format!("'sha256-{}'", STANDARD.encode(Sha256::digest(script)))
}

/// All of it, as JSON in the page.
#[derive(Serialize)]
pub(crate) struct PageData {
    cells: Vec<CellData>,
    passes: Vec<PassData>,
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
    pass: Option<usize>,
    frames: Option<FrameData>,
    /// Lost stretches: metres driven where each begins and ends.
    lost: Vec<[f64; 2]>,
}

/// When and where the frames of a live pass were taken.
#[derive(Serialize, PartialEq)]
struct PassData {
    first_ns: String,
    after_ns: Vec<i64>,
    metres: Vec<f64>,
}

/// One entry per frame of the pass.
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
pub(crate) fn page_data(settings: &[Setting<'_>]) -> Result<PageData, ReportError> {
    let mut data = PageData { cells: Vec::new(), passes: Vec::new(), nodes: Vec::new(), decisions: DECISIONS };
    let mut nodes = BTreeMap::new();
    let mut room = FRAMES_AT_MOST;
    for setting in settings {
        for row in &setting.rows {
            for (column, cell) in setting.columns.iter().zip(&row.cells) {
                let Some(cell) = cell else { continue };
                let facts = facts_within(cell, &mut room)?;
                let outcome = &cell.outcome;
                let pass = facts.as_deref().and_then(|facts| data.pass(facts));
                let lost =
                    outcome.evaluation.lost.stretches.iter().map(|s| [thousandths(s.from_m), thousandths(s.to_m)]);
                data.cells.push(CellData {
                    id: outcome.key.short(),
                    live: row.label.clone(),
                    experience: column.label.clone(),
                    setting: wording::shown(&setting.title),
                    threshold: outcome.threshold_inliers,
                    pass,
                    frames: facts.as_deref().map(|facts| frame_data(facts, &mut nodes)),
                    lost: if pass.is_some() { lost.collect() } else { Vec::new() },
                });
            }
        }
    }
    let mut stamps: Vec<(usize, String)> =
        nodes.into_iter().map(|(stamp, at): (i64, usize)| (at, stamp.to_string())).collect();
    stamps.sort_unstable();
    data.nodes = stamps.into_iter().map(|(_, stamp)| stamp).collect();
    Ok(data)
}

fn facts_within(cell: &CellInput, room: &mut usize) -> Result<Option<Vec<FrameFact>>, ReportError> {
    let frames = cell.outcome.evaluation.frames as usize;
    if frames > *room {
        return Ok(None);
    }
    *room -= frames;
    events::frames(cell).map(Some)
}

impl PageData {
    /// The pass with these frames, entered where it is new; none without frames.
    fn pass(&mut self, facts: &[FrameFact]) -> Option<usize> {
        let first = facts.first()?.live_stamp_ns;
        let pass = PassData {
            first_ns: first.to_string(),
            after_ns: facts.iter().map(|fact| fact.live_stamp_ns.wrapping_sub(first)).collect(),
            metres: facts.iter().map(|fact| thousandths(fact.travelled_m)).collect(),
        };
        let known = self.passes.iter().position(|other| *other == pass);
        Some(known.unwrap_or_else(|| {
            self.passes.push(pass);
            self.passes.len() - 1
        }))
    }
}

fn frame_data(facts: &[FrameFact], nodes: &mut BTreeMap<i64, usize>) -> FrameData {
    let mut data = FrameData::default();
    for fact in facts {
        let next = nodes.len();
        data.inliers.push(fact.inliers);
        data.node.push(fact.node_stamp_ns.map(|stamp| *nodes.entry(stamp).or_insert(next)));
        let decision = DECISIONS.iter().position(|decision| *decision == fact.decision).unwrap_or(DECISIONS.len() - 1);
        data.decision.push_str(&decision.to_string());
        data.correct.push(match fact.correct {
            Some(true) => '1',
            Some(false) => '0',
            None => '-',
        });
    }
    data
}

/// Metres to the millimetre.
fn thousandths(metres: f64) -> f64 {
    (metres * 1000.0).round() / 1000.0
}
