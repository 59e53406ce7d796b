//! SE(3) near a pose: small steps, the motions they stand for, and the adjoint.
//!
//! A step is six numbers: rotation about x, y, z (rad), then translation along x, y, z (m).

use furrow_model::Se3;
use nalgebra::{Matrix6, Vector6};

/// The motion of a small step. Its rotation is the unit quaternion of (omega / 2, 1): exact to second order, which is
/// enough for Gauss-Newton, and without transcendental functions.
pub(crate) fn motion_from_step(step: &Vector6<f64>) -> Se3 {
    let quaternion = [step[0] / 2.0, step[1] / 2.0, step[2] / 2.0, 1.0];
    Se3::from_quaternion(quaternion, [step[3], step[4], step[5]])
}

/// The step that [`motion_from_step`] turns into `motion`.
pub(crate) fn step_from_motion(motion: &Se3) -> Vector6<f64> {
    let [x, y, z, w] = motion.quaternion_xyzw();
    let t = motion.translation_m;
    Vector6::new(2.0 * x / w, 2.0 * y / w, 2.0 * z / w, t[0], t[1], t[2])
}

/// The adjoint of SE(3): a small step in frame a times this matrix is the same step in frame b.
pub(crate) fn adjoint(b_from_a: &Se3) -> Matrix6<f64> {
    let (r, [x, y, z]) = (&b_from_a.rotation, b_from_a.translation_m);
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    Matrix6::from_fn(|i, j| match (i / 3, j / 3) {
        (0, 0) => r[i][j],
        (1, 1) => r[i - 3][j - 3],
        (1, 0) => (0..3).map(|k| cross[i - 3][k] * r[k][j]).sum(),
        _ => 0.0,
    })
}

/// The same motion with an orthonormal rotation: rounding errors of earlier products are removed.
pub(crate) fn orthonormalise(motion: &Se3) -> Se3 {
    Se3::from_quaternion(motion.quaternion_xyzw(), motion.translation_m)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_survives_the_way_to_a_motion_and_back() {
        let step = Vector6::new(0.02, -0.01, 0.03, 0.4, -0.5, 0.6);
        assert!((step_from_motion(&motion_from_step(&step)) - step).norm() < 1e-12);
    }

    #[test]
    fn the_adjoint_moves_a_step_to_another_frame() {
        let b_from_a = Se3::from_quaternion([0.1, -0.3, 0.2, 1.0], [2.0, -1.0, 0.5]);
        let step = Vector6::new(2e-5, -1e-5, 3e-5, 4e-5, -5e-5, 6e-5);
        let in_b = b_from_a.compose(&motion_from_step(&step)).compose(&b_from_a.inverse());
        assert!((step_from_motion(&in_b) - adjoint(&b_from_a) * step).norm() < 1e-8);
    }
}
