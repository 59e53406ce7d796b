//! A camera without a partner: images that are looked at as they are.

use super::check::{check_camera, is_rectified};
use super::error::CalibrationError;
use crate::images::error::ImageError;
use crate::images::matrix::IDENTITY;
use crate::images::side::Side;
use furrow_model::{CameraCalibration, Distortion, StereoRig};
use serde::{Deserialize, Serialize};

/// The stored record of a single camera's calibration. Its images are free of distortion, or taken to be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SingleCamera {
    /// The camera.
    pub camera: CameraCalibration,
    /// Whether it was assumed from a field of view, not measured: directions are then a guess, and nothing should be
    /// made of metres.
    pub is_assumed: bool,
}

impl SingleCamera {
    /// A camera that was not calibrated: square pixels, the principal point in the image's middle, `field_of_view_deg`
    /// from its left edge to its right one.
    ///
    /// # Errors
    /// Sizes that no image has, and a field of view that is not between 0 and 180 degrees.
    pub fn assumed(width: u32, height: u32, field_of_view_deg: f64) -> Result<Self, CalibrationError> {
        let half_rad = field_of_view_deg.to_radians() / 2.0;
        let focal = f64::from(width) / 2.0 * libm::cos(half_rad) / libm::sin(half_rad);
        if !(field_of_view_deg > 0.0 && field_of_view_deg < 180.0 && focal.is_finite()) {
            return Err(CalibrationError::BadValue {
                side: Side::Left,
                what: "field of view",
                found: format!("{field_of_view_deg} degrees"),
                expected: "more than 0 and less than 180 degrees".to_owned(),
            });
        }
        let (cu, cv) = (f64::from(width) / 2.0 - 0.5, f64::from(height) / 2.0 - 0.5);
        let camera = CameraCalibration {
            width,
            height,
            distortion: Distortion::RadialTangential,
            coefficients: Vec::new(),
            intrinsics: [focal, 0.0, cu, 0.0, focal, cv, 0.0, 0.0, 1.0],
            rectification: IDENTITY,
            projection: [focal, 0.0, cu, 0.0, 0.0, focal, cv, 0.0, 0.0, 0.0, 1.0, 0.0],
        };
        check_camera(Side::Left, &camera)?;
        Ok(Self { camera, is_assumed: true })
    }

    /// The rig: one camera, no baseline.
    ///
    /// # Errors
    /// As [`check_camera`]; a camera whose images are not rectified.
    pub fn rig(&self) -> Result<StereoRig, CalibrationError> {
        check_camera(Side::Left, &self.camera)?;
        if !is_rectified(&self.camera) {
            return Err(CalibrationError::BadValue {
                side: Side::Left,
                what: "lens",
                found: format!("distortion {:?}", self.camera.coefficients),
                expected: "images of a single camera to be free of distortion: undistort them first".to_owned(),
            });
        }
        let CameraCalibration { width, height, projection: p, .. } = &self.camera;
        Ok(StereoRig { width: *width, height: *height, focal_px: p[0], cu_px: p[2], cv_px: p[6], baseline_m: 0.0 })
    }

    /// Whether an image of `side` may be this camera's.
    ///
    /// # Errors
    /// A right image, and an image of another size than the calibration's.
    pub fn check_size(&self, side: Side, found_width: usize, found_height: usize) -> Result<(), ImageError> {
        let (width, height) = (self.camera.width, self.camera.height);
        match side {
            Side::Right => Err(ImageError::SingleCamera),
            Side::Left if (found_width, found_height) == (width as usize, height as usize) => Ok(()),
            Side::Left => Err(ImageError::NotOfTheCalibration { side, found_width, found_height, width, height }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_assumed_field_of_view_is_that_of_the_image() {
        let rig = SingleCamera::assumed(640, 360, 90.0).unwrap().rig().unwrap();
        assert!((rig.focal_px - 320.0).abs() < 1e-9 && rig.baseline_m == 0.0, "{rig:?}");
        assert_eq!((rig.cu_px, rig.cv_px), (319.5, 179.5));
        for wrong in [0.0, -3.0, 180.0, 400.0, f64::NAN, f64::INFINITY] {
            let said = SingleCamera::assumed(640, 360, wrong).unwrap_err().to_string();
            assert!(said.contains("less than 180 degrees"), "{said}");
        }
    }

    #[test]
    fn images_of_another_size_or_side_or_lens_are_refused() {
        let mut camera = SingleCamera::assumed(8, 6, 60.0).unwrap();
        assert!(camera.is_assumed);
        assert!(camera.check_size(Side::Left, 8, 6).is_ok());
        assert!(matches!(camera.check_size(Side::Left, 6, 8), Err(ImageError::NotOfTheCalibration { .. })));
        assert!(matches!(camera.check_size(Side::Right, 8, 6), Err(ImageError::SingleCamera)));
        camera.camera.coefficients = vec![0.1, 0.0, 0.0, 0.0];
        assert!(camera.rig().unwrap_err().to_string().contains("undistort"));
    }
}
