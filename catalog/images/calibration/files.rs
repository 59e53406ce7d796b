//! Calibrations that a user brings along, for recordings that have none or a wrong one.

use super::camera_file::FileCamera;
use super::error::CalibrationFileError;
use super::pair_file::{PairImages, pair_of};
use super::single::SingleCamera;
use super::stereo::StereoCalibration;
use super::yaml::{Document, documents};
use super::{kalibr, kitti, ros};
use std::fs;
use std::io::{Error, ErrorKind};
use std::path::Path;

/// The largest calibration file that is read: they have a few thousand bytes.
const MOST_BYTES: u64 = 4 << 20;

/// Reads a stereo calibration from one file, or from two of one camera each, left then right:
/// - ROS `camera_info` YAML and OpenCV's `%YAML:1.0`, as files or documents, with R and P;
/// - OpenCV's stereo files (M1, D1, M2, D2 with R1, P1, R2, P2 or with R, T), and ORB-SLAM's settings (LEFT.K …);
/// - Kalibr's `camchain.yaml`, and two `sensor.yaml` in EuRoC's layout, which tell no R and P: the pair is rectified
///   here, see [`align`](crate::images::rectify::align);
/// - KITTI's `calib_cam_to_cam.txt`, for images before or after rectification, by their size; and `calib.txt`.
///
/// The calibration is that of `images`: scaled where it was made at another resolution. Without `images`, it is the
/// files' own, which must tell a size.
///
/// # Errors
/// Files that cannot be read, are of no known form, or do not hold two cameras that make a pair.
pub fn read_calibration_files(
    paths: &[impl AsRef<Path>],
    images: Option<&PairImages>,
) -> Result<StereoCalibration, CalibrationFileError> {
    let mut texts = Vec::new();
    for path in paths {
        texts.push((path.as_ref().display().to_string(), read_text(path.as_ref())?));
    }
    let texts: Vec<(&str, &str)> = texts.iter().map(|(what, text)| (what.as_str(), text.as_str())).collect();
    parse_calibration(&texts, images)
}

/// Reads a stereo calibration from named texts; see [`read_calibration_files`].
///
/// # Errors
/// Texts of no known form, or that do not hold two cameras.
pub fn parse_calibration(
    texts: &[(&str, &str)],
    images: Option<&PairImages>,
) -> Result<StereoCalibration, CalibrationFileError> {
    let names: Vec<&str> = texts.iter().map(|(what, _)| *what).collect();
    let cameras = cameras_of(texts, images.map_or([0, 1], |images| images.kitti_cameras))?;
    let found = cameras.len();
    let cameras = <[FileCamera; 2]>::try_from(cameras)
        .map_err(|_| CalibrationFileError::NotTwo { found, what: names.join(", ") })?;
    pair_of(cameras, images)
}

/// Reads the calibration of a single camera's images of `size` (columns, rows) from a file of one camera, or of a KITTI
/// text, whose `kitti_camera` it takes. Its images are looked at as they are, so that the file must tell of no lens.
///
/// # Errors
/// A file that cannot be read, is of no known form, or holds several cameras.
pub fn read_single_camera_file(
    path: &Path,
    size: [u32; 2],
    kitti_camera: u8,
) -> Result<SingleCamera, CalibrationFileError> {
    parse_single_camera(&path.display().to_string(), &read_text(path)?, size, kitti_camera)
}

/// Reads the calibration of a single camera from a text, which errors call `what`; see [`read_single_camera_file`].
///
/// # Errors
/// A text of no known form, or of several cameras.
pub fn parse_single_camera(
    what: &str,
    text: &str,
    size: [u32; 2],
    kitti_camera: u8,
) -> Result<SingleCamera, CalibrationFileError> {
    let other = kitti_camera ^ 1;
    let mut cameras = cameras_of(&[(what, text)], [kitti_camera, other])?;
    if kitti::is_kitti(text) {
        cameras.truncate(1);
    }
    let found = cameras.len();
    let not_one = |_| CalibrationFileError::NotOne { found, what: what.to_owned() };
    let [mut camera] = <[FileCamera; 1]>::try_from(cameras).map_err(not_one)?;
    camera.fit(size)?;
    Ok(SingleCamera { camera: camera.camera, is_assumed: false })
}

/// A rotation, 3x3 by rows, and a translation in metres.
pub type Placed = ([f64; 9], [f64; 3]);

/// Reads where the first camera of a `sensor.yaml` or a camchain sits on its body, the IMU: body from camera. `None`
/// where the file does not tell.
///
/// # Errors
/// A file that cannot be read or is no YAML; a transform that is none.
pub fn read_body_from_camera(path: &Path) -> Result<Option<Placed>, CalibrationFileError> {
    let (what, text) = (path.display().to_string(), read_text(path)?);
    let pose = documents(&what, &text)?.iter().find_map(|document| kalibr::body_from_camera(document).transpose());
    Ok(pose.transpose()?.map(|pose| (pose.rotation, pose.translation)))
}

fn read_text(path: &Path) -> Result<String, CalibrationFileError> {
    let unreadable = |source| CalibrationFileError::Unreadable { path: path.to_owned(), source };
    let bytes = fs::metadata(path).map_err(unreadable)?.len();
    if bytes > MOST_BYTES {
        let said = format!("it has {bytes} bytes, expected a text of some thousand");
        return Err(unreadable(Error::new(ErrorKind::InvalidData, said)));
    }
    fs::read_to_string(path).map_err(unreadable)
}

fn cameras_of(texts: &[(&str, &str)], kitti_cameras: [u8; 2]) -> Result<Vec<FileCamera>, CalibrationFileError> {
    let mut cameras = Vec::new();
    let mut parts: Option<Document> = None;
    for (what, text) in texts {
        if kitti::is_kitti(text) {
            cameras.extend(kitti::cameras(what, text, kitti_cameras)?);
            continue;
        }
        let documents = documents(what, text)?;
        let known = cameras.len();
        for document in documents {
            if kalibr::is_chain(&document) {
                cameras.extend(kalibr::chain(&document)?);
            } else if ros::is_camera(&document) {
                cameras.push(ros::camera(&document)?);
            } else if kalibr::is_sensor(&document) {
                cameras.push(kalibr::sensor(&document)?);
            } else if ros::is_part_of_pair(&document) {
                parts = Some(parts.map_or_else(|| document.clone(), |first| first.joined(&document)));
            } else {
                return Err(CalibrationFileError::UnknownForm { what: document.what });
            }
        }
        if cameras.len() == known && parts.is_none() {
            return Err(CalibrationFileError::UnknownForm { what: (*what).to_owned() });
        }
    }
    if let Some(parts) = parts {
        cameras.extend(ros::pair(&parts)?);
    }
    Ok(cameras)
}
