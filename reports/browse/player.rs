//! What a traversal's page asks for while someone scrubs: positions, keypoints, matches.

use super::error::BrowseError;
use super::insight::ViewPoint;
use super::map::Canvas;
use super::reply::Reply;
use super::store::Store;
use super::track::Track;
use crate::wording::thousandths;
use furrow_catalog::records::TraversalRecord;
use furrow_catalog::tables::Frame;
use furrow_model::{ObjectId, Step};
use serde_json::{Value, json};

/// Of every frame: seconds since the first, metres travelled, place on the page's map, inliers of the step that leads
/// there, and the keyframe before.
pub(super) fn track(store: &Store, id: String) -> Result<Reply, BrowseError> {
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
    let steps = |value: fn(&Step) -> Value| -> Vec<Value> {
        std::iter::once(Value::Null).chain(chain.steps.iter().map(value)).collect()
    };
    let keyframes = record.keyframes.keyframes(&chain);
    Ok(Reply::json(&json!({
        "stamps_ns": stamps,
        "seconds": seconds,
        "travelled_m": travelled,
        "at": at,
        "inliers": steps(|step| step.inliers.into()),
        "valid": steps(|step| step.valid.into()),
        "before": before_each(&keyframes, frames.len()),
    })))
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
pub(super) fn keypoints(store: &Store, (id, frame): (String, String)) -> Result<Reply, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let at = ViewPoint { traversal: &record, frame: &frames[frame_number(&frame, frames.len())?] };
    let points = store.insight.keypoints(store.objects(), at)?;
    let points: Vec<[f64; 3]> = points.iter().map(|point| point.map(|value| thousandths(f64::from(value)))).collect();
    Ok(Reply::json(&json!({ "keypoints": points })))
}

/// What a frame and the keyframe before it have in common.
pub(super) fn before(store: &Store, (id, frame): (String, String)) -> Result<Reply, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let number = frame_number(&frame, frames.len())?;
    let keyframes = record.keyframes.keyframes(&*store.chain(record.chain)?);
    let before = before_each(&keyframes, frames.len())[number];
    let keyframe = before.and_then(|keyframe| frames.get(keyframe));
    let image = keyframe.ok_or_else(|| BrowseError::not_here("keyframe before frame", &frame))?.left;
    agreement(store, (&record, &frames[number]), image, record.calibration)
}

/// What a frame and a node of an experience have in common.
pub(super) fn matches(
    store: &Store,
    (id, frame, experience, node): (String, String, String, String),
) -> Result<Reply, BrowseError> {
    let record = store.record(&id)?;
    let frames = store.frames(&record)?;
    let (_, experience) = store.experience(&experience)?;
    let found = node.parse::<usize>().ok().and_then(|node| experience.nodes.get(node));
    let image = found.ok_or_else(|| BrowseError::not_here("node", &node))?.left;
    agreement(store, (&record, &frames[frame_number(&frame, frames.len())?]), image, experience.calibration)
}

fn agreement(
    store: &Store,
    (traversal, frame): (&TraversalRecord, &Frame),
    image: ObjectId,
    calibration: ObjectId,
) -> Result<Reply, BrowseError> {
    let found = store.insight.agreement(store.objects(), ViewPoint { traversal, frame }, image, calibration)?;
    let short = |[x, y]: [f32; 2]| [thousandths(f64::from(x)), thousandths(f64::from(y))];
    let lines: Vec<[[f64; 2]; 2]> = found.lines.iter().map(|(a, b)| [short(*a), short(*b)]).collect();
    Ok(Reply::json(&json!({ "matches": found.matches, "lines": lines })))
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
