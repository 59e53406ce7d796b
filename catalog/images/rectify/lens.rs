//! Where a rectified pixel comes from in the recorded image.
//!
//! The formulas are those of OpenCV's `initUndistortRectifyMap` and `fisheye::initUndistortRectifyMap`, computed here
//! point by point in plain `f64`: OpenCV's own loop uses fused multiply-adds where the processor has them, and equal
//! recordings must give equal images on every machine. Tests hold the two against each other.

use crate::images::calibration::error::CalibrationError;
use crate::images::matrix::{inverse, product};
use crate::images::side::Side;
use furrow_model::{CameraCalibration, Distortion};

/// Rays farther than this from the optical axis (tangent of the angle) are not followed: about 87 degrees.
const MAX_TANGENT: f64 = 20.0;

/// A camera's map from rectified to recorded pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Lens {
    /// (P's left 3x3 block · R)^-1: camera ray from rectified pixel.
    ray_from_pixel: [f64; 9],
    /// fx, fy, cx, cy of K.
    intrinsics: [f64; 4],
    model: Distortion,
    /// k1 k2 p1 p2 k3 k4 k5 k6 s1 s2 s3 s4, or k1 k2 k3 k4 of the equidistant model; zeros where fewer were given.
    coefficients: [f64; 12],
    /// The sensor's tilt, a homography of distorted rays; `None` where it stands upright.
    tilt: Option<[f64; 9]>,
    /// Beyond this tangent the polynomial turns back, and a ray would land on a pixel that shows something else.
    max_tangent: f64,
}

impl Lens {
    /// Takes a checked calibration (see [`check_camera`](crate::images::calibration::check::check_camera)).
    ///
    /// # Errors
    /// A coefficient count that the model does not have, or P · R without an inverse.
    pub fn new(side: Side, calibration: &CameraCalibration) -> Result<Self, CalibrationError> {
        let (coefficients, tilt) = coefficients_of(side, calibration)?;
        let [p0, p1, p2, _, p4, p5, p6, _, p8, p9, p10, _] = calibration.projection;
        let pixel_from_ray = product(&[p0, p1, p2, p4, p5, p6, p8, p9, p10], &calibration.rectification);
        let ray_from_pixel = inverse(&pixel_from_ray).ok_or_else(|| CalibrationError::BadValue {
            side,
            what: "P times R",
            found: "singular".to_owned(),
            expected: "an invertible 3x3 matrix".to_owned(),
        })?;
        let k = calibration.intrinsics;
        let mut lens = Self {
            ray_from_pixel,
            intrinsics: [k[0], k[4], k[2], k[5]],
            model: calibration.distortion,
            coefficients,
            tilt,
            max_tangent: MAX_TANGENT,
        };
        lens.max_tangent = lens.turning_point();
        Ok(lens)
    }

    /// The recorded pixel (x, y) that the rectified pixel (u, v) shows, in pixels; `None` where it lies behind the
    /// camera or beyond what the lens model describes. The result may lie outside the image.
    pub fn source_of(&self, u_px: f64, v_px: f64) -> Option<[f64; 2]> {
        let m = &self.ray_from_pixel;
        let w = m[6] * u_px + m[7] * v_px + m[8];
        if w <= 0.0 {
            return None;
        }
        let x = (m[0] * u_px + m[1] * v_px + m[2]) / w;
        let y = (m[3] * u_px + m[4] * v_px + m[5]) / w;
        let tangent_squared = x * x + y * y;
        if tangent_squared > self.max_tangent * self.max_tangent {
            return None;
        }
        let [x, y] = self.distort(x, y);
        let [fx, fy, cx, cy] = self.intrinsics;
        let source = [fx * x + cx, fy * y + cy];
        source.iter().all(|pixel| pixel.is_finite()).then_some(source)
    }

