//! Calibrations of cameras: checked, read from files, fitted to images of another size. Nothing here moves a pixel.
//!
//! - [`stereo`], [`single`]: the stored calibration of a pair and of a single camera;
//! - [`check`]: whether the numbers of one camera can be;
//! - [`lenses`]: lens models by name;
//! - [`files`]: calibrations that a user brings along, where the recording has none: [`ros`], [`kalibr`], [`kitti`],
//!   [`yaml`] read their forms as [`camera_file`]s, of which [`pair_file`] makes a pair.

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
pub mod stereo;
pub mod yaml;
