//! Rigid transforms. A value named `b_from_a` maps coordinates in frame a to frame b, so that
//! `c_from_a = c_from_b.compose(&b_from_a)` reads right and a wrong composition looks wrong.

use serde::{Deserialize, Serialize};

/// A rigid transform: x_b = R x_a + t.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Se3 {
    /// The rotation matrix R, row by row.
    pub rotation: [[f64; 3]; 3],
    /// The translation t in metres.
    pub translation_m: [f64; 3],
}

impl Se3 {
    /// The transform that moves nothing.
    pub const IDENTITY: Se3 =
        Se3 { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], translation_m: [0.0; 3] };

    /// c_from_a, where `self` is c_from_b.
    pub fn compose(&self, b_from_a: &Se3) -> Se3 {
        let mut rotation = [[0.0; 3]; 3];
        for (i, row) in rotation.iter_mut().enumerate() {
            for (j, value) in row.iter_mut().enumerate() {
                *value = (0..3).map(|k| self.rotation[i][k] * b_from_a.rotation[k][j]).sum();
            }
        }
        Se3 { rotation, translation_m: self.apply(b_from_a.translation_m) }
    }

    /// a_from_b, where `self` is b_from_a.
    pub fn inverse(&self) -> Se3 {
        let r = &self.rotation;
        let rotation = [[r[0][0], r[1][0], r[2][0]], [r[0][1], r[1][1], r[2][1]], [r[0][2], r[1][2], r[2][2]]];
        let turned = Se3 { rotation, translation_m: [0.0; 3] }.apply(self.translation_m);
        Se3 { rotation, translation_m: turned.map(|v| -v) }
    }

    /// The point `point_a` in frame b.
    pub fn apply(&self, point_a: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|i| (0..3).map(|k| self.rotation[i][k] * point_a[k]).sum::<f64>() + self.translation_m[i])
    }

    /// The length of the translation in metres.
    pub fn distance_m(&self) -> f64 {
        self.translation_m.iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    /// The rotation about the camera's vertical axis in radians, atan2(R13, R33), positive to the right.
    pub fn yaw_rad(&self) -> f64 {
        libm::atan2(self.rotation[0][2], self.rotation[2][2])
    }

    /// The angle of the rotation in radians, 0 to pi.
    pub fn angle_rad(&self) -> f64 {
        let trace = self.rotation[0][0] + self.rotation[1][1] + self.rotation[2][2];
        libm::acos(((trace - 1.0) / 2.0).clamp(-1.0, 1.0))
    }

    /// The transform with the unit quaternion (x, y, z, w) and translation; the quaternion is normalised.
    pub fn from_quaternion(xyzw: [f64; 4], translation_m: [f64; 3]) -> Se3 {
        let norm = xyzw.iter().map(|v| v * v).sum::<f64>().sqrt();
        let [x, y, z, w] = xyzw.map(|v| v / norm);
        let rotation = [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
            [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
            [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
        ];
        Se3 { rotation, translation_m }
    }

    /// The rotation as a unit quaternion (x, y, z, w) with w >= 0, by the largest of the four components (Shepperd
    /// 1978).
    pub fn quaternion_xyzw(&self) -> [f64; 4] {
        let r = &self.rotation;
        let trace = r[0][0] + r[1][1] + r[2][2];
        let squares = [r[0][0], r[1][1], r[2][2], trace];
        let largest = (0..4).fold(3, |best, i| if squares[i] > squares[best] { i } else { best });
        let mut q = [0.0; 4];
        if largest == 3 {
            let s = 2.0 * (1.0 + trace).sqrt();
            q = [(r[2][1] - r[1][2]) / s, (r[0][2] - r[2][0]) / s, (r[1][0] - r[0][1]) / s, s / 4.0];
        } else {
            let (i, j, k) = (largest, (largest + 1) % 3, (largest + 2) % 3);
            let s = 2.0 * (1.0 + r[i][i] - r[j][j] - r[k][k]).sqrt();
            q[i] = s / 4.0;
            q[j] = (r[j][i] + r[i][j]) / s;
            q[k] = (r[k][i] + r[i][k]) / s;
            q[3] = (r[k][j] - r[j][k]) / s;
        }
        if q[3] < 0.0 { q.map(|v| -v) } else { q }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: &Se3, b: &Se3) -> bool {
        let flat = |s: &Se3| s.rotation.iter().flatten().chain(&s.translation_m).copied().collect::<Vec<_>>();
        flat(a).iter().zip(flat(b)).all(|(x, y)| (x - y).abs() < 1e-12)
    }

    #[test]
    fn inverse_undoes_and_quaternions_read_back() {
        for q in [[0.0, 0.0, 0.0, 1.0], [0.5, -0.5, 0.5, 0.5], [1.0, 0.0, 0.0, 1e-9], [0.1, 0.9, -0.3, -0.2]] {
            let b_from_a = Se3::from_quaternion(q, [1.0, -2.0, 3.0]);
            assert!(close(&b_from_a.compose(&b_from_a.inverse()), &Se3::IDENTITY));
            let again = Se3::from_quaternion(b_from_a.quaternion_xyzw(), b_from_a.translation_m);
            assert!(close(&again, &b_from_a), "{q:?}");
        }
    }

    #[test]
    fn yaw_is_the_turn_about_the_vertical_axis() {
        let half = 0.3_f64 / 2.0;
        let turn = Se3::from_quaternion([0.0, half.sin(), 0.0, half.cos()], [0.0; 3]);
        assert!((turn.yaw_rad() - 0.3).abs() < 1e-12);
        assert!((turn.angle_rad() - 0.3).abs() < 1e-12);
    }
}
