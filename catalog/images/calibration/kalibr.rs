//! Kalibr's `camchain.yaml`, and the `sensor.yaml` beside a camera's images in EuRoC's layout: intrinsics and
//! extrinsics, without rectification.

use super::camera_file::FileCamera;
use super::error::CalibrationFileError;
use super::lenses::{KNOWN_MODELS, distortion_named};
use super::yaml::Document;
use crate::images::rectify::pose::Pose;

/// Whether a document is a chain of cameras.
pub fn is_chain(document: &Document) -> bool {
    !names(document).is_empty()
}

/// Whether a document is one camera's `sensor.yaml`.
pub fn is_sensor(document: &Document) -> bool {
    document.has(&["intrinsics"]) && document.has(&["resolution", "T_BS", "camera_model", "distortion_model"])
}

/// The cameras of a chain, in order of their numbers.
///
/// # Errors
/// Another projection than a pinhole's, a lens model that is not known, matrices of other shapes.
pub fn chain(document: &Document) -> Result<Vec<FileCamera>, CalibrationFileError> {
    let mut cameras: Vec<FileCamera> = Vec::new();
    // T_cn_cnm1 leads from the camera before; the poses towards an IMU serve where it is not told.
    let parts: Vec<Document> = names(document).iter().filter_map(|name| document.part(name)).collect();
    let is_chained = parts.iter().skip(1).all(|part| part.has(&["T_cn_cnm1"]));
    for part in &parts {
        let mut camera = intrinsics(part)?;
        camera.camera_from_body = if !is_chained {
            transform(part, "T_cam_imu")?
        } else if let Some(before) = cameras.last() {
            let from_before = transform(part, "T_cn_cnm1")?;
            from_before.zip(before.camera_from_body).map(|(step, before)| step.after(&before))
        } else {
            Some(Pose::IDENTITY)
        };
        cameras.push(camera);
    }
    Ok(cameras)
}

/// The camera of a `sensor.yaml`; `T_BS` tells where it sits on the body.
///
/// # Errors
/// As [`chain`].
pub fn sensor(document: &Document) -> Result<FileCamera, CalibrationFileError> {
    let mut camera = intrinsics(document)?;
    camera.camera_from_body = transform(document, "T_BS")?.map(|pose| pose.inverse());
    Ok(camera)
}

/// Where the first camera of either document sits on the body; `None` where that is not told.
///
/// # Errors
/// A matrix that is no rigid transform.
pub fn body_from_camera(document: &Document) -> Result<Option<Pose>, CalibrationFileError> {
    match names(document).first().and_then(|name| document.part(name)) {
        Some(first) => Ok(transform(&first, "T_cam_imu")?.map(|pose| pose.inverse())),
        None => transform(document, "T_BS"),
    }
}

fn names(document: &Document) -> Vec<String> {
    let number = |name: &str| name.strip_prefix("cam").and_then(|number| number.parse::<u32>().ok());
    let keys = document.value.as_mapping().into_iter().flatten();
    let mut names: Vec<(u32, String)> =
        keys.filter_map(|(key, _)| key.as_str().and_then(|key| Some((number(key)?, key.to_owned())))).collect();
    names.sort();
    names.into_iter().map(|(_, name)| name).collect()
}

fn intrinsics(document: &Document) -> Result<FileCamera, CalibrationFileError> {
    let model = document.text(&["camera_model"]);
    if !matches!(model, "" | "pinhole") {
        return Err(document.wrong("camera_model", "pinhole", model.to_owned()));
    }
    let missing = |key: &str| CalibrationFileError::Missing { what: document.what.clone(), key: key.to_owned() };
    let [fx, fy, cx, cy] = document.matrix::<4>(&["intrinsics"], 1, 4)?.ok_or_else(|| missing("intrinsics"))?;
    let name = document.text(&["distortion_model"]);
    let coefficients = match document.numbers(&["distortion_coeffs", "distortion_coefficients"])? {
        Some(coefficients) => coefficients,
        None if matches!(name, "" | "none") => Vec::new(),
        None => return Err(missing("distortion_coeffs")),
    };
    let lens = distortion_named(name, &coefficients)
        .ok_or_else(|| document.wrong("distortion_model", KNOWN_MODELS, format!("'{name}'")))?;
    let size = match document.numbers(&["resolution"])?.as_deref() {
        None => None,
        Some(&[w, h]) if [w, h].iter().all(|n| n.fract() == 0.0 && (1.0..65_536.0).contains(n)) => {
            Some([w as u32, h as u32])
        }
        Some(other) => return Err(document.wrong("resolution", "whole columns and rows", format!("{other:?}"))),
    };
    let k = [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0];
    Ok(FileCamera::new(document.what.clone(), size, k, (lens, coefficients)))
}

/// A rigid transform written as a 4x4 matrix, or as its first three rows.
fn transform(document: &Document, key: &str) -> Result<Option<Pose>, CalibrationFileError> {
    let Some(numbers) = document.numbers(&[key])? else { return Ok(None) };
    let wrong = |found: String| document.wrong(key, "a 4x4 matrix of a rotation and a translation in metres", found);
    if !matches!(numbers.len(), 12 | 16) {
        return Err(wrong(format!("{} numbers", numbers.len())));
    }
    let row = |row: usize| [numbers[4 * row], numbers[4 * row + 1], numbers[4 * row + 2]];
    let [a, b, c] = [row(0), row(1), row(2)];
    let rotation = [a[0], a[1], a[2], b[0], b[1], b[2], c[0], c[1], c[2]];
    let pose = Pose { rotation, translation: [numbers[3], numbers[7], numbers[11]] };
    let last = numbers.get(12..).unwrap_or(&[]);
    let closes = last.is_empty() || last.iter().zip([0.0, 0.0, 0.0, 1.0]).all(|(a, b)| (a - b).abs() < 1e-9);
    if !closes || !pose.is_rigid() {
        return Err(wrong(format!("{numbers:?}")));
    }
    Ok(Some(pose))
}
