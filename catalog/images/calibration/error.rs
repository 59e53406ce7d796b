//! What can be wrong with a calibration, and with a file of one.

use crate::images::side::Side;
use std::path::PathBuf;

/// A calibration that gives no rectified stereo pair.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationError {
    /// A matrix of zeros.
    #[error(
        "the {side} camera is not calibrated: its {matrix} is all zeros; record calibrated CameraInfo or give a calibration file"
    )]
    Uncalibrated {
        /// Which camera.
        side: Side,
        /// K, R or P.
        matrix: &'static str,
    },
    /// A number outside what it can be.
    #[error("the {side} camera's {what} is {found}, expected {expected}; check its CameraInfo or calibration file")]
    BadValue {
        /// Which camera.
        side: Side,
        /// The number's name.
        what: &'static str,
        /// Its value.
        found: String,
        /// What it should be.
        expected: String,
    },
    /// Left and right contradict each other.
    #[error(
        "left and right are no rectified pair: {what} is {left} on the left and {right} on the right, expected {expected}; check that the \
         two CameraInfo belong together and are not swapped"
    )]
    NoPair {
        /// The number's name.
        what: &'static str,
        /// Its value on the left.
        left: f64,
        /// Its value on the right.
        right: f64,
        /// How they should relate.
        expected: &'static str,
    },
    /// A distance between the cameras that no rig has.
    #[error(
        "a baseline of {baseline_m} m, expected 0.01 to 5 m: the right camera's P[3] is {p3}, which must be -fx·B in pixel·metres \
         (fx is {fx}, B the distance between the cameras in metres), but seems to be {seems}; correct it in a calibration file and \
         give that with --calibration"
    )]
    Baseline {
        /// Metres, if P\[3\] were what it must be.
        baseline_m: f64,
        /// The right camera's P\[3\].
        p3: f64,
        /// P\[0\], pixels.
        fx: f64,
        /// The units in which it would make a rig.
        seems: String,
    },
    /// An image whose size is no scaling of the calibrated one.
    #[error(
        "a calibration for {width} x {height} cannot be scaled to images of {to_width} x {to_height}: the shape differs; if the images \
         are a part of the sensor, CameraInfo has to tell its region of interest, or a calibration file theirs"
    )]
    Shape {
        /// Calibrated columns.
        width: u32,
        /// Calibrated rows.
        height: u32,
        /// The image's columns.
        to_width: u32,
        /// The image's rows.
        to_height: u32,
    },
    /// The rectified image would show nothing.
    #[error(
        "with these R and P hardly any rectified pixel is seen by both cameras ({percent_seen:.1} % of {width} x {height}): the calibration \
         is not of this stereo pair, or needs an explicit rectified size"
    )]
    NoOverlap {
        /// Share of pixels that both cameras see.
        percent_seen: f64,
        /// Columns looked at.
        width: u32,
        /// Rows looked at.
        height: u32,
    },
    /// OpenCV refused.
    #[error("OpenCV failed to {doing}: {source}")]
    OpenCv {
        /// What was asked of it.
        doing: &'static str,
        /// Its own words.
        source: opencv::Error,
    },
}

/// A calibration file that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum CalibrationFileError {
    /// The file cannot be opened or is no text.
    #[error("cannot read the calibration file {path}: {source}")]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// Too few or too many files or documents.
    #[error("expected the calibrations of two cameras, left then right, found {found} in {what}")]
    NotTwo {
        /// Cameras found.
        found: usize,
        /// Where.
        what: String,
    },
    /// Several cameras where one is asked for, or none.
    #[error("expected the calibration of a single camera, found {found} in {what}")]
    NotOne {
        /// Cameras found.
        found: usize,
        /// Where.
        what: String,
    },
    /// None of the known forms.
    #[error(
        "{what} is no calibration of a known form: expected YAML of ROS or OpenCV (with camera_matrix, projection_matrix), Kalibr's \
         camchain (cam0, cam1), EuRoC's sensor.yaml (T_BS, intrinsics), KITTI's calib_cam_to_cam.txt (K_00:, P_rect_00:) or calib.txt \
         (P0:, P1:, or two lines of 12 numbers)"
    )]
    UnknownForm {
        /// The file or text.
        what: String,
    },
    /// YAML of another shape.
    #[error("{what} is no YAML: {source}")]
    Yaml {
        /// The file or text.
        what: String,
        /// The parser's words.
        source: serde_norway::Error,
    },
    /// Lenses only.
    #[error(
        "{what}: no place of one camera beside the other: expected rectification_matrix and projection_matrix of both, T_cn_cnm1 \
         (Kalibr), T_BS (EuRoC), or R and T (OpenCV); calibrate the two cameras together"
    )]
    NoExtrinsics {
        /// The files.
        what: String,
    },
    /// No size of the images.
    #[error("{what} does not tell the size of its images: expected image_width and image_height, or resolution")]
    NoSize {
        /// The file and camera.
        what: String,
    },
    /// Rectified images, and a calibration of those before rectification.
    #[error(
        "{what} tells of the cameras before rectification, but these images are rectified by their topic's name: give the \
         projection matrices that they were rectified to, or choose the raw images with --left TOPIC --right TOPIC"
    )]
    OfUnrectified {
        /// The files.
        what: String,
    },
    /// Numbers that no camera or pair has.
    #[error("{what}: {source}")]
    Camera {
        /// The file and camera.
        what: String,
        /// Why.
        source: Box<CalibrationError>,
    },
    /// A key that is not there.
    #[error("{what} has no line '{key}:'")]
    Missing {
        /// The file or text.
        what: String,
        /// What was looked for.
        key: String,
    },
    /// Numbers that do not fit.
    #[error("{what}: {key} should be {expected}, found {found}")]
    Numbers {
        /// The file or text.
        what: String,
        /// The line or matrix.
        key: String,
        /// What it should be.
        expected: String,
        /// What it is.
        found: String,
    },
}
