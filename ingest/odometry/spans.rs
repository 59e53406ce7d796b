//! Longer steps beside the short ones: what a step is wrong by does not shrink with its length, so that frame by frame a slow drive drifts more
//! than a fast one. Stretches of the chain are compared from end to end as well, and their steps made to agree by least squares.

use crate::motion::{orthonormal, small_motion};
use crate::odometry::Motion;
use furrow_model::{Se3, Step, StepCovariance};
use nalgebra::{Matrix6, Vector6};

/// When a stretch of the chain is complete, whichever comes first.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SpanPolicy {
    /// Metres travelled.
    pub length_m: f64,
    /// Radians turned, in whatever directions.
    pub turn_rad: f64,
}

impl Default for SpanPolicy {
    /// As far as neighbouring frames of a drive at street speed are apart: matches are still plenty.
    fn default() -> Self {
        Self { length_m: 0.4, turn_rad: 0.1 }
    }
}

impl SpanPolicy {
    /// The numbers of the steps that end a stretch, ascending; the first stretch begins with step 0, and what is behind the last end is not
    /// complete yet.
    pub fn ends(&self, steps: &[Step]) -> Vec<usize> {
        let (mut length_m, mut turn_rad) = (0.0, 0.0);
        let mut ends = Vec::new();
        for (i, step) in steps.iter().enumerate() {
            length_m += step.from_to.distance_m();
            turn_rad += step.from_to.angle_rad();
            if length_m >= self.length_m || turn_rad >= self.turn_rad {
                ends.push(i);
                (length_m, turn_rad) = (0.0, 0.0);
            }
        }
        ends
    }
}

/// One standard deviation of a step that failed and repeats the one before: rotation, rad, and translation, m.
const FAILED_SIGMA: [f64; 2] = [0.05, 0.1];

/// Moves `steps` to where they and `whole` (the first's beginning from the last's end), each by its covariance, agree best. Covariances are left
/// as they are.
pub(crate) fn reconcile(steps: &mut [Step], whole: &Motion) {
    // Each step's error, seen from the end of the last one.
    let mut end_from_here = Se3::IDENTITY;
    let mut composed = Matrix6::from_fn(|i, j| whole.covariance[i][j]);
    let mut shares = vec![Matrix6::zeros(); steps.len()];
    for (step, share) in steps.iter().zip(&mut shares).rev() {
        let carried = adjoint(&end_from_here);
        *share = covariance(step) * carried.transpose();
        composed += carried * *share;
        end_from_here = end_from_here.compose(&step.from_to.inverse());
    }
    let Some(composed) = composed.cholesky() else { return };
    let pull = composed.solve(&small_step(&end_from_here.compose(&whole.previous_from_current)));
    for (step, share) in steps.iter_mut().zip(&shares) {
        step.from_to = orthonormal(&step.from_to.compose(&small_motion(&(share * pull))));
    }
}

