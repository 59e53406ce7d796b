//! What a pair of calibrations says about the rectified rig, and what contradicts it.

use crate::images::{CalibrationError, Side, header, lens};
use furrow_model::{CameraCalibration, StereoRig};

/// Focal lengths may differ by this share: calibrations are written with 6 or 7 digits.
const FOCAL_TOLERANCE: f64 = 1e-4;
/// Principal points may differ by this much, in pixels: a disparity error that moves a point 20 m away by under a centimetre.
const CENTRE_TOLERANCE_PX: f64 = 0.01;
/// R times its transpose may differ from the identity by this much.
const ROTATION_TOLERANCE: f64 = 1e-2;
/// Two numbers this close are the same number, printed and read again.
const SAME: f64 = 1e-6;

/// Checks the numbers of one camera on their own: K, R, P and the size.
///
/// # Errors
/// All-zero matrices (an uncalibrated camera), numbers that are not finite, an impossible size or focal length, an R that does not rotate.
pub fn check_camera(side: Side, calibration: &CameraCalibration) -> Result<(), CalibrationError> {
    let CameraCalibration { width, height, coefficients, intrinsics: k, rectification: r, projection: p, .. } =
        calibration;
    let odd = |what, found: String, expected: &str| {
        Err(CalibrationError::Odd { side, what, found, expected: expected.to_owned() })
    };
    for (matrix, values) in [("K", &k[..]), ("R", &r[..]), ("P", &p[..])] {
        if values.iter().all(|&value| value == 0.0) {
            return Err(CalibrationError::Uncalibrated { side, matrix });
        }
    }
    for (what, values) in [("K", &k[..]), ("R", &r[..]), ("P", &p[..]), ("distortion D", coefficients)] {
        if !values.iter().all(|value| value.is_finite()) {
            return odd(what, format!("{values:?}"), "finite numbers");
        }
    }
    if header::check_size(*width as usize, *height as usize).is_err() {
        return odd(
            "image size",
            format!("{width} x {height}"),
            "1 to 12000 pixels a side, at most 100 million in all",
        );
    }
    for (what, focal) in [("fx in K", k[0]), ("fy in K", k[4]), ("fx in P", p[0]), ("fy in P", p[5])] {
        if focal <= 0.0 {
            return odd(what, focal.to_string(), "a positive focal length in pixels");
        }
    }
    if (p[0] - p[5]).abs() > FOCAL_TOLERANCE * p[0] {
        return odd("P", format!("fx {}, fy {}", p[0], p[5]), "equal focal lengths, as rectified pairs have");
    }
    let transposed = std::array::from_fn(|i| r[i % 3 * 3 + i / 3]);
    let identity_error =
        lens::product(r, &transposed).iter().zip(IDENTITY).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if identity_error > ROTATION_TOLERANCE {
        return odd("R", format!("{r:?}"), "a rotation matrix");
    }
    Ok(())
}

pub(crate) const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Whether the images that this calibration describes are rectified already: no distortion, R the identity, P's camera matrix equal to K.
pub fn is_rectified(calibration: &CameraCalibration) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(1.0);
    let p = &calibration.projection;
    let camera = [p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]];
    calibration.coefficients.iter().all(|&value| value == 0.0)
        && calibration.rectification.iter().zip(IDENTITY).all(|(&a, b)| same(a, b))
        && calibration.intrinsics.iter().zip(camera).all(|(&a, b)| same(a, b))
}

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
