//! What can be wrong with an image.

use super::side::Side;

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
    /// A message around the image that cannot be decoded.
    #[error("{fault}")]
    Message {
        /// What is wrong with it.
        fault: String,
    },
    /// A mosaic among other images, or one of another pattern.
    #[error("its mosaic is {found}, that of the images before it {expected}: the camera was set otherwise meanwhile")]
    OtherMosaic {
        /// The image's pattern, or `none`.
        found: String,
        /// The recording's pattern, or `none`.
        expected: String,
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
