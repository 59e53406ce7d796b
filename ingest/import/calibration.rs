//! The cameras of a dataset's images.

use super::error::ImportError;
use super::paths::{file_of, missing};
use super::profile::CalibrationPart;
use super::table::{cut, read_text};
use furrow_catalog::images::{
    LoosePixels, PairImages, SingleCamera, StereoCalibration, parse_calibration, parse_single_camera,
    read_calibration_files, read_single_camera_file,
};
use furrow_catalog::records::Cameras;
use furrow_model::{CameraCalibration, Distortion};
use std::fs;
use std::path::{Path, PathBuf};

/// What a user says of the cameras in place of a profile.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Given<'a> {
    /// Files of `--calibration`.
    pub(super) files: &'a [PathBuf],
    /// The field of view to assume of a single camera.
    pub(super) field_of_view_deg: Option<f64>,
}

/// Columns and rows of an image file.
pub(super) fn image_size(path: &Path) -> Result<[u32; 2], ImportError> {
    let bytes = fs::read(path).map_err(ImportError::unreadable(path))?;
    let size = LoosePixels::size_of_file(&bytes).map_err(|error| ImportError::file(path, error.to_string()))?;
    Ok(size.into())
}

/// The files that a profile names for its calibration, below `root` or above it.
pub(super) fn calibration_files(root: &Path, part: &CalibrationPart) -> Result<Vec<PathBuf>, ImportError> {
    let file = |names: &[String]| {
        let advice = "the calibration stands there: download it, too, or give one with --calibration FILE";
        file_of(root, part.above, names).ok_or_else(|| missing(root, names, advice))
    };
    if part.pinhole.is_empty() {
        return part.files.iter().map(|name| file(std::slice::from_ref(name))).collect();
    }
    Ok(vec![file(&part.pinhole)?])
}

/// The calibration of a pair whose images have these sizes, and the files that told it.
pub(super) fn pair(
    root: &Path,
    part: Option<&CalibrationPart>,
    given: Given<'_>,
    [left, right]: [[u32; 2]; 2],
) -> Result<(Cameras, Vec<PathBuf>), ImportError> {
    let none = CalibrationPart {
        files: Vec::new(),
        above: 0,
        kitti_cameras: None,
        rectified: false,
        text: None,
        pinhole: Vec::new(),
        baseline_m: None,
    };
    let part = part.unwrap_or(&none);
    let images =
        PairImages { left, right, kitti_cameras: part.kitti_cameras.unwrap_or([0, 1]), are_rectified: part.rectified };
    let is_pinhole = given.files.is_empty() && !part.pinhole.is_empty();
    let files = if given.files.is_empty() { calibration_files(root, part)? } else { given.files.to_vec() };
    let stereo = match (&part.text, files.first()) {
        (_, Some(file)) if is_pinhole => pinhole_pair(file, part.baseline_m, [left, right])?,
        (_, Some(_)) => read_calibration_files(&files, Some(&images))?,
        (Some(text), None) => parse_calibration(&[("the profile's calibration", text)], Some(&images))?,
        (None, None) => {
            let fault = "the profile tells no calibration: give the dataset's with --calibration FILE, or two files, \
                         left then right";
            return Err(ImportError::file(root, fault));
        }
    };
    Ok((Cameras::Pair(Box::new(stereo)), files))
}

/// The calibration of a single camera's images of this size, and the files that told it.
pub(super) fn single(
    root: &Path,
    part: Option<&CalibrationPart>,
    given: Given<'_>,
    size: [u32; 2],
) -> Result<(Cameras, Vec<PathBuf>), ImportError> {
    if let Some(degrees) = given.field_of_view_deg {
        return assumed(root, size, degrees).map(|camera| (camera, Vec::new()));
    }
    let camera = part.and_then(|part| part.kitti_cameras).map_or(0, |cameras| cameras[0]);
    let is_pinhole = given.files.is_empty() && part.is_some_and(|part| !part.pinhole.is_empty());
    let files = match part {
        Some(part) if given.files.is_empty() => calibration_files(root, part)?,
        _ => given.files.to_vec(),
    };
    let text = part.and_then(|part| part.text.as_ref());
    let single = match (files.as_slice(), text) {
        ([file], _) if is_pinhole => SingleCamera { camera: pinhole(file, size, 0.0)?, is_assumed: false },
        ([file], _) => read_single_camera_file(file, size, camera)?,
        ([], Some(text)) => parse_single_camera("the profile's calibration", text, size, camera)?,
        ([], None) => {
            let degrees = crate::folder::ASSUMED_FIELD_OF_VIEW_DEG;
            return assumed(root, size, degrees).map(|camera| (camera, Vec::new()));
        }
        _ => return Err(ImportError::file(root, "its images are a single camera's: give one calibration file")),
    };
    Ok((Cameras::Single(Box::new(single)), files))
}

fn assumed(root: &Path, [width, height]: [u32; 2], degrees: f64) -> Result<Cameras, ImportError> {
    let camera = SingleCamera::assumed(width, height, degrees);
    let camera = camera.map_err(|error| ImportError::file(root, error.to_string()))?;
    Ok(Cameras::Single(Box::new(camera)))
}

/// A rectified pair whose cameras differ in their place alone.
fn pinhole_pair(
    file: &Path,
    baseline_m: Option<f64>,
    [left, right]: [[u32; 2]; 2],
) -> Result<StereoCalibration, ImportError> {
    let unknown = || ImportError::file(file, "it tells one camera: the profile has to tell baseline_m");
    let baseline_m = baseline_m.ok_or_else(unknown)?;
    Ok(StereoCalibration {
        left: pinhole(file, left, 0.0)?,
        right: pinhole(file, right, baseline_m)?,
        rectified_size: None,
        stream_is_rectified: true,
    })
}

/// A camera without a lens, from the `fx fy cx cy` that a file begins with.
fn pinhole(file: &Path, [width, height]: [u32; 2], baseline_m: f64) -> Result<CameraCalibration, ImportError> {
    let text = read_text(file)?;
    let first = text.lines().next().unwrap_or_default();
    let numbers: Option<Vec<f64>> = first.split_whitespace().map(|word| word.parse().ok()).collect();
    let Some([fx, fy, cx, cy]) = numbers.and_then(|numbers| <[f64; 4]>::try_from(numbers).ok()) else {
        let (path, found) = (file.to_owned(), format!("'{}'", cut(first)));
        return Err(ImportError::Line { path, line: 1, expected: "the 4 numbers fx fy cx cy".to_owned(), found });
    };
    Ok(CameraCalibration {
        width,
        height,
        distortion: Distortion::RadialTangential,
        coefficients: Vec::new(),
        intrinsics: [fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0],
        rectification: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        projection: [fx, 0.0, cx, -fx * baseline_m, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0],
    })
}
