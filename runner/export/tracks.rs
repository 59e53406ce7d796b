//! Whole tracks, at the first stamp: live, experiences, where they really were, and every localisation between them.

use super::file::Recording;
use super::message::{BLUE, GREEN, GREY, ORANGE, VERMILION, point3, pose, stamp, world_from_camera};
use super::scene::{LIVE_ODOMETRY, Placed, Scene, WORLD};
use crate::RunError;
use crate::evaluate::truth::GroundTruth;
use foxglove::messages::line_primitive::Type;
use foxglove::messages::{Color, LinePrimitive, PosesInFrame, SceneEntity, SceneUpdate, Timestamp};
use furrow_model::Se3;

/// Adds what holds for the whole traversal; nothing where it has no frame.
pub(super) fn write(scene: &Scene, recording: &mut Recording<'_>) -> Result<(), RunError> {
    let Some(first) = scene.poses.first() else { return Ok(()) };
    let at = stamp(first.stamp_ns)?;
    let mut entities = Vec::new();
    for track in tracks(scene) {
        let poses = track.poses.iter().map(pose).collect();
        let message = PosesInFrame { timestamp: Some(at), frame_id: track.frame.to_owned(), poses };
        recording.put(&track.topic, first.stamp_ns, &message)?;
        let points = track.poses.iter().map(|pose| pose.translation_m);
        entities.push(entity(at, track.frame, &track.topic, lines(Type::LineStrip, points, track.colour)));
    }
    for (name, correct, colour) in [("right or unjudged", false, GREEN), ("wrong", true, VERMILION)] {
        for frame in [WORLD, LIVE_ODOMETRY] {
            let accepted = scene.answers.iter().map(|answers| answers.accepted()).enumerate();
            let ends = accepted.filter_map(|(i, place)| Some((i, place?)));
            let ends = ends.filter(|(_, place)| (place.correct == Some(false)) == correct);
            let ends = ends.filter_map(|(i, place)| scene.line(i, place)).filter(|(at, _)| *at == frame);
            let points: Vec<[f64; 3]> = ends.flat_map(|(_, ends)| ends).collect();
            if !points.is_empty() {
                let name = format!("accepted, {name}, in {frame}");
                entities.push(entity(at, frame, &name, lines(Type::LineList, points.into_iter(), colour)));
            }
        }
    }
    recording.put("/tracks", first.stamp_ns, &SceneUpdate { entities, ..SceneUpdate::default() })
}

struct Track<'a> {
    topic: String,
    frame: &'a str,
    poses: Vec<Se3>,
    colour: Color,
}

fn tracks(scene: &Scene) -> Vec<Track<'_>> {
    let live = scene.poses.iter().map(|pose| pose.start_from_here).collect();
    let mut tracks = vec![Track { topic: "/live/track".to_owned(), frame: LIVE_ODOMETRY, poses: live, colour: BLUE }];
    if let Some(truth) = &scene.truth {
        let stamps = scene.poses.iter().map(|pose| pose.stamp_ns);
        tracks.push(true_track("/ground_truth/live".to_owned(), truth, stamps));
    }
    for member in &scene.members {
        tracks.push(Track {
            topic: format!("/experience_{}/track", member.number),
            frame: &member.odometry,
            poses: member.nodes.values().copied().collect(),
            colour: ORANGE,
        });
        if let Placed::Truth { truth, .. } = &member.placed {
            let topic = format!("/ground_truth/experience_{}", member.number);
            tracks.push(true_track(topic, truth, member.nodes.keys().copied()));
        }
    }
    tracks
}

fn true_track<'a>(topic: String, truth: &GroundTruth, stamps_ns: impl Iterator<Item = i64>) -> Track<'a> {
    let poses = stamps_ns.filter_map(|stamp_ns| truth.at(stamp_ns)).map(world_from_camera).collect();
    Track { topic, frame: WORLD, poses, colour: GREY }
}

/// Lines two pixels wide.
pub(super) fn lines(kind: Type, points: impl Iterator<Item = [f64; 3]>, colour: Color) -> LinePrimitive {
    LinePrimitive {
        r#type: kind as i32,
        pose: Some(pose(&Se3::IDENTITY)),
        thickness: 2.0,
        scale_invariant: true,
        points: points.map(point3).collect(),
        color: Some(colour),
        ..LinePrimitive::default()
    }
}

/// Something drawn in a frame of reference until another of its name is.
pub(super) fn entity(at: Timestamp, frame: &str, name: &str, lines: LinePrimitive) -> SceneEntity {
    SceneEntity {
        timestamp: Some(at),
        frame_id: frame.to_owned(),
        id: name.to_owned(),
        lines: vec![lines],
        ..SceneEntity::default()
    }
}
