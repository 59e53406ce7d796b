//! Where a camera shows a point, written down once more from the published formulas, as an oracle.

use furrow_model::{CameraCalibration, Distortion};

/// m · v.
pub fn rotated(m: &[f64; 9], v: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|row| m[3 * row] * v[0] + m[3 * row + 1] * v[1] + m[3 * row + 2] * v[2])
}

/// The recorded pixel of a point in the camera's own frame: OpenCV's models, with thin prism and tilted sensor.
pub fn seen_at(camera: &CameraCalibration, [x, y, z]: [f64; 3]) -> [f64; 2] {
    let d = |i: usize| camera.coefficients.get(i).copied().unwrap_or(0.0);
    let (a, b) = (x / z, y / z);
    let r2 = a * a + b * b;
    let [a, b] = match camera.distortion {
        Distortion::Equidistant => {
            let r = r2.sqrt();
            let t = r.atan();
            let bent = t * (1.0 + d(0) * t.powi(2) + d(1) * t.powi(4) + d(2) * t.powi(6) + d(3) * t.powi(8));
            let scale = if r > 0.0 { bent / r } else { 1.0 };
            [a * scale, b * scale]
        }
        Distortion::RadialTangential => {
            let radial = (1.0 + d(0) * r2 + d(1) * r2 * r2 + d(4) * r2.powi(3))
                / (1.0 + d(5) * r2 + d(6) * r2 * r2 + d(7) * r2.powi(3));
            let bent = [
                a * radial + 2.0 * d(2) * a * b + d(3) * (r2 + 2.0 * a * a) + d(8) * r2 + d(9) * r2 * r2,
                b * radial + d(2) * (r2 + 2.0 * b * b) + 2.0 * d(3) * a * b + d(10) * r2 + d(11) * r2 * r2,
            ];
            tilted(d(12), d(13), bent)
        }
    };
    let k = &camera.intrinsics;
    [k[0] * a + k[2], k[4] * b + k[5]]
}

/// OpenCV's tilted sensor: the ray's point on a plane turned by tau_x and tau_y.
fn tilted(tau_x: f64, tau_y: f64, [a, b]: [f64; 2]) -> [f64; 2] {
    let (sx, cx) = tau_x.sin_cos();
    let (sy, cy) = tau_y.sin_cos();
    let turn = [cy, sy * sx, -sy * cx, 0.0, cx, sx, sy, -cy * sx, cy * cx];
    let [x, y, z] = rotated(&turn, [a, b, 1.0]);
    let [x, y, z] = [turn[8] * x - turn[2] * z, turn[8] * y - turn[5] * z, z];
    [x / z, y / z]
}
