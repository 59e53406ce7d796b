//! Live frame by live frame: what was seen, matched and decided.

mod seen;

use super::annotations::{Drawing, LIVE, MATCHED};
use super::camera::Camera;
use super::file::Recording;
use super::localisation::{describe_answers, localisation, log};
use super::message::{GREEN, VERMILION, pose, stamp, transform, world_from_camera};
use super::scene::{LIVE_LEFT, LIVE_ODOMETRY, Scene, WORLD};
use super::tracks::{entity, lines};
use crate::RunError;
use crate::progress::{Counter, Progress, Stage, Subject};
use crate::stages::verifying::{Verifier, Visitor, visit};
use foxglove::messages::line_primitive::Type;
use foxglove::messages::scene_entity_deletion::Type as Deletion;
use foxglove::messages::{FrameTransforms, PoseInFrame, SceneEntityDeletion, SceneUpdate, Timestamp};
use furrow_catalog::Objects;
use furrow_model::Se3;
use seen::{Eyes, Seen};

/// Frames whose images are held at once.
const AT_ONCE: usize = 16;

/// Adds the messages of every live frame, in order.
pub(super) fn write(
    objects: &Objects,
    scene: &Scene,
    recording: &mut Recording<'_>,
    progress: Progress<'_>,
) -> Result<(), RunError> {
    visit(&scene.live.record.rig, scene.features, Writing { objects, scene, recording, progress })
}

/// What [`write`] is asked for.
struct Writing<'a, 'r> {
    objects: &'a Objects,
    scene: &'a Scene,
    recording: &'a mut Recording<'r>,
    progress: Progress<'a>,
}

impl Visitor for Writing<'_, '_> {
    type Output = Result<(), RunError>;

    fn visit(self, verifier: &impl Verifier) -> Self::Output {
        write_by(verifier, self.objects, self.scene, self.recording, self.progress)
    }
}

fn write_by<V: Verifier>(
    verifier: &V,
    objects: &Objects,
    scene: &Scene,
    recording: &mut Recording<'_>,
    progress: Progress<'_>,
) -> Result<(), RunError> {
    let camera = Camera::load(objects, scene.live.record.calibration, LIVE_LEFT.to_owned())?;
    let mut eyes = Eyes::new(verifier, objects, scene, &camera);
    let counter = Counter::new(progress, (Stage::Export, Subject::Whole), scene.answers.len());
    let mut last_m = scene.poses.first().map_or(0.0, |pose| pose.travelled_m);
    for begin in (0..scene.answers.len()).step_by(AT_ONCE) {
        let frames = begin..(begin + AT_ONCE).min(scene.answers.len());
        for (frame, seen) in frames.clone().zip(eyes.look(frames)?) {
            let here_m = scene.poses[frame].travelled_m;
            if scene.answers[frame].accepted().is_some() {
                last_m = here_m;
            }
            images(scene, &camera, frame, seen, recording)?;
            poses(scene, frame, recording)?;
            let stamp_ns = scene.poses[frame].stamp_ns;
            recording.put("/localisation", stamp_ns, &localisation(scene, frame, here_m - last_m)?)?;
            recording.put("/localisation/log", stamp_ns, &log(scene, frame)?)?;
            recording.put("/localisation/scene", stamp_ns, &line(scene, frame)?)?;
            counter.tick();
        }
    }
    Ok(())
}

/// Both images with their cameras, and what is drawn over them.
fn images(
    scene: &Scene,
    camera: &Camera,
    frame: usize,
    seen: Seen,
    recording: &mut Recording<'_>,
) -> Result<(), RunError> {
    let answers = &scene.answers[frame];
    let (stamp_ns, text) = (answers.stamp_ns, describe_answers(scene, answers));
    let drawing = |camera: &Camera, inliers, colour| Drawing {
        stamp_ns,
        height: camera.views().left_camera().0.height,
        inliers,
        colour,
        text: &text,
    };
    let turned = seen.inliers.iter().map(|(live, matched)| (*matched, *live)).collect();
    recording.put("/live/left", stamp_ns, &camera.image(stamp_ns, seen.live)?)?;
    recording.put("/live/calibration", stamp_ns, &camera.calibration(stamp_ns)?)?;
    recording.put("/live/annotations", stamp_ns, &drawing(camera, seen.inliers, LIVE).annotations()?)?;
    let shown = answers.best().map(|best| &scene.members[best.member].camera);
    if let Some((matched, picture)) = shown.zip(seen.matched) {
        recording.put("/match/left", stamp_ns, &matched.image(stamp_ns, picture)?)?;
        recording.put("/match/calibration", stamp_ns, &matched.calibration(stamp_ns)?)?;
    }
    // Without a match the last image stays on the screen: the text says that it is not this frame's.
    recording.put("/match/annotations", stamp_ns, &drawing(shown.unwrap_or(camera), turned, MATCHED).annotations()?)
}

/// Where the live camera is, where the answering node was, and how the frames of reference hang together.
fn poses(scene: &Scene, frame: usize, recording: &mut Recording<'_>) -> Result<(), RunError> {
    let live = &scene.poses[frame];
    let at = stamp(live.stamp_ns)?;
    recording.put("/live/pose", live.stamp_ns, &posed(at, LIVE_ODOMETRY, &live.start_from_here))?;
    if let Some(truth) = scene.truth.as_ref().and_then(|truth| truth.at(live.stamp_ns)) {
        recording.put("/ground_truth/pose", live.stamp_ns, &posed(at, WORLD, &world_from_camera(truth)))?;
    }
    // A player that jumps to a moment reads one message of a topic: what stands still is in each.
    let standing = scene.standing();
    let mut transforms: Vec<_> =
        standing.iter().map(|(parent, child, pose)| transform(at, parent, child, pose)).collect();
    transforms.push(transform(at, LIVE_ODOMETRY, LIVE_LEFT, &live.start_from_here));
    if let Some(best) = scene.answers[frame].best() {
        let member = &scene.members[best.member];
        if let Some(node) = best.node.and_then(|(stamp_ns, _)| member.nodes.get(&stamp_ns)) {
            recording.put("/match/pose", live.stamp_ns, &posed(at, &member.odometry, node))?;
            transforms.push(transform(at, &member.odometry, &member.left, node));
        }
    }
    recording.put("/tf", live.stamp_ns, &FrameTransforms { transforms })
}

fn posed(at: Timestamp, frame: &str, frame_from_here: &Se3) -> PoseInFrame {
    PoseInFrame { timestamp: Some(at), frame_id: frame.to_owned(), pose: Some(pose(frame_from_here)) }
}

/// A line from the live camera to the place that answers; the last one goes where there is none.
fn line(scene: &Scene, frame: usize) -> Result<SceneUpdate, RunError> {
    let answers = &scene.answers[frame];
    let at = stamp(answers.stamp_ns)?;
    let found = answers.best().and_then(|best| scene.line(frame, best));
    Ok(match found {
        Some((reference, ends)) => {
            let colour = if answers.accepted().is_some() { GREEN } else { VERMILION };
            let drawn = entity(at, reference, "match", lines(Type::LineList, ends.into_iter(), colour));
            SceneUpdate { entities: vec![drawn], ..SceneUpdate::default() }
        }
        None => {
            let gone = SceneEntityDeletion {
                timestamp: Some(at),
                r#type: Deletion::All as i32,
                ..SceneEntityDeletion::default()
            };
            SceneUpdate { deletions: vec![gone], ..SceneUpdate::default() }
        }
    })
}
