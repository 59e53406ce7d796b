//! Gauss-Newton: the motion that minimises the weighted squared reprojection errors of observations.

use super::linearise::RESIDUAL;
use super::observation::Observation;
use super::reprojection::Reprojection;
use crate::se3::{motion_from_step, orthonormalise};
use furrow_model::Se3;
use nalgebra::{Matrix6, Vector6};

/// When Gauss-Newton stops.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stop {
    /// It has failed after this many iterations.
    pub max_iterations: usize,
    /// It has converged when every number of a step is below this, in rad and m.
    pub tolerance: f64,
}

/// A step of more metres or radians than this has diverged.
pub(super) const DIVERGED: f64 = 100.0;

impl Reprojection<'_> {
    /// The normal equations J^T W J and J^T W r of a small step (omega, t) applied after `after_from_before`, of
    /// weighted observations.
    pub(super) fn normal_equations<'o>(
        &self,
        after_from_before: &Se3,
        observations: impl Iterator<Item = (&'o Observation, f64)>,
    ) -> (Matrix6<f64>, Vector6<f64>) {
        let (mut matrix, mut vector) = (Matrix6::zeros(), Vector6::zeros());
        for (observation, weight) in observations {
            let Some(rows) = self.linearise(after_from_before, observation) else { continue };
            for row in rows.iter().take(self.residual_count()) {
                for i in 0..6 {
                    let weighted = weight * row[i];
                    vector[i] += weighted * row[RESIDUAL];
                    for j in i..6 {
                        matrix[(j, i)] += weighted * row[j];
                    }
                }
            }
        }
        for i in 0..6 {
            for j in i + 1..6 {
                matrix[(i, j)] = matrix[(j, i)];
            }
        }
        (matrix, vector)
    }

    /// The motion (after_from_before) of weighted observations, iterated from `start`. `None` if the equations are
    /// singular or it does not converge.
    pub(super) fn fit<'o>(
        &self,
        start: &Se3,
        observations: impl Iterator<Item = (&'o Observation, f64)> + Clone,
        stop: Stop,
    ) -> Option<Se3> {
        let mut motion = *start;
        for _ in 0..stop.max_iterations {
            let (information, vector) = self.normal_equations(&motion, observations.clone());
            let step = -information.cholesky()?.solve(&vector);
            motion = motion_from_step(&step).compose(&motion);
            let is_below = |limit: f64| step.iter().all(|v| v.abs() < limit);
            // NaN is below nothing.
            if !is_below(DIVERGED) {
                return None;
            }
            if is_below(stop.tolerance) {
                return Some(orthonormalise(&motion));
            }
        }
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::reprojection::{Views, Weights};
    use crate::motion::test_scene::{RIG, exact_observations, true_motion};

    #[test]
    fn exact_views_give_back_the_motion() {
        for views in [Views::Left, Views::Stereo] {
            let observations = exact_observations(&true_motion(), 40, 3);
            let weighted = observations.iter().map(|o| (o, 1.0));
            let found = Reprojection { rig: &RIG, views, weights: Weights::Equal }
                .fit(&Se3::IDENTITY, weighted, Stop { max_iterations: 20, tolerance: 1e-10 })
                .unwrap();
            let error = true_motion().inverse().compose(&found);
            assert!(error.distance_m() < 1e-9 && error.angle_rad() < 1e-7, "{views:?} {error:?}");
        }
    }

    #[test]
    fn the_jacobian_is_the_derivative_of_the_residuals() {
        // J^T r from the normal equations against the central difference of half the squared error.
        let reprojection = Reprojection { rig: &RIG, views: Views::Stereo, weights: Weights::Equal };
        let observations = exact_observations(&true_motion(), 7, 5);
        let at = Se3::from_quaternion([0.02, 0.01, -0.01, 1.0], [0.1, 0.1, -0.9]);
        let (_, gradient) = reprojection.normal_equations(&at, observations.iter().map(|o| (o, 1.0)));
        let half_error = |step: &Vector6<f64>| {
            let moved = motion_from_step(step).compose(&at);
            observations.iter().map(|o| reprojection.error(&moved, o)).sum::<f64>() / 2.0
        };
        for i in 0..6 {
            let mut step = Vector6::zeros();
            step[i] = 1e-6;
            let numeric = (half_error(&step) - half_error(&-step)) / 2e-6;
            assert!((numeric - gradient[i]).abs() < 1e-5 * gradient.norm(), "{i}: {numeric} {}", gradient[i]);
        }
    }

    #[test]
    fn too_few_observations_are_refused() {
        let reprojection = Reprojection { rig: &RIG, views: Views::Left, weights: Weights::Equal };
        let one = exact_observations(&true_motion(), 1, 1);
        for observations in [vec![], one.clone(), vec![one[0]; 9]] {
            let weighted = observations.iter().map(|o| (o, 1.0));
            let stop = Stop { max_iterations: 20, tolerance: 1e-9 };
            assert!(reprojection.fit(&Se3::IDENTITY, weighted, stop).is_none());
        }
    }
}
