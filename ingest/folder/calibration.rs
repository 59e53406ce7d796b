//! The calibration that lies in an image folder.

use super::{FolderError, missing};
use furrow_catalog::images::{StereoCalibration, inspect, kitti};
use furrow_model::{CameraCalibration, Distortion};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Reads `calib.txt` (cameras `cameras`) or `calibration.json` among the folder's `names`. A `calib.txt` does not tell the images'
/// size: it is taken from the header of the first left and the first right image.
///
/// # Errors
/// Where neither is there or readable, or the images are not rectified.
pub(super) fn read(
    folder: &Path,
    names: &[String],
    cameras: [u8; 2],
    left: &BTreeMap<u64, PathBuf>,
    right: &BTreeMap<u64, PathBuf>,
) -> Result<StereoCalibration, FolderError> {
    let has = |name: &str| names.iter().any(|other| other == name);
    let read = |path: &Path| {
        fs::read_to_string(path).map_err(|source| FolderError::Unreadable { path: path.to_owned(), source })
    };
    if has("calib.txt") {
        let path = folder.join("calib.txt");
        let text = read(&path)?;
        let [left, right] = [first_size(folder, left)?, first_size(folder, right)?];
        let what = path.display().to_string();
        let mut calibration = kitti::odometry_calibration(&what, &text, cameras, left)?;
        [calibration.right.width, calibration.right.height] = right;
        return Ok(calibration);
    }
    if has("calibration.json") {
        let path = folder.join("calibration.json");
        let json = |source| FolderError::Json { path: path.clone(), source };
        let rig: RigJson = serde_json::from_str(&read(&path)?).map_err(json)?;
        return rig.calibration().map_err(|fault| json(serde::de::Error::custom(fault)));
    }
    Err(missing(folder, "calib.txt or calibration.json".to_owned(), names))
}

fn first_size(folder: &Path, images: &BTreeMap<u64, PathBuf>) -> Result<[u32; 2], FolderError> {
    let path = images.values().next().ok_or_else(|| missing(folder, "images".to_owned(), &[]))?;
    let bytes = fs::read(path).map_err(|source| FolderError::Unreadable { path: path.clone(), source })?;
    let header = inspect(&bytes).map_err(|source| FolderError::Image { path: path.clone(), source })?;
    // An inspected image has at most MAX_SIDE_PX columns and rows.
    Ok([header.width as u32, header.height as u32])
}

/// `calibration.json`: a rectified rig, with notes of the renderer beside it that do not concern us.
#[derive(Deserialize)]
struct RigJson {
    width: u32,
    height: u32,
    fx: f64,
    fy: f64,
    cx: f64,
    cy: f64,
    baseline_m: f64,
    #[serde(default)]
    distortion: Vec<f64>,
    rectified: bool,
}

impl RigJson {
    fn calibration(self) -> Result<StereoCalibration, String> {
        if !self.rectified || self.distortion.iter().any(|&value| value != 0.0) {
            return Err("expected rectified images without distortion".to_owned());
        }
        let Self { fx, fy, cx, cy, .. } = self;
        let camera = |p3: f64| CameraCalibration {
            width: self.width,
            height: self.height,
            distortion: Distortion::RadialTangential,
            coefficients: Vec::new(),
            intrinsics: [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
            rectification: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
            projection: [fx, 0.0, cx, p3, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
        };
        Ok(StereoCalibration {
            left: camera(0.0),
            right: camera(-fx * self.baseline_m),
            rectified_size: None,
            stream_is_rectified: true,
        })
    }
}
