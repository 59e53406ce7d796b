//! Calibrations of cameras: checked, read from files, fitted to images of another size. Nothing here moves a pixel.
//!
//! - [`stereo`], [`single`]: the stored calibration of a pair and of a single camera;
//! - [`check`]: whether the numbers of one camera can be;
//! - [`files`], [`kitti`]: calibrations that a user brings along, where the recording has none.

pub mod check;
pub mod error;
pub mod files;
pub mod kitti;
pub mod single;
pub mod stereo;
