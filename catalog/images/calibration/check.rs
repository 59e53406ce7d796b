//! Whether the numbers of one camera can be.

use super::error::CalibrationError;
use crate::images::header::check_size;
use crate::images::matrix::{IDENTITY, product};
use crate::images::side::Side;
use furrow_model::CameraCalibration;

/// Focal lengths may differ by this share: calibrations are written with 6 or 7 digits.
pub(crate) const FOCAL_TOLERANCE: f64 = 1e-4;
/// R times its transpose may differ from the identity by this much.
const ROTATION_TOLERANCE: f64 = 1e-2;
/// Two numbers this close are the same number, printed and read again.
const SAME: f64 = 1e-6;

/// Checks the numbers of one camera on their own: K, R, P and the size.
///
/// # Errors
/// All-zero matrices (an uncalibrated camera), numbers that are not finite, an impossible size or focal length, an R
/// that does not rotate.
pub fn check_camera(side: Side, calibration: &CameraCalibration) -> Result<(), CalibrationError> {
    let CameraCalibration { width, height, coefficients, intrinsics: k, rectification: r, projection: p, .. } =
        calibration;
    let bad_value = |what, found: String, expected: &str| {
        Err(CalibrationError::BadValue { side, what, found, expected: expected.to_owned() })
    };
    for (matrix, values) in [("K", &k[..]), ("R", &r[..]), ("P", &p[..])] {
        if values.iter().all(|&value| value == 0.0) {
            return Err(CalibrationError::Uncalibrated { side, matrix });
        }
    }
    for (what, values) in [("K", &k[..]), ("R", &r[..]), ("P", &p[..]), ("distortion D", coefficients)] {
        if !values.iter().all(|value| value.is_finite()) {
            return bad_value(what, format!("{values:?}"), "finite numbers");
        }
    }
    if check_size(*width as usize, *height as usize).is_err() {
        return bad_value(
            "image size",
            format!("{width} x {height}"),
            "1 to 12000 pixels a side, at most 100 million in all",
        );
    }
    for (what, focal) in [("fx in K", k[0]), ("fy in K", k[4]), ("fx in P", p[0]), ("fy in P", p[5])] {
        if focal <= 0.0 {
            return bad_value(what, focal.to_string(), "a positive focal length in pixels");
        }
    }
    if (p[0] - p[5]).abs() > FOCAL_TOLERANCE * p[0] {
        return bad_value("P", format!("fx {}, fy {}", p[0], p[5]), "equal focal lengths, as rectified pairs have");
    }
    let transposed = std::array::from_fn(|i| r[i % 3 * 3 + i / 3]);
    let identity_error = product(r, &transposed).iter().zip(IDENTITY).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    if identity_error > ROTATION_TOLERANCE {
        return bad_value("R", format!("{r:?}"), "a rotation matrix");
    }
    Ok(())
}

/// How far the principal point of K is in an image of so many columns and rows, as shares of its width and height.
pub fn centre_shares(k: &[f64; 9], [columns, rows]: [u32; 2]) -> [f64; 2] {
    [(k[2], columns), (k[5], rows)].map(|(centre, pixels)| (centre + 0.5) / f64::from(pixels.max(1)))
}

/// What is odd about a principal point that is far from the middle of its image, as a share of width and height; `None`
/// where it is not.
pub fn far_centre(calibration: &CameraCalibration) -> Option<String> {
    let CameraCalibration { width, height, intrinsics: k, .. } = calibration;
    let [across, down] = centre_shares(k, [*width, *height]);
    let is_far = [across, down].iter().any(|share| !(0.3..=0.7).contains(share));
    is_far.then(|| {
        format!(
            "the principal point ({:.1}, {:.1}) is {across:.2} of the width and {down:.2} of the height in, for images of \
             {width} x {height}: K may be of other images, cut or scaled",
            k[2], k[5]
        )
    })
}

/// Whether the images that this calibration describes are rectified already: no distortion, R the identity, P's camera
/// matrix equal to K.
pub fn is_rectified(calibration: &CameraCalibration) -> bool {
    let same = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(1.0);
    let p = &calibration.projection;
    let camera = [p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]];
    calibration.coefficients.iter().all(|&value| value == 0.0)
        && calibration.rectification.iter().zip(IDENTITY).all(|(&a, b)| same(a, b))
        && calibration.intrinsics.iter().zip(camera).all(|(&a, b)| same(a, b))
}
