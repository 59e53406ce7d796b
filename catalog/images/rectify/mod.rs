//! Rectification: recorded images become those of the rig. Calibrations come checked from
//! [`calibration`](super::calibration); no file is read here.
//!
//! - [`lens`]: where a rectified pixel comes from in the recorded image;
//! - [`align`], [`pose`]: R and P of cameras for which only their lenses and places are known;
//! - [`extent`], [`rig`]: how large a rectified image is, and the rig that it shows the world through;
//! - [`rectifier`]: moves the pixels; [`lookup`]: moves them by a table that a dataset brings along.

pub mod align;
pub mod extent;
pub mod lens;
pub mod lookup;
pub mod pose;
pub mod rectifier;
pub mod rig;
