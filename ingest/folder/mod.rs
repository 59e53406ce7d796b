//! Image folders: rectified stereo pairs, or the images of a single camera, as loose files. Names, headers,
//! calibrations and times are read here; pixels are not decoded.
//!
//! Two layouts of pairs are known, told apart by their calibration file:
//! - KITTI odometry: `calib.txt`, images named by frame number, `times.txt` with one time in seconds per frame. Without
//!   `times.txt`, frames are 0.1 s apart, from 0;
//! - `calibration.json` (width, height, fx, fy, cx, cy, baseline_m), images named by their stamp.
//!
//! In both, names may be frame numbers or stamps ([`StereoFolder`]); frames named by stamps are paired by them.

mod calibration;
mod error;
mod headers;
mod layout;
mod names;
mod natural;
mod numbered;
mod numbers;
mod single;
mod stereo;
mod times;

pub use error::FolderError;
pub use layout::{NOMINAL_INTERVAL_NS, holds_pairs};
pub(crate) use layout::{images_in, names_of_folder};
pub(crate) use numbered::{numbers_of_names, stamps_of_names};
pub(crate) use numbers::date_ns as date_stamp_ns;
pub use single::{ASSUMED_FIELD_OF_VIEW_DEG, ImageFile, SingleFolder};
pub(crate) use stereo::pair_by_stamp;
pub use stereo::{PairFiles, StereoFolder, UnpairedFile};

#[cfg(test)]
mod tests;
