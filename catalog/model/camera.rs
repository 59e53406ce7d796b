//! Calibrations as they were recorded, and the rectified rig that everything after ingest works with.

use serde::{Deserialize, Serialize};

/// How a lens bends the image.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Distortion {
    /// Radial and tangential, 4, 5, 8, 12 or 14 coefficients (k1 k2 p1 p2 k3 k4 k5 k6, thin prism s1 s2 s3 s4, tilt
    /// tau_x tau_y): ROS `plumb_bob` and `rational_polynomial`.
    RadialTangential,
    /// Equidistant fisheye, 4 coefficients: ROS `equidistant`, `fisheye`, `Kannala_Brandt4`.
    Equidistant,
}

/// One camera of a stereo pair as `sensor_msgs/CameraInfo` describes it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CameraCalibration {
    /// Columns of the recorded image.
    pub width: u32,
    /// Rows of the recorded image.
    pub height: u32,
    /// The lens model.
    pub distortion: Distortion,
    /// Its coefficients; all zero or none where the stream is rectified already.
    pub coefficients: Vec<f64>,
    /// K, 3x3 by rows, pixels.
    pub intrinsics: [f64; 9],
    /// R, 3x3 by rows: rectified frame from camera frame.
    pub rectification: [f64; 9],
    /// P, 3x4 by rows, pixels: image from rectified frame; the right camera's `P[3]` is -fx * baseline.
    pub projection: [f64; 12],
}

/// A rectified stereo pair: both images share focal length and rows; the right camera sits `baseline_m` along +x of the
/// left. A single camera is a rig without a baseline.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct StereoRig {
    /// Columns of a rectified image.
    pub width: u32,
    /// Rows of a rectified image.
    pub height: u32,
    /// Focal length in pixels.
    pub focal_px: f64,
    /// Principal point, column, in pixels.
    pub cu_px: f64,
    /// Principal point, row, in pixels.
    pub cv_px: f64,
    /// Distance between the cameras in metres; 0 for a single camera.
    pub baseline_m: f64,
}

impl StereoRig {
    /// Whether there are two cameras, so that distances can be measured.
    pub fn is_pair(&self) -> bool {
        self.baseline_m > 0.0
    }

    /// The point (metres, left camera frame) seen at left column `u`, row `v` with `disparity_px` > 0: Z = f B / d.
    pub fn triangulate(&self, u_px: f64, v_px: f64, disparity_px: f64) -> [f64; 3] {
        let z = self.focal_px * self.baseline_m / disparity_px;
        [(u_px - self.cu_px) * z / self.focal_px, (v_px - self.cv_px) * z / self.focal_px, z]
    }

    /// Where the left camera sees `point_m` (its own frame), in pixels: (u, v). Meaningful for z > 0.
    pub fn project(&self, point_m: [f64; 3]) -> [f64; 2] {
        let [x, y, z] = point_m;
        [self.focal_px * x / z + self.cu_px, self.focal_px * y / z + self.cv_px]
    }
}
