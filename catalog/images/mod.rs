//! Images as they are stored, and how stored images become rectified ones. OpenCV is called here and nowhere else in
//! furrow, without threads of its own: callers parallelise over images. No store, no index and no record is known here.
//!
//! The rule of storage: **an image that was recorded compressed keeps the recording's own bytes; a raw one is stored
//! losslessly as PNG**. Equal pixels give equal bytes on every machine, so an image's digest can name it. A tour, in
//! the order an image goes:
//! - [`header`]: what a JPEG or PNG says of itself, read before anything is decoded, so that a lying header costs
//!   nothing;
//! - [`raw`]: `sensor_msgs/Image` pixels into PNG ([`RawPixels`], [`store_raw`]); [`encoding`]: the names of pixel
//!   formats and where their parts lie; `yuv`: luma and colour differences; [`depth`]: how many of 16 bits a recording
//!   uses;
//! - [`loose`]: image files that are not kept as they are: PGM, PPM, PNG of 16 bits; [`stored`]: what is stored;
//! - [`decode`]: stored bytes into grey or colour pixels; Bayer mosaics are resolved here, not at storage;
//! - [`calibration`]: a camera pair's and a single camera's calibration, from files or as recorded;
//! - [`rectify`]: the [`Rectifier`], which moves pixels with OpenCV's `remap`;
//! - [`resize`]: colour images of another size;
//! - [`tile`], [`sheet`]: small JPEGs for reports, and many of them on one sheet.

pub mod calibration;
pub mod decode;
pub mod depth;
pub mod encoding;
pub mod error;
pub mod header;
pub mod loose;
mod matrix;
mod png_codec;
pub mod raw;
pub mod raw_image;
pub mod rectify;
pub mod resize;
pub mod sheet;
pub mod side;
pub mod stored;
mod threads;
pub mod tile;
mod yuv;

pub use calibration::error::{CalibrationError, CalibrationFileError};
pub use calibration::files::{
    parse_calibration, parse_single_camera, read_body_from_camera, read_calibration_files, read_single_camera_file,
};
pub use calibration::kitti;
pub use calibration::pair_file::PairImages;
pub use calibration::single::SingleCamera;
pub use calibration::stereo::StereoCalibration;
pub use decode::{decode_colour, decode_grey, grey_of};
pub use depth::{Depth, SeenPixels};
pub use error::ImageError;
pub use furrow_model::ColourImage;
pub use header::{Header, inspect};
pub use loose::LoosePixels;
pub use raw::{RawPixels, store_raw};
pub use raw_image::RawImage;
pub use rectify::lookup::LookupTable;
pub use rectify::rectifier::Rectifier;
pub use resize::resized;
pub use sheet::{SheetRow, contact_sheet};
pub use side::Side;
pub use stored::{BayerPattern, StoredImage};
pub use tile::{Picture, encode_jpeg};

#[cfg(test)]
mod tests;
