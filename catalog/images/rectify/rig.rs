//! What a pair of calibrations says about the rectified rig, and what contradicts it.

use crate::images::calibration::check::FOCAL_TOLERANCE;
use crate::images::calibration::error::CalibrationError;
use furrow_model::{CameraCalibration, StereoRig};

/// Principal points may differ by this much, in pixels: a disparity error that moves a point 20 m away by under a
/// centimetre.
const CENTRE_TOLERANCE_PX: f64 = 0.01;

/// The rig of two checked calibrations and a rectified size: focal length and principal point from the left P, and
/// baseline = (P_left\[3\] - P_right\[3\]) / fx, which is -P_right\[3\] / fx wherever the left camera is the origin.
///
/// # Errors
/// Focal lengths or principal points that differ, a baseline that is zero or negative, a pair stacked vertically.
pub fn rig_of(
    left: &CameraCalibration,
    right: &CameraCalibration,
    width: u32,
    height: u32,
) -> Result<StereoRig, CalibrationError> {
    let (l, r) = (&left.projection, &right.projection);
    let pair = |what, at: usize, expected| Err(CalibrationError::NoPair { what, left: l[at], right: r[at], expected });
    if (l[0] - r[0]).abs() > FOCAL_TOLERANCE * l[0] {
        return pair("the focal length P[0]", 0, "equal focal lengths");
    }
    if (l[2] - r[2]).abs() > CENTRE_TOLERANCE_PX {
        return pair("the principal point's column P[2]", 2, "equal ones (calibrate with zero disparity at infinity)");
    }
    if (l[6] - r[6]).abs() > CENTRE_TOLERANCE_PX {
        return pair("the principal point's row P[6]", 6, "equal rows");
    }
    let (across, down) = (l[3] - r[3], l[7] - r[7]);
    if down.abs() > across.abs() {
        return pair("the vertical offset P[7]", 7, "cameras side by side, not one above the other");
    }
    if across <= 0.0 {
        return pair("the baseline term P[3]", 3, "a right P[3] of -fx times the baseline, below the left one");
    }
    Ok(StereoRig { width, height, focal_px: l[0], cu_px: l[2], cv_px: l[6], baseline_m: across / l[0] })
}
