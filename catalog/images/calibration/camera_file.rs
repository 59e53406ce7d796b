//! One camera as a calibration file tells of it: with rectification, or with its place on the rig, or alone.

use super::error::{CalibrationError, CalibrationFileError};
use super::stereo::fit_to_image;
use crate::images::matrix::IDENTITY;
use crate::images::rectify::pose::Pose;
use furrow_model::{CameraCalibration, Distortion};

/// A camera of a calibration file.
#[derive(Debug, Clone, PartialEq)]
pub struct FileCamera {
    /// The file and the camera in it, for errors.
    pub what: String,
    /// The camera. Its size is 0 x 0 where the file tells none; R is the identity and P is K where it tells none.
    pub camera: CameraCalibration,
    /// Whether the file tells R and P.
    pub is_aligned: bool,
    /// Columns and rows of the rectified images that the file's P is for, where it tells.
    pub rectified_size: Option<[u32; 2]>,
    /// Where the camera sits, from a frame that the file's other cameras share; metres.
    pub camera_from_body: Option<Pose>,
}

impl FileCamera {
    /// A camera of which only the lens is known yet.
    pub fn new(
        what: String,
        size: Option<[u32; 2]>,
        intrinsics: [f64; 9],
        (distortion, coefficients): (Distortion, Vec<f64>),
    ) -> Self {
        let [width, height] = size.unwrap_or_default();
        let k = intrinsics;
        let camera = CameraCalibration {
            width,
            height,
            distortion,
            coefficients,
            intrinsics,
            rectification: IDENTITY,
            projection: [k[0], k[1], k[2], 0.0, k[3], k[4], k[5], 0.0, k[6], k[7], k[8], 0.0],
        };
        Self { what, camera, is_aligned: false, rectified_size: None, camera_from_body: None }
    }

    /// The camera for images of `columns` x `rows`: scaled where it was calibrated at another resolution.
    ///
    /// # Errors
    /// Where the shape differs.
    pub fn fit(&mut self, [columns, rows]: [u32; 2]) -> Result<(), CalibrationFileError> {
        if [self.camera.width, self.camera.height] == [0, 0] {
            [self.camera.width, self.camera.height] = [columns, rows];
        }
        if [self.camera.width, self.camera.height] != [columns, rows] {
            let from = [self.camera.width, self.camera.height];
            self.camera = fit_to_image(&self.camera, columns, rows).map_err(|source| self.refuse(source))?;
            let scaled =
                |size: u32, to: u32, from: u32| (u64::from(size) * u64::from(to) / u64::from(from.max(1))) as u32;
            self.rectified_size =
                self.rectified_size.map(|[c, r]| [scaled(c, columns, from[0]), scaled(r, rows, from[1])]);
        }
        Ok(())
    }

    /// What is wrong with this camera.
    pub fn refuse(&self, source: CalibrationError) -> CalibrationFileError {
        CalibrationFileError::Camera { what: self.what.clone(), source: Box::new(source) }
    }
}
