//! A dataset and its profile as a request: what the profile tells takes the place of what a user would have to say.

use crate::import::{ImportedTruth, Profile, resolve_layout, resolve_recording, tum_text};
use crate::traversal::error::IngestError;
use crate::traversal::motion::MotionSource;
use crate::traversal::request::{Imported, IngestRequest};
use furrow_catalog::records::Cameras;
use furrow_model::Se3;
use furrow_model::truth::between;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The request that ingests the dataset at `path`, laid out as `profile`, called `name`, says. `asked` is what the user
/// asks; its files are left out of account. What a user says of topics, calibration, true poses and motion goes before
/// the profile. Texts that the ingest reads as files are written into `scratch`, which has to last as long as it.
///
/// # Errors
/// [`IngestError::Import`] where the dataset does not fit the profile.
pub fn request_of_dataset(
    name: &str,
    profile: &Profile,
    path: &Path,
    asked: IngestRequest,
    scratch: &Path,
) -> Result<IngestRequest, IngestError> {
    if profile.images.is_some() {
        request_of_images(name, profile, path, asked, scratch)
    } else {
        request_of_bags(name, profile, path, asked, scratch)
    }
}

fn request_of_images(
    name: &str,
    profile: &Profile,
    path: &Path,
    asked: IngestRequest,
    scratch: &Path,
) -> Result<IngestRequest, IngestError> {
    let topics = [&asked.left, &asked.right, &asked.left_info, &asked.right_info];
    if topics.iter().any(|topic| topic.is_some()) {
        return Err(IngestError::Request(format!("profile {name} is for loose images, which have no topics")));
    }
    let layout = resolve_layout(name, profile, path, &asked.calibration, asked.field_of_view_deg)?;
    let is_single = matches!(layout.cameras, Cameras::Single(_));
    let motion = match (&asked.motion, &layout.truth) {
        (MotionSource::Odometry, Some(truth)) if is_single => {
            let poses = poses_at(truth, &layout.stamps_ns());
            MotionSource::Poses(write(scratch, "poses.tum", &tum_text(&poses))?)
        }
        _ => asked.motion.clone(),
    };
    let (name, truth) = (layout.root.clone(), layout.truth.clone());
    let imported = Imported { layout: Some(Arc::new(layout)), truth };
    Ok(IngestRequest { files: vec![name], motion, imported, ..asked })
}

fn request_of_bags(
    name: &str,
    profile: &Profile,
    path: &Path,
    asked: IngestRequest,
    scratch: &Path,
) -> Result<IngestRequest, IngestError> {
    let found = resolve_recording(name, profile, path)?;
    let mut calibration = asked.calibration.clone();
    let names_infos = asked.left_info.is_some() || asked.right_info.is_some();
    if calibration.is_empty() && !names_infos {
        calibration = match &found.calibration_text {
            Some(text) => vec![write(scratch, "calibration-of-profile.yaml", text)?],
            None => found.calibration,
        };
    }
    let uses_infos = calibration.is_empty();
    let info = |asked: Option<String>, told: Option<String>| if uses_infos { asked.or(told) } else { asked };
    let imported = Imported { layout: None, truth: found.truth };
    Ok(IngestRequest {
        files: found.files,
        left: asked.left.clone().or(found.topics.left),
        right: asked.right.clone().or(found.topics.right),
        left_info: info(asked.left_info.clone(), found.topics.left_info),
        right_info: info(asked.right_info.clone(), found.topics.right_info),
        calibration,
        imported,
        ..asked
    })
}

/// The true poses at these stamps, interpolated; stamps that no two poses surround have none.
fn poses_at(truth: &ImportedTruth, stamps_ns: &[i64]) -> Vec<(i64, Se3)> {
    let known: Vec<i64> = truth.poses.iter().map(|(stamp_ns, _)| *stamp_ns).collect();
    let pose = |stamp_ns: &i64| {
        let found = between(&known, *stamp_ns)?;
        let (before, after) = (&truth.poses[found.before].1, &truth.poses[found.after].1);
        Some((*stamp_ns, interpolated(before, after, found.share)))
    };
    stamps_ns.iter().filter_map(pose).collect()
}

/// The pose a share of the way from one to another near it: positions and quaternions in proportion.
fn interpolated(before: &Se3, after: &Se3, share: f64) -> Se3 {
    let mix = |a: f64, b: f64| a + share * (b - a);
    let (from, to) = (before.quaternion_xyzw(), after.quaternion_xyzw());
    let sign = if from.iter().zip(to).map(|(a, b)| a * b).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    let quaternion = std::array::from_fn(|i| mix(from[i], sign * to[i]));
    Se3::from_quaternion(quaternion, std::array::from_fn(|i| mix(before.translation_m[i], after.translation_m[i])))
}

fn write(scratch: &Path, name: &str, text: &str) -> Result<PathBuf, IngestError> {
    let path = scratch.join(name);
    fs::write(&path, text).map_err(IngestError::file(&path))?;
    Ok(path)
}
