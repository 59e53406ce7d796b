//! What an outing's page asks for while someone scrubs.

use crate::browse::BrowseError;
use crate::browse::answer::Answer;
use crate::browse::insight::ViewPoint;
use crate::browse::map::Canvas;
use crate::browse::store::Store;
use crate::browse::track::Track;
use crate::wording;
use furrow_catalog::records::TraversalRecord;
use furrow_catalog::{Catalog, CatalogError, tables};
use furrow_model::outcome::event;
use furrow_model::{CellKey, ExperienceId, ObjectId, Outcome, TraversalId};
use polars::prelude::DataFrame;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Of every frame: seconds since the first, metres travelled, place on the page's map, inliers of the step that leads there, and the keyframe before.
pub(crate) fn track(store: &Store, id: String) -> Result<Answer, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let chain = store.chain(record.chain)?;
    let track = Track::of(store, &record, None)?;
    let canvas = Canvas::around(track.points.iter().flatten());
    let first = frames.first().map_or(0, |frame| frame.stamp_ns);
    let seconds: Vec<f64> = frames.iter().map(|frame| thousandths((frame.stamp_ns - first) as f64 * 1e-9)).collect();
    let stamps: Vec<String> = frames.iter().map(|frame| frame.stamp_ns.to_string()).collect();
    let travelled: Vec<f64> = chain.poses().iter().map(|pose| thousandths(pose.travelled_m)).collect();
    let at: Vec<Option<[f64; 2]>> = track.points.iter().map(|point| point.map(|point| canvas.at(point))).collect();
    let steps = |of: fn(&furrow_model::Step) -> Value| -> Vec<Value> {
        std::iter::once(Value::Null).chain(chain.steps.iter().map(of)).collect()
    };
    let keyframes = record.keyframes.keyframes(&chain);
    Ok(Answer::json(&json!({
        "stamps_ns": stamps,
        "seconds": seconds,
        "travelled_m": travelled,
        "at": at,
        "inliers": steps(|step| step.inliers.into()),
        "valid": steps(|step| step.valid.into()),
        "before": before_each(&keyframes, frames.len()),
    })))
}

fn thousandths(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}

/// The keyframe before each frame; the first has none.
fn before_each(keyframes: &[usize], frames: usize) -> Vec<Option<usize>> {
    (0..frames).map(|frame| keyframes[..keyframes.partition_point(|key| *key < frame)].last().copied()).collect()
}

fn frame_number(typed: &str, frames: usize) -> Result<usize, BrowseError> {
    let inside = |number: &usize| *number < frames;
    typed.parse().ok().filter(inside).ok_or_else(|| BrowseError::not_here("frame", typed))
}

/// The keypoints of a frame: x, y and radius, as fractions.
pub(crate) fn keypoints(store: &Store, (id, frame): (String, String)) -> Result<Answer, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let at = ViewPoint { pass: &record, frame: &frames[frame_number(&frame, frames.len())?] };
    let points = store.insight.keypoints(store.objects(), at)?;
    let points: Vec<[f64; 3]> = points.iter().map(|point| point.map(|value| thousandths(f64::from(value)))).collect();
    Ok(Answer::json(&json!({ "keypoints": points })))
}

/// What a frame and the keyframe before it have in common.
pub(crate) fn before(store: &Store, (id, frame): (String, String)) -> Result<Answer, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let number = frame_number(&frame, frames.len())?;
    let keyframes = record.keyframes.keyframes(&*store.chain(record.chain)?);
    let before = before_each(&keyframes, frames.len())[number];
    let keyframe = before.and_then(|keyframe| frames.get(keyframe));
    let place = keyframe.ok_or_else(|| BrowseError::not_here("keyframe before frame", &frame))?.left;
    agreement(store, (&record, &frames[number]), place, record.calibration)
}

/// What a frame and a place of an experience have in common.
pub(crate) fn matches(
    store: &Store,
    (id, frame, experience, node): (String, String, String, String),
) -> Result<Answer, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let (_, experience) = store.experience(&experience)?;
    let place = node.parse::<usize>().ok().and_then(|node| experience.nodes.get(node));
    let place = place.ok_or_else(|| BrowseError::not_here("place", &node))?;
    agreement(store, (&record, &frames[frame_number(&frame, frames.len())?]), place.left, experience.calibration)
}

fn agreement(
    store: &Store,
    (pass, frame): (&TraversalRecord, &tables::Frame),
    place: ObjectId,
    calibration: ObjectId,
) -> Result<Answer, BrowseError> {
    let found = store.insight.agreement(store.objects(), ViewPoint { pass, frame }, place, calibration)?;
    let short = |[x, y]: [f32; 2]| [thousandths(f64::from(x)), thousandths(f64::from(y))];
    let lines: Vec<[[f64; 2]; 2]> = found.lines.iter().map(|(a, b)| [short(*a), short(*b)]).collect();
    Ok(Answer::json(&json!({ "matches": found.matches, "lines": lines })))
}

