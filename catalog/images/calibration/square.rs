//! Rectified pairs whose pixels are not square: P has unlike fx and fy, as some drivers write it who never touch rows.

use super::check::FOCAL_TOLERANCE;
use super::stereo::StereoCalibration;
use crate::images::matrix::IDENTITY;
use furrow_model::CameraCalibration;

/// Focal lengths that differ by more than this share are no pixel shape but a fault.
const MOST_UNLIKE: f64 = 0.05;

/// The same pair seen through square pixels, where P's fy is not its fx, on both sides alike; `None` where there is
/// nothing to do, or the numbers are too unlike. Rows of rectified images are then resampled by fx / fy about the upper
/// edge.
pub fn squared(calibration: &StereoCalibration) -> Option<StereoCalibration> {
    let shape = |camera: &CameraCalibration| camera.projection[5] / camera.projection[0];
    let [left, right] = [shape(&calibration.left), shape(&calibration.right)];
    let is_unlike = (left - 1.0).abs() > FOCAL_TOLERANCE && (left - 1.0).abs() <= MOST_UNLIKE;
    let is_pair = (left - right).abs() <= FOCAL_TOLERANCE;
    if !(is_unlike && is_pair) {
        return None;
    }
    let square = |camera: &CameraCalibration| {
        let p = &camera.projection;
        let mut square = camera.clone();
        if calibration.stream_is_rectified {
            square.coefficients = Vec::new();
            square.rectification = IDENTITY;
            square.intrinsics = [p[0], p[1], p[2], p[4], p[5], p[6], p[8], p[9], p[10]];
        }
        // The upper edge stays where it is: v' + 0.5 = (v + 0.5) fx / fy.
        square.projection[5] = p[0];
        square.projection[6] = (p[6] + 0.5) / left - 0.5;
        square
    };
    Some(StereoCalibration {
        left: square(&calibration.left),
        right: square(&calibration.right),
        rectified_size: calibration.rectified_size.filter(|_| !calibration.stream_is_rectified),
        stream_is_rectified: false,
    })
}
