//! What can be wrong with an image or a calibration.

use crate::images::Side;
use std::path::PathBuf;

/// An image that cannot be stored, decoded or rectified.
#[derive(Debug, thiserror::Error)]
pub enum ImageError {
    /// Zero columns or rows.
    #[error("the image is empty: it claims {width} x {height} pixels")]
    Empty {
        /// Claimed columns.
        width: usize,
        /// Claimed rows.
        height: usize,
    },
    /// Larger than [`header::MAX_SIDE_PX`](crate::images::header::MAX_SIDE_PX) or
    /// [`header::MAX_PIXELS`](crate::images::header::MAX_PIXELS) allow.
    #[error(
        "refused an image that claims {width} x {height} pixels: at most 12000 a side and 100 million in all are read"
    )]
    TooLarge {
        /// Claimed columns.
        width: usize,
        /// Claimed rows.
        height: usize,
    },
    /// A pixel format outside the list.
    #[error(
        "cannot read the raw image encoding '{encoding}': expected one of {readable}; record a compressed topic or one of these"
    )]
    Encoding {
        /// As the message names it.
        encoding: String,
        /// The list of those read.
        readable: String,
    },
    /// Rows that are shorter than their pixels.
    #[error("a {width} pixels wide {encoding} row needs {expected} bytes, but the message says that a row has {found}")]
    Step {
        /// As the message names it.
        encoding: String,
        /// Columns.
        width: usize,
        /// Bytes that a row of pixels needs.
        expected: usize,
        /// The message's step.
        found: usize,
    },
    /// Fewer or more bytes than rows times step.
    #[error(
        "a {width} x {height} {encoding} image with rows of {step} bytes needs {expected} bytes, found {found}: the message is damaged"
    )]
    Length {
        /// As the message names it.
        encoding: String,
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Bytes of a row.
        step: usize,
        /// Rows times step.
        expected: usize,
        /// The bytes that came.
        found: usize,
    },
    /// No JPEG and no PNG.
    #[error("expected a JPEG or PNG file, found {length} bytes that begin with [{first}]")]
    UnknownFormat {
        /// Bytes that came.
        length: usize,
        /// The first of them, in hexadecimal.
        first: String,
    },
    /// A variety that is not read.
    #[error("cannot read this {format}: {found}, expected {expected}")]
    Variety {
        /// JPEG or PNG.
        format: &'static str,
        /// What it is.
        found: String,
        /// What is read.
        expected: &'static str,
    },
    /// The file stops early or its structure is broken.
    #[error("this {format} of {length} bytes is damaged: {fault}")]
    Damaged {
        /// JPEG or PNG.
        format: &'static str,
        /// Bytes that came.
        length: usize,
        /// What is wrong.
        fault: String,
    },
    /// The image has another size than its calibration.
    #[error(
        "the {side} image is {found_width} x {found_height}, but its calibration is for {width} x {height}: take the calibration of \
         this stream, or scale it with a calibration file"
    )]
    NotOfTheCalibration {
        /// Which camera.
        side: Side,
        /// The image's columns.
        found_width: usize,
        /// The image's rows.
        found_height: usize,
        /// The calibration's columns.
        width: u32,
        /// The calibration's rows.
        height: u32,
    },
    /// A right image was asked for where there is one camera.
    #[error("there is no right image: a single camera took these")]
    SingleCamera,
    /// A mosaic too small to interpolate colours in.
    #[error(
        "a Bayer mosaic of {width} x {height} pixels has too few neighbours for colours: at least 4 x 4 are needed"
    )]
    SmallMosaic {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
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
    Odd {
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
    /// An image whose size is no scaling of the calibrated one.
    #[error(
        "a calibration for {width} x {height} cannot be scaled to images of {to_width} x {to_height}: the shape differs"
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
    LooksAway {
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
    /// None of the known forms.
    #[error(
        "{what} is no calibration of a known form: expected a ROS camera_info YAML per camera (with camera_matrix, projection_matrix), or \
         KITTI's calib_cam_to_cam.txt (with K_00:, P_rect_00:), or KITTI odometry's calib.txt (P0:, P1:, or two lines of 12 numbers)"
    )]
    UnknownForm {
        /// The file or text.
        what: String,
    },
    /// YAML of another shape.
    #[error("{what} is no ROS camera_info YAML: {source}")]
    Yaml {
        /// The file or text.
        what: String,
        /// The parser's words.
        source: serde_norway::Error,
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
