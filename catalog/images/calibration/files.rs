//! Calibrations that a user brings along, for recordings that have none or a wrong one.

use super::check::is_rectified;
use super::error::CalibrationFileError;
use super::kitti;
use super::stereo::{StereoCalibration, distortion_named};
use furrow_model::CameraCalibration;
use serde::Deserialize;
use std::fs;
use std::path::Path;

/// Reads a stereo calibration from one or two files: two ROS `camera_info` YAML files (left, then right), one file with
/// two YAML documents, or KITTI's `calib_cam_to_cam.txt` (cameras 00 and 01).
///
/// # Errors
/// Files that cannot be read, are of no known form, or do not hold two cameras.
pub fn read_calibration_files(paths: &[impl AsRef<Path>]) -> Result<StereoCalibration, CalibrationFileError> {
    let mut texts = Vec::new();
    for path in paths {
        let path = path.as_ref();
        let text = fs::read_to_string(path)
            .map_err(|source| CalibrationFileError::Unreadable { path: path.to_owned(), source })?;
        texts.push((path.display().to_string(), text));
    }
    let texts: Vec<(&str, &str)> = texts.iter().map(|(what, text)| (what.as_str(), text.as_str())).collect();
    parse_calibration(&texts)
}

/// Reads a stereo calibration from named texts; see [`read_calibration_files`].
///
/// # Errors
/// Texts of no known form, or that do not hold two cameras.
pub fn parse_calibration(texts: &[(&str, &str)]) -> Result<StereoCalibration, CalibrationFileError> {
    if let [(what, text)] = texts
        && text.contains("P_rect_")
    {
        return kitti::raw_calibration(what, text, 0, 1);
    }
    let mut cameras = Vec::new();
    for (what, text) in texts {
        if !text.contains("camera_matrix") {
            return Err(CalibrationFileError::UnknownForm { what: (*what).to_owned() });
        }
        for document in serde_norway::Deserializer::from_str(text) {
            let camera = CameraInfoYaml::deserialize(document)
                .map_err(|source| CalibrationFileError::Yaml { what: (*what).to_owned(), source })?;
            cameras.push(camera.calibration(what)?);
        }
    }
    let found = cameras.len();
    let names: Vec<&str> = texts.iter().map(|(what, _)| *what).collect();
    let [left, right] = <[CameraCalibration; 2]>::try_from(cameras)
        .map_err(|_| CalibrationFileError::NotTwo { found, what: names.join(", ") })?;
    let stream_is_rectified = is_rectified(&left) && is_rectified(&right);
    Ok(StereoCalibration { left, right, rectified_size: None, stream_is_rectified })
}

/// What ROS' `camera_calibration_parsers` writes. Other people's tools add keys of their own: unknown ones are passed
/// over.
#[derive(Deserialize)]
struct CameraInfoYaml {
    image_width: u32,
    image_height: u32,
    distortion_model: String,
    camera_matrix: Matrix,
    distortion_coefficients: Matrix,
    rectification_matrix: Matrix,
    projection_matrix: Matrix,
}

/// A matrix by rows.
#[derive(Deserialize)]
struct Matrix {
    rows: usize,
    cols: usize,
    data: Vec<f64>,
}

impl CameraInfoYaml {
    fn calibration(self, what: &str) -> Result<CameraCalibration, CalibrationFileError> {
        let wrong = |key: &str, expected: &str, found: String| CalibrationFileError::Numbers {
            what: what.to_owned(),
            key: key.to_owned(),
            expected: expected.to_owned(),
            found,
        };
        let model = &self.distortion_model;
        let distortion = distortion_named(model).ok_or_else(|| {
            wrong("distortion_model", "plumb_bob, rational_polynomial, equidistant or fisheye", model.clone())
        })?;
        let count = self.distortion_coefficients.data.len();
        let coefficients = self.distortion_coefficients.by_rows("distortion_coefficients", &wrong, 1, count)?;
        Ok(CameraCalibration {
            width: self.image_width,
            height: self.image_height,
            distortion,
            coefficients,
            intrinsics: self.camera_matrix.array("camera_matrix", &wrong, 3, 3)?,
            rectification: self.rectification_matrix.array("rectification_matrix", &wrong, 3, 3)?,
            projection: self.projection_matrix.array("projection_matrix", &wrong, 3, 4)?,
        })
    }
}

impl Matrix {
    fn array<const COUNT: usize>(
        self,
        key: &str,
        wrong: &impl Fn(&str, &str, String) -> CalibrationFileError,
        rows: usize,
        cols: usize,
    ) -> Result<[f64; COUNT], CalibrationFileError> {
        let data = self.by_rows(key, wrong, rows, cols)?;
        let count = data.len();
        data.try_into().map_err(|_| wrong(key, &format!("{COUNT} numbers"), format!("{count}")))
    }

    fn by_rows(
        self,
        key: &str,
        wrong: &impl Fn(&str, &str, String) -> CalibrationFileError,
        rows: usize,
        cols: usize,
    ) -> Result<Vec<f64>, CalibrationFileError> {
        let Self { rows: found_rows, cols: found_cols, data } = self;
        if (found_rows, found_cols) != (rows, cols) || data.len() != rows * cols {
            let found = format!("rows {found_rows}, cols {found_cols} with {} numbers", data.len());
            return Err(wrong(key, &format!("rows {rows}, cols {cols}"), found));
        }
        Ok(data)
    }
}
