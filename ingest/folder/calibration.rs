//! The calibration that lies in an image folder.

use super::error::FolderError;
use super::headers::first_size;
use furrow_catalog::images::{
    PairImages, SingleCamera, StereoCalibration, kitti, read_calibration_files, read_single_camera_file,
};
use furrow_model::{CameraCalibration, Distortion};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Reads the calibration `files` that the user gave, else `calib.txt` (cameras `cameras`) or `calibration.json` among
/// the folder's `names`. What the images' size is, the headers of the first left and the first right one that can be
/// read tell.
///
/// # Errors
/// Where neither is there or readable, or the images are not rectified.
pub(super) fn read_pair(
    folder: &Path,
    names: &[String],
    cameras: [u8; 2],
    left: &BTreeMap<u64, PathBuf>,
    right: &BTreeMap<u64, PathBuf>,
    files: &[PathBuf],
) -> Result<StereoCalibration, FolderError> {
    if !files.is_empty() {
        let [left, right] = [first_size(folder, left)?, first_size(folder, right)?];
        let images = PairImages { left, right, kitti_cameras: cameras, are_rectified: false };
        return Ok(read_calibration_files(files, Some(&images))?);
    }
    match calibration_text(folder, names)? {
        Some(CalibrationText::Kitti(path, text)) => {
            let [left, right] = [first_size(folder, left)?, first_size(folder, right)?];
            let what = path.display().to_string();
            let mut calibration = kitti::odometry_calibration(&what, &text, cameras, left)?;
            [calibration.right.width, calibration.right.height] = right;
            Ok(calibration)
        }
        Some(CalibrationText::Json(path, text)) => parse_json(&path, &text, RigJson::pair),
        None => Err(FolderError::Uncalibrated { folder: folder.to_owned() }),
    }
}

/// Reads the single camera of the `files` that the user gave, else the left camera of the folder's; `None` where there
/// are none.
///
/// # Errors
/// Where a file is not readable, or the images are not rectified.
pub(super) fn read_single(
    folder: &Path,
    names: &[String],
    cameras: [u8; 2],
    size: [u32; 2],
    files: &[PathBuf],
) -> Result<Option<SingleCamera>, FolderError> {
    match files {
        [] => {}
        [file] => return Ok(Some(read_single_camera_file(file, size, cameras[0])?)),
        _ => return Err(FolderError::OneCamera { folder: folder.to_owned() }),
    }
    Ok(match calibration_text(folder, names)? {
        Some(CalibrationText::Kitti(path, text)) => {
            let pair = kitti::odometry_calibration(&path.display().to_string(), &text, cameras, size)?;
            Some(SingleCamera { camera: pair.left, is_assumed: false })
        }
        Some(CalibrationText::Json(path, text)) => {
            let left = |rig: RigJson| rig.camera(0.0);
            Some(SingleCamera { camera: parse_json(&path, &text, left)?, is_assumed: false })
        }
        None => None,
    })
}

/// A calibration file's path and text.
enum CalibrationText {
    Kitti(PathBuf, String),
    Json(PathBuf, String),
}

fn calibration_text(folder: &Path, names: &[String]) -> Result<Option<CalibrationText>, FolderError> {
    let read = |name: &str| {
        let path = folder.join(name);
        match names.iter().any(|other| other == name).then(|| fs::read_to_string(&path)) {
            None => Ok(None),
            Some(Ok(text)) => Ok(Some((path, text))),
            Some(Err(source)) => Err(FolderError::Unreadable { path, source }),
        }
    };
    if let Some((path, text)) = read("calib.txt")? {
        return Ok(Some(CalibrationText::Kitti(path, text)));
    }
    Ok(read("calibration.json")?.map(|(path, text)| CalibrationText::Json(path, text)))
}

fn parse_json<T>(path: &Path, text: &str, make: impl Fn(RigJson) -> Result<T, String>) -> Result<T, FolderError> {
    let json = |source| FolderError::Json { path: path.to_owned(), source };
    let rig: RigJson = serde_json::from_str(text).map_err(json)?;
    make(rig).map_err(|fault| json(serde::de::Error::custom(fault)))
}

/// `calibration.json`: a rectified rig. Other keys, notes of the renderer, are ignored.
#[derive(Deserialize)]
struct RigJson {
    width: u32,
    height: u32,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    baseline_m: Option<f64>,
    #[serde(default)]
    distortion: Vec<f64>,
    rectified: bool,
}

impl RigJson {
    /// Either camera; `p3` is its fourth number of P.
    fn camera(&self, p3: f64) -> Result<CameraCalibration, String> {
        if !self.rectified || self.distortion.iter().any(|&value| value != 0.0) {
            return Err("expected rectified images without distortion".to_owned());
        }
        let &Self { fx, fy, cx, cy, .. } = self;
        Ok(CameraCalibration {
            width: self.width,
            height: self.height,
            distortion: Distortion::RadialTangential,
            coefficients: Vec::new(),
            intrinsics: [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
            rectification: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            projection: [fx, 0.0, cx, p3, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        })
    }

    fn pair(self) -> Result<StereoCalibration, String> {
        let baseline_m = self.baseline_m.ok_or("missing field `baseline_m`, the distance between the cameras")?;
        Ok(StereoCalibration {
            left: self.camera(0.0)?,
            right: self.camera(-self.fx * baseline_m)?,
            rectified_size: None,
            stream_is_rectified: true,
        })
    }
}
