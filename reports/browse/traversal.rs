//! A traversal: player, what ingest found, and where its bytes come from.

use super::error::BrowseError;
use super::facts::{Fact, facts, health, objects};
use super::map::{Canvas, Line, Map, dash};
use super::places::{site_key, tones};
use super::reply::Reply;
use super::store::Store;
use super::track::Track;
use crate::wording::{self, bytes};
use furrow_catalog::Catalog;
use furrow_catalog::records::TraversalRecord;
use furrow_model::{Outcome, TraversalId};
use serde::Serialize;

/// Runs that are searched for answers to this traversal, the latest first, and answers that are offered.
const RUNS: usize = 10;
const ANSWERS: usize = 40;
/// Frames without a partner that are named.
const NAMED: usize = 12;

#[derive(Serialize)]
struct View {
    id: String,
    short: String,
    site: String,
    site_key: String,
    route: String,
    slot: String,
    purpose: String,
    day: String,
    frames: usize,
    middle: usize,
    width: u32,
    height: u32,
    has_right: bool,
    map: Map,
    answers: Vec<AnswerLine>,
    facts: Vec<Fact>,
    health: Vec<Fact>,
    unpaired: Vec<String>,
    more_unpaired: usize,
    experience: Option<(String, String)>,
    recording: Option<RecordingView>,
    objects: Vec<Fact>,
}

/// A run's cell whose live traversal this is.
#[derive(Serialize)]
struct AnswerLine {
    cell: String,
    label: String,
}

#[derive(Serialize)]
struct RecordingView {
    id: String,
    name: String,
    bytes: String,
    parts: Vec<(String, String, String)>,
}

pub(super) fn page(store: &Store, typed: String) -> Result<Reply, BrowseError> {
    let catalog = store.catalog()?;
    let (id, record) = store.traversal(&catalog, &typed)?;
    let frames = store.frames(&record)?;
    let first = frames.first().map(|frame| frame.stamp_ns);
    let recording = catalog.recording(record.recording)?.map(|row| RecordingView {
        id: row.id.to_string(),
        name: wording::shown(&row.name),
        bytes: bytes(row.bytes),
        parts: row
            .parts
            .iter()
            .map(|part| (wording::shown(&part.name), bytes(part.bytes), part.digest.to_string()))
            .collect(),
    });
    let names = record.unpaired.iter().take(NAMED);
    let view = View {
        id: id.to_string(),
        short: id.short(),
        site: wording::shown(&record.site),
        site_key: site_key(&record.site),
        route: wording::shown(&record.route),
        slot: record.slot.to_string(),
        purpose: record.purpose.to_string(),
        day: first.map_or(Ok("–".to_owned()), |stamp| store.insight.day(&catalog, &record, stamp))?,
        frames: frames.len(),
        middle: frames.len() / 2,
        width: record.rig.width,
        height: record.rig.height,
        has_right: frames.first().is_some_and(|frame| frame.right.is_some()),
        map: map(store, &catalog, &record)?,
        answers: answers(&catalog, id, &record)?,
        facts: facts(&record, frames.first().zip(frames.last()).map(|(a, b)| (b.stamp_ns - a.stamp_ns) as f64 * 1e-9)),
        health: health(store, &record)?,
        unpaired: names
            .map(|one| format!("{} ns: only the {} image", one.stamp_ns, wording::shown(&one.side)))
            .collect(),
        more_unpaired: record.unpaired.len().saturating_sub(NAMED),
        experience: record.experience.map(|id| (id.to_string(), id.short())),
        recording,
        objects: objects(&record),
    };
    store.render("traversal.html", view)
}

fn map(store: &Store, catalog: &Catalog, record: &TraversalRecord) -> Result<Map, BrowseError> {
    let track = Track::of(store, record, None)?;
    let canvas = Canvas::around(track.points.iter().flatten());
    let line = Line {
        d: canvas.path(&track.points),
        tone: tones(&catalog.places()?).of(record.slot).class,
        dash: dash(record.purpose),
        start: track.points.iter().flatten().next().map(|point| canvas.at(*point)),
        traversal: None,
        title: format!("Track of this traversal, {} metres", wording::tenths(record.counts.length_m)),
    };
    Ok(canvas.map("Track of this traversal".to_owned(), track.caption(), track.is_true(), vec![line]))
}

/// Cells of the latest runs whose live traversal this is.
fn answers(catalog: &Catalog, id: TraversalId, record: &TraversalRecord) -> Result<Vec<AnswerLine>, BrowseError> {
    let mut lines: Vec<AnswerLine> = Vec::new();
    for row in catalog.runs()?.iter().rev().take(RUNS) {
        let run = catalog.run(row.id)?;
        if !run.traversals.is_empty() && !run.traversals.contains(&id) {
            continue;
        }
        for cell in run.cells.iter().filter(|cell| cell.live == record.slot) {
            if lines.len() == ANSWERS {
                return Ok(lines);
            }
            let known = lines.iter().any(|line| line.cell == cell.key.to_string());
            let Some(outcome) = (if known { None } else { catalog.outcome(cell.key)? }) else { continue };
            if outcome.live_traversal == id {
                lines.push(AnswerLine {
                    cell: cell.key.to_string(),
                    label: label(&run.name, &outcome.named(&cell.experience), &cell.setting),
                });
            }
        }
    }
    Ok(lines)
}

fn label(run: &str, outcome: &Outcome, setting: &str) -> String {
    let setting = if setting.is_empty() { String::new() } else { format!(" [{}]", wording::shown(setting)) };
    let (run, against) = (wording::shown(run), wording::shown(&outcome.experience));
    format!("{run}: against {against}{setting}, {} of {} localised", outcome.evaluation.good, outcome.evaluation.frames)
}