/// What a cell of a run answered for each frame of its live pass.
pub(crate) fn answers(store: &Store, (id, cell): (String, String)) -> Result<Answer, BrowseError> {
    let record = store.record(&id)?;
    let unknown = || BrowseError::not_here("answer of a run to this outing", &cell);
    let key: CellKey = cell.parse().map_err(|_| unknown())?;
    let pass: TraversalId = id.parse().map_err(|_| unknown())?;
    let catalog: Catalog = store.catalog()?;
    let outcome = catalog.outcome(key)?.filter(|outcome| outcome.live_traversal == pass).ok_or_else(unknown)?;
    let events = tables::from_parquet("events", store.objects().read(outcome.events)?)?;
    let best = best_of_each(&events)?;
    let mut answers = Vec::new();
    for frame in store.frames(&record)?.iter() {
        answers.push(match best.get(&frame.stamp_ns) {
            None => Value::Null,
            Some(answer) => told(store, &outcome, answer)?,
        });
    }
    Ok(Answer::json(&json!({ "answers": answers })))
}

/// A row of the table of events.
struct Event {
    experience: String,
    node_stamp_ns: Option<i64>,
    inliers: Option<u32>,
    decision: String,
    correct: Option<bool>,
    error_m: Option<f64>,
}

impl Event {
    /// What is shown of a frame: what was accepted, else the candidate with most inliers, else any.
    fn rank(&self) -> (bool, Option<u32>) {
        (self.decision == event::ACCEPTED, self.inliers)
    }
}

fn best_of_each(table: &DataFrame) -> Result<BTreeMap<i64, Event>, CatalogError> {
    let wrong = |name: &'static str| CatalogError::table(name);
    let text = |name: &'static str| table.column(name).and_then(|column| column.str().cloned()).map_err(wrong(name));
    let stamps = tables::i64s(table, event::LIVE_STAMP_NS)?;
    let (experience, decision) = (text(event::EXPERIENCE)?, text(event::DECISION)?);
    let node =
        table.column(event::NODE_STAMP_NS).and_then(|c| c.i64().cloned()).map_err(wrong(event::NODE_STAMP_NS))?;
    let inliers = tables::optional_u32s(table, event::INLIERS)?;
    let error_m = tables::optional_f64s(table, event::ERROR_M)?;
    let correct = table.column(event::CORRECT).and_then(|c| c.bool().cloned()).map_err(wrong(event::CORRECT))?;
    let mut best: BTreeMap<i64, Event> = BTreeMap::new();
    for (row, stamp_ns) in stamps.into_iter().enumerate() {
        let event = Event {
            experience: experience.get(row).unwrap_or_default().to_owned(),
            node_stamp_ns: node.get(row),
            inliers: inliers[row],
            decision: decision.get(row).unwrap_or_default().to_owned(),
            correct: correct.get(row),
            error_m: error_m[row],
        };
        if best.get(&stamp_ns).is_none_or(|known| event.rank() > known.rank()) {
            best.insert(stamp_ns, event);
        }
    }
    Ok(best)
}

fn told(store: &Store, outcome: &Outcome, answer: &Event) -> Result<Value, BrowseError> {
    let member = outcome.members.iter().find(|member| member.id.to_string() == answer.experience);
    let mut words = vec![answer.decision.clone()];
    words.extend(answer.inliers.map(|inliers| format!("{inliers} inliers of {} needed", outcome.threshold_inliers)));
    words.extend(answer.correct.map(|correct| if correct { "right".to_owned() } else { "wrong".to_owned() }));
    words.extend(answer.error_m.map(|error| format!("{error:.1} m off")));
    words.extend(member.map(|member| format!("experience of {}", member.slot)));
    let node = match (answer.node_stamp_ns, member) {
        (Some(stamp_ns), Some(member)) => node_of(store, member.id, stamp_ns)?,
        _ => None,
    };
    Ok(json!({
        "experience": member.map(|member| member.id.to_string()),
        "node": node,
        "text": wording::shown(&words.join(", ")),
        "accepted": answer.decision == event::ACCEPTED,
    }))
}

/// Which place of an experience has a stamp.
fn node_of(store: &Store, experience: ExperienceId, stamp_ns: i64) -> Result<Option<usize>, BrowseError> {
    let (_, record) = store.experience(&experience.to_string())?;
    Ok(record.nodes.binary_search_by_key(&stamp_ns, |node| node.stamp_ns).ok())
}

#[cfg(test)]
mod tests {
    use super::before_each;

    #[test]
    fn the_keyframe_before_is_never_the_frame_itself() {
        assert_eq!(before_each(&[0, 3, 5], 7), [None, Some(0), Some(0), Some(0), Some(3), Some(3), Some(5)]);
        assert_eq!(before_each(&[], 2), [None, None]);
    }
}
