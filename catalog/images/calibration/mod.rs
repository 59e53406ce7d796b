//! Calibrations of cameras: checked, read from files, fitted to images of another size. Nothing here moves a pixel.
//!
//! - [`stereo`], [`single`]: the stored calibration of a pair and of a single camera;
//! - [`check`], [`baseline`]: whether the numbers of one camera, and the distance of two, can be;
//! - [`square`]: pairs whose pixels are not square;
//! - [`lenses`]: lens models by name;
//! - [`files`]: calibrations that a user brings along, where the recording has none: [`ros`], [`kalibr`], [`kitti`],
//!   [`yaml`] read their forms as [`camera_file`]s, of which [`pair_file`] makes a pair.

pub mod baseline;
pub mod camera_file;
pub mod check;
pub mod error;
pub mod files;
pub mod kalibr;
pub mod kitti;
pub mod lenses;
pub mod pair_file;
pub mod ros;
pub mod single;
pub mod square;
pub mod stereo;
pub mod yaml;
