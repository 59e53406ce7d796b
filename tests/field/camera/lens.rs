//! The raw lenses of a ZED-like pair: wide, with a moderate barrel, each mounted a little askew and a little off its
//! sensor's middle.

use furrow_model::{CameraCalibration, Distortion, Se3, StereoRig};

/// What makes one lens: lengths as shares of the image's width.
struct Make {
    /// Focal lengths fx, fy.
    focal: [f64; 2],
    /// Principal point from the image's centre.
    centre: [f64; 2],
    /// k1 k2 p1 p2 k3.
    bend: [f64; 5],
    /// Rotation of the raw camera against the rectified frame, about its axes, in radians.
    askew: [f64; 3],
}

/// Left and right.
const MAKES: [Make; 2] = [
    Make {
        focal: [0.4187, 0.4179],
        centre: [0.0095, -0.0041],
        bend: [-0.1712, 0.0296, 0.00041, -0.00033, 0.00031],
        askew: [0.0021, -0.0043, 0.0017],
    },
    Make {
        focal: [0.4175, 0.4184],
        centre: [-0.0072, 0.0037],
        bend: [-0.1695, 0.0291, -0.00027, 0.00046, 0.00024],
        askew: [-0.0016, 0.0034, -0.0026],
    },
];

/// One raw camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Lens {
    calibration: CameraCalibration,
}

impl Lens {
    /// The camera on this `side` (0 left, 1 right) whose rectified images are those of `rig`.
    pub fn of(side: usize, rig: &StereoRig) -> Lens {
        let (make, width) = (&MAKES[side], f64::from(rig.width));
        let centre = |size: u32, share: f64| 0.5 * (f64::from(size) - 1.0) + share * width;
        let (cu, cv) = (centre(rig.width, make.centre[0]), centre(rig.height, make.centre[1]));
        let [x, y, z] = make.askew.map(|angle| 0.5 * angle);
        let length = (1.0 + x * x + y * y + z * z).sqrt();
        let raw = Se3::from_quaternion([x, y, z, 1.0].map(|c| c / length), [0.0; 3]);
        Lens {
            calibration: CameraCalibration {
                width: rig.width,
                height: rig.height,
                distortion: Distortion::RadialTangential,
                coefficients: make.bend.to_vec(),
                intrinsics: [make.focal[0] * width, 0.0, cu, 0.0, make.focal[1] * width, cv, 0.0, 0.0, 1.0],
                rectification: std::array::from_fn(|i| raw.rotation[i / 3][i % 3]),
                projection: projection(side, rig),
            },
        }
    }

    /// What `sensor_msgs/CameraInfo` says of it.
    pub fn calibration(&self) -> &CameraCalibration {
        &self.calibration
    }

    /// The direction seen at pixel (`u`, `v`), in the raw camera's axes, as tangents (x / z, y / z).
    pub fn raw_ray(&self, u: f64, v: f64) -> [f64; 2] {
        let k = &self.calibration.intrinsics;
        self.straighten([(u - k[2]) / k[0], (v - k[5]) / k[4]])
    }

    /// The same direction in the rectified camera's axes.
    pub fn rectified(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let r = &self.calibration.rectification;
        let along = |row: usize| r[3 * row] * x + r[3 * row + 1] * y + r[3 * row + 2];
        [along(0) / along(2), along(1) / along(2)]
    }

    /// Undoes the lens by Newton's method: the tangents that are bent to `bent`.
    fn straighten(&self, bent: [f64; 2]) -> [f64; 2] {
        let [k1, k2, p1, p2, k3] = std::array::from_fn(|i| self.calibration.coefficients[i]);
        let [mut x, mut y] = bent;
        for _ in 0..24 {
            let r2 = x * x + y * y;
            let scale = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
            // Twice the derivative of the scale by r2.
            let slope = 2.0 * (k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3));
            let wrong_x = x * scale + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x) - bent[0];
            let wrong_y = y * scale + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y - bent[1];
            let xx = scale + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x;
            let xy = x * y * slope + 2.0 * p1 * x + 2.0 * p2 * y;
            let yy = scale + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x;
            let determinant = xx * yy - xy * xy;
            x -= (yy * wrong_x - xy * wrong_y) / determinant;
            y -= (xx * wrong_y - xy * wrong_x) / determinant;
            if wrong_x.abs() + wrong_y.abs() < 1e-13 {
                break;
            }
        }
        [x, y]
    }
}

/// P of the camera on this side: the rectified image from the rectified left camera's axes.
pub fn projection(side: usize, rig: &StereoRig) -> [f64; 12] {
    let (f, u, v) = (rig.focal_px, rig.cu_px, rig.cv_px);
    let shift = [0.0, -f * rig.baseline_m][side];
    [f, 0.0, u, shift, 0.0, f, v, 0.0, 0.0, 0.0, 1.0, 0.0]
}
