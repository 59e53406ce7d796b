//! Corrects steps so that they agree with a motion measured over all of them. The error of a step does not shrink with
//! its length, so a chain of many short steps drifts more than one of few long ones.

use crate::motion::Motion;
use crate::se3::{adjoint, motion_from_step, orthonormalise, step_from_motion};
use furrow_model::{Se3, Step, StepCovariance};
use nalgebra::{Matrix6, Vector6};

/// Standard deviations of a step that failed and repeats the motion before: rotation (rad) and translation (m).
const FAILED_STD: [f64; 2] = [0.05, 0.1];

/// Corrects `steps` to agree with `whole`, the motion from the start of the first to the end of the last step, by least
/// squares weighted with the covariances of both. The covariances of the steps stay as they are.
pub(crate) fn reconcile(steps: &mut [Step], whole: &Motion) {
    // The covariance of each step's error, carried to the end of the last step by the adjoint.
    let mut end_from_here = Se3::IDENTITY;
    let mut composed = Matrix6::from_fn(|i, j| whole.covariance[i][j]);
    let mut shares = vec![Matrix6::zeros(); steps.len()];
    for (step, share) in steps.iter().zip(&mut shares).rev() {
        let carried = adjoint(&end_from_here);
        *share = covariance(step) * carried.transpose();
        composed += carried * *share;
        end_from_here = end_from_here.compose(&step.earlier_from_later.inverse());
    }
    let Some(composed) = composed.cholesky() else { return };
    let correction = composed.solve(&step_from_motion(&end_from_here.compose(&whole.previous_from_current)));
    for (step, share) in steps.iter_mut().zip(&shares) {
        step.earlier_from_later =
            orthonormalise(&step.earlier_from_later.compose(&motion_from_step(&(share * correction))));
    }
}

/// The covariance of a step, as a full matrix.
fn covariance(step: &Step) -> Matrix6<f64> {
    let Some(StepCovariance(upper)) = step.covariance.filter(|_| step.valid) else {
        let [rad, m] = FAILED_STD.map(|std| std * std);
        return Matrix6::from_diagonal(&Vector6::new(rad, rad, rad, m, m, m));
    };
    let mut entries = upper.into_iter();
    let mut matrix = Matrix6::zeros();
    for i in 0..6 {
        for j in i..6 {
            let entry = entries.next().unwrap_or_default();
            (matrix[(i, j)], matrix[(j, i)]) = (entry, entry);
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::uniform;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn make_step(earlier_from_later: Se3, std: f64, valid: bool) -> Step {
        let matrix = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { std * std } else { 0.0 }));
        let covariance = Some(StepCovariance::of(&matrix));
        Step { from_ns: 0, to_ns: 1, earlier_from_later, matches: 100, inliers: 80, valid, covariance }
    }

    fn make_whole(previous_from_current: Se3, std: f64) -> Motion {
        let covariance = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { std * std } else { 0.0 }));
        Motion { previous_from_current, matches: 100, inliers: 80, rms_px: 0.3, covariance }
    }

    fn composed(steps: &[Step]) -> Se3 {
        steps.iter().fold(Se3::IDENTITY, |pose, step| pose.compose(&step.earlier_from_later))
    }

    #[test]
    fn an_exact_whole_is_met_and_an_inexact_one_changes_nothing() {
        let truth = Se3::from_quaternion([0.01, -0.02, 0.005, 1.0], [0.01, 0.02, 0.2]);
        let off = Se3::from_quaternion([0.001, 0.0005, -0.001, 1.0], [0.002, -0.001, 0.003]);
        let wrong = vec![make_step(truth.compose(&off), 0.01, true); 4];
        let whole = composed(&vec![make_step(truth, 0.01, true); 4]);
        let mut sure = wrong.clone();
        reconcile(&mut sure, &make_whole(whole, 1e-7));
        let left = whole.inverse().compose(&composed(&sure));
        assert!(left.distance_m() < 1e-4 && left.angle_rad() < 1e-4, "{left:?}");
        let mut vague = wrong.clone();
        reconcile(&mut vague, &make_whole(whole, 1e4));
        let moved = composed(&wrong).inverse().compose(&composed(&vague));
        assert!(moved.distance_m() < 1e-6 && moved.angle_rad() < 1e-6, "{moved:?}");
    }

    #[test]
    fn only_the_failed_step_is_corrected() {
        let ahead = |m: f64| Se3 { translation_m: [0.0, 0.0, m], ..Se3::IDENTITY };
        let mut steps = vec![
            make_step(ahead(0.1), 1e-4, true),
            make_step(ahead(0.02), 1e-4, false),
            make_step(ahead(0.1), 1e-4, true),
        ];
        reconcile(&mut steps, &make_whole(ahead(0.3), 1e-4));
        for step in &steps {
            assert!((step.earlier_from_later.translation_m[2] - 0.1).abs() < 1e-4, "{step:?}");
        }
        assert!(!steps[1].valid);
    }

    #[test]
    fn reconciled_chains_scatter_less() {
        // Four steps and a whole, all with errors of the same variance. The chain of four has four times that variance;
        // combined with the whole it has 4 * 1 / (4 + 1) of it, a fifth.
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let truth = Se3::from_quaternion([0.0, 0.03, 0.0, 1.0], [0.0, 0.0, 0.1]);
        let (mut alone, mut together) = (0.0, 0.0);
        for _ in 0..2000 {
            let mut noisy = || {
                let step = Vector6::from_fn(|i, _| uniform(&mut rng, -1.0, 1.0) * if i < 3 { 1e-5 } else { 1e-2 });
                motion_from_step(&step)
            };
            let matrix = std::array::from_fn(|i| {
                std::array::from_fn(|j| {
                    if i != j {
                        0.0
                    } else if i < 3 {
                        1e-10 / 3.0
                    } else {
                        1e-4 / 3.0
                    }
                })
            });
            let mut steps: Vec<Step> = (0..4)
                .map(|_| Step {
                    covariance: Some(StepCovariance::of(&matrix)),
                    ..make_step(truth.compose(&noisy()), 1.0, true)
                })
                .collect();
            let whole = composed(&vec![make_step(truth, 1.0, true); 4]);
            let measured = Motion { covariance: matrix, ..make_whole(whole.compose(&noisy()), 1.0) };
            let error = |steps: &[Step]| whole.inverse().compose(&composed(steps)).distance_m().powi(2);
            alone += error(&steps);
            reconcile(&mut steps, &measured);
            together += error(&steps);
        }
        let ratio = together / alone;
        assert!((ratio - 0.2).abs() < 0.02, "{ratio}");
    }
}