fn covariance(step: &Step) -> Matrix6<f64> {
    let Some(StepCovariance(upper)) = step.covariance.filter(|_| step.valid) else {
        let [rad, m] = FAILED_SIGMA.map(|sigma| sigma * sigma);
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

/// What a small motion (rotation, translation) of one frame is in another.
fn adjoint(other_from_one: &Se3) -> Matrix6<f64> {
    let (r, [x, y, z]) = (&other_from_one.rotation, other_from_one.translation_m);
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    Matrix6::from_fn(|i, j| match (i / 3, j / 3) {
        (0, 0) => r[i][j],
        (1, 1) => r[i - 3][j - 3],
        (1, 0) => (0..3).map(|k| cross[i - 3][k] * r[k][j]).sum(),
        _ => 0.0,
    })
}

/// The numbers that [`small_motion`] makes `motion` of.
pub(crate) fn small_step(motion: &Se3) -> Vector6<f64> {
    let [x, y, z, w] = motion.quaternion_xyzw();
    let t = motion.translation_m;
    Vector6::new(2.0 * x / w, 2.0 * y / w, 2.0 * z / w, t[0], t[1], t[2])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::tests::uniform;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    fn step_of(from_to: Se3, sigma: f64, valid: bool) -> Step {
        let matrix = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { sigma * sigma } else { 0.0 }));
        let covariance = Some(StepCovariance::of(&matrix));
        Step { from_ns: 0, to_ns: 1, from_to, matches: 100, inliers: 80, valid, covariance }
    }

    fn whole_of(previous_from_current: Se3, sigma: f64) -> Motion {
        let covariance = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { sigma * sigma } else { 0.0 }));
        Motion { previous_from_current, matches: 100, inliers: 80, rms_px: 0.3, covariance }
    }

    fn composed(steps: &[Step]) -> Se3 {
        steps.iter().fold(Se3::IDENTITY, |pose, step| pose.compose(&step.from_to))
    }

    #[test]
    fn stretches_end_where_they_are_long_or_turned_enough() {
        let forward = step_of(Se3 { translation_m: [0.0, 0.0, 0.15], ..Se3::IDENTITY }, 0.01, true);
        let turn = step_of(Se3::from_quaternion([0.0, 0.06, 0.0, 1.0], [0.0; 3]), 0.01, true);
        let policy = SpanPolicy { length_m: 0.4, turn_rad: 0.1 };
        let steps = [forward, forward, forward, forward, turn, forward, forward];
        assert_eq!(policy.ends(&steps), [2, 4]);
        assert!(policy.ends(&[]).is_empty());
    }

    #[test]
    fn a_sure_whole_is_met_and_a_vague_one_changes_nothing() {
        let truth = Se3::from_quaternion([0.01, -0.02, 0.005, 1.0], [0.01, 0.02, 0.2]);
        let off = Se3::from_quaternion([0.001, 0.0005, -0.001, 1.0], [0.002, -0.001, 0.003]);
        let wrong = vec![step_of(truth.compose(&off), 0.01, true); 4];
        let whole = composed(&vec![step_of(truth, 0.01, true); 4]);
        let mut sure = wrong.clone();
        reconcile(&mut sure, &whole_of(whole, 1e-7));
        let left = whole.inverse().compose(&composed(&sure));
        assert!(left.distance_m() < 1e-4 && left.angle_rad() < 1e-4, "{left:?}");
        let mut vague = wrong.clone();
        reconcile(&mut vague, &whole_of(whole, 1e4));
        let moved = composed(&wrong).inverse().compose(&composed(&vague));
        assert!(moved.distance_m() < 1e-6 && moved.angle_rad() < 1e-6, "{moved:?}");
    }

    #[test]
    fn what_a_failed_step_lacks_is_given_to_it_alone() {
        let ahead = |m: f64| Se3 { translation_m: [0.0, 0.0, m], ..Se3::IDENTITY };
        let mut steps =
            vec![step_of(ahead(0.1), 1e-4, true), step_of(ahead(0.02), 1e-4, false), step_of(ahead(0.1), 1e-4, true)];
        reconcile(&mut steps, &whole_of(ahead(0.3), 1e-4));
        for step in &steps {
            assert!((step.from_to.translation_m[2] - 0.1).abs() < 1e-4, "{step:?}");
        }
        assert!(!steps[1].valid);
    }

    #[test]
    fn reconciled_chains_scatter_less() {
        // Four steps and a whole, all wrong by one centimetre and milliradian (uniform, equal variances): a chain of four has twice that, and
        // together with the whole 4 * 1 / (4 + 1) of one variance.
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let truth = Se3::from_quaternion([0.0, 0.03, 0.0, 1.0], [0.0, 0.0, 0.1]);
        let (mut alone, mut together) = (0.0, 0.0);
        for _ in 0..2000 {
            let mut noisy = || {
                let step = Vector6::from_fn(|i, _| uniform(&mut rng, -1.0, 1.0) * if i < 3 { 1e-5 } else { 1e-2 });
                small_motion(&step)
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
                    ..step_of(truth.compose(&noisy()), 1.0, true)
                })
                .collect();
            let whole = composed(&vec![step_of(truth, 1.0, true); 4]);
            let measured = Motion { covariance: matrix, ..whole_of(whole.compose(&noisy()), 1.0) };
            let error = |steps: &[Step]| whole.inverse().compose(&composed(steps)).distance_m().powi(2);
            alone += error(&steps);
            reconcile(&mut steps, &measured);
            together += error(&steps);
        }
        let ratio = together / alone;
        assert!((ratio - 0.2).abs() < 0.02, "{ratio}");
    }
}
