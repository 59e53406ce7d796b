//! Images as they are stored, and how stored images become rectified ones.
//!
//! The rule of storage: **an image that was recorded compressed keeps the recording's own bytes; a raw one is stored losslessly as
//! PNG**. Equal pixels give equal bytes on every machine, so an image's digest can name it. A tour, in the order an image goes:
//! - [`header`]: what a JPEG or PNG says of itself, read before anything is decoded, so that a lying header costs nothing;
//! - [`raw`]: `sensor_msgs/Image` pixels into PNG ([`RawPixels`], [`store_raw`]);
//! - [`decode`]: stored bytes into grey or colour pixels; Bayer mosaics are resolved here, not at storage;
//! - [`calibration_file`], [`kitti`]: calibrations that a user brings along, where the recording has none;
//! - [`calibration`]: the stored record of a stereo pair's calibration, and its scaling to binned images;
//! - [`lens`], [`rig`], [`extent`]: where a rectified pixel comes from, what rig results, how large a rectified image is;
//! - [`rectify`]: the [`Rectifier`], which moves pixels with OpenCV's `remap`;
//! - [`single`]: a camera without a partner, whose images are looked at as they are;
//! - [`resize`]: colour images of another size;
//! - [`tile`], [`sheet`]: small JPEGs for reports, and many of them on one sheet.
//!
//! OpenCV is called here and nowhere else in furrow. Its own threads are switched off: callers parallelise over images.

pub mod calibration;
pub mod calibration_file;
pub mod decode;
pub mod error;
pub mod extent;
pub mod header;
pub mod kitti;
pub mod lens;
mod png_codec;
pub mod raw;
pub mod rectify;
pub mod resize;
pub mod rig;
pub mod sheet;
pub mod single;
pub mod tile;

pub use calibration::{Side, StereoCalibration};
pub use calibration_file::read_calibration_files;
pub use decode::{decode_colour, decode_grey, grey_of};
pub use error::{CalibrationError, CalibrationFileError, ImageError};
pub use header::{Header, inspect};
pub use raw::{RawImage, RawPixels, store_raw};
pub use rectify::Rectifier;
pub use resize::resized;
pub use sheet::{SheetRow, contact_sheet};
pub use single::SingleCamera;
pub use tile::{Picture, encode_jpeg};

pub use furrow_model::ColourImage;

use serde::{Deserialize, Serialize};

/// The colours of a Bayer mosaic's top left 2x2 pixels, by rows, as ROS names them (`bayer_rggb8` and so on).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BayerPattern {
    /// Red, green / green, blue.
    Rggb,
    /// Blue, green / green, red.
    Bggr,
    /// Green, blue / red, green.
    Gbrg,
    /// Green, red / blue, green.
    Grbg,
}

/// An image in the form in which it is stored.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StoredImage {
    /// A complete JPEG or PNG file.
    pub bytes: Vec<u8>,
    /// Columns, in pixels.
    pub width: usize,
    /// Rows, in pixels.
    pub height: usize,
    /// Set where `bytes` is the grey picture of a mosaic: pass it to [`decode_grey`] and [`decode_colour`].
    pub bayer: Option<BayerPattern>,
}

#[cfg(test)]
mod tests;