    /// Bends a ray (x, y, 1).
    fn distort(&self, x: f64, y: f64) -> [f64; 2] {
        let r2 = x * x + y * y;
        let scale = self.radial(r2);
        match self.model {
            Distortion::Equidistant => [x * scale, y * scale],
            Distortion::RadialTangential => {
                let [_, _, p1, p2, .., s1, s2, s3, s4] = self.coefficients;
                let xy2 = 2.0 * x * y;
                self.tilted([
                    x * scale + p1 * xy2 + p2 * (r2 + 2.0 * x * x) + (s1 + s2 * r2) * r2,
                    y * scale + p1 * (r2 + 2.0 * y * y) + p2 * xy2 + (s3 + s4 * r2) * r2,
                ])
            }
        }
    }

    /// Where a distorted ray meets a tilted sensor.
    fn tilted(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let Some(m) = &self.tilt else { return [x, y] };
        let w = m[6] * x + m[7] * y + m[8];
        [(m[0] * x + m[1] * y + m[2]) / w, (m[3] * x + m[4] * y + m[5]) / w]
    }

    /// Distorted over undistorted radius, for a squared tangent `r2`.
    fn radial(&self, r2: f64) -> f64 {
        let k = &self.coefficients;
        match self.model {
            Distortion::RadialTangential => {
                (1.0 + ((k[4] * r2 + k[1]) * r2 + k[0]) * r2) / (1.0 + ((k[7] * r2 + k[6]) * r2 + k[5]) * r2)
            }
            Distortion::Equidistant => {
                let r = r2.sqrt();
                if r == 0.0 {
                    return 1.0;
                }
                let theta = libm::atan(r);
                let t2 = theta * theta;
                theta * (1.0 + (((k[3] * t2 + k[2]) * t2 + k[1]) * t2 + k[0]) * t2) / r
            }
        }
    }

    /// The largest tangent up to which a larger angle is imaged farther out.
    fn turning_point(&self) -> f64 {
        const STEPS_PER_UNIT: u32 = 1024;
        let distorted = |step: u32| {
            let r = f64::from(step) / f64::from(STEPS_PER_UNIT);
            r * self.radial(r * r)
        };
        let steps = MAX_TANGENT as u32 * STEPS_PER_UNIT;
        let turn = (1..=steps).find(|&step| distorted(step) <= distorted(step - 1)).unwrap_or(steps);
        f64::from(turn) / f64::from(STEPS_PER_UNIT)
    }
}

/// The coefficients, filled up with zeros, and the tilt.
type Bending = ([f64; 12], Option<[f64; 9]>);

fn coefficients_of(side: Side, calibration: &CameraCalibration) -> Result<Bending, CalibrationError> {
    let given = &calibration.coefficients;
    let (read, name) = match calibration.distortion {
        Distortion::RadialTangential => (14, "0, 4, 5, 8, 12 or 14 coefficients"),
        Distortion::Equidistant => (4, "0 or 4 coefficients"),
    };
    let (kept, rest) = given.split_at(given.len().min(read));
    let known =
        matches!((calibration.distortion, kept.len()), (_, 0 | 4) | (Distortion::RadialTangential, 5 | 8 | 12 | 14));
    if !known || rest.iter().any(|&value| value != 0.0) {
        return Err(CalibrationError::BadValue {
            side,
            what: "distortion D",
            found: format!("{given:?}"),
            expected: format!("{name} for the {:?} model", calibration.distortion),
        });
    }
    let mut coefficients = [0.0; 12];
    let bent = kept.len().min(12);
    coefficients[..bent].copy_from_slice(&kept[..bent]);
    let tilt = match kept[bent..] {
        [tau_x, tau_y] if tau_x != 0.0 || tau_y != 0.0 => Some(tilt_of(tau_x, tau_y)),
        _ => None,
    };
    Ok((coefficients, tilt))
}

/// OpenCV's homography of a sensor that is turned by `tau_x`, then by `tau_y`, radians.
fn tilt_of(tau_x: f64, tau_y: f64) -> [f64; 9] {
    let ([sx, cx], [sy, cy]) = ([libm::sin(tau_x), libm::cos(tau_x)], [libm::sin(tau_y), libm::cos(tau_y)]);
    let turn = [cy, sy * sx, -sy * cx, 0.0, cx, sx, sy, -cy * sx, cy * cx];
    let [across, down, along] = [turn[2], turn[5], turn[8]];
    product(&[along, 0.0, -across, 0.0, along, -down, 0.0, 0.0, 1.0], &turn)
}
