//! The recent velocity of the camera. It predicts where a doubtful step is searched again, and replaces a step that
//! failed.

use crate::motion::Motion;
use crate::se3::{motion_from_step, step_from_motion};
use furrow_model::Se3;
use nalgebra::Vector6;

/// The factor on a step's weight for each step after it.
const MEMORY: f64 = 0.7;

/// Variance of the components of a step that is due to changes of velocity, not to measurement, rad^2 and m^2.
const UNSTEADY_VARIANCE: f64 = 1e-6;

/// The mean velocity of the last steps, component by component, weighted by the inverse variance and the age of each
/// step.
#[derive(Debug, Clone, Default)]
pub(crate) struct RecentMotion {
    /// Sums over the steps of weights and of weighted velocities (rotation x y z, translation x y z, per second).
    weight: Vector6<f64>,
    velocity: Vector6<f64>,
}

impl RecentMotion {
    /// Adds a step that took `seconds`.
    pub fn add(&mut self, motion: &Motion, seconds: f64) {
        if seconds <= 0.0 {
            return;
        }
        let velocity = step_from_motion(&motion.previous_from_current) / seconds;
        let weight = Vector6::from_fn(|i, _| seconds * seconds / (motion.covariance[i][i] + UNSTEADY_VARIANCE));
        self.weight = self.weight * MEMORY + weight;
        self.velocity = self.velocity * MEMORY + weight.component_mul(&velocity);
    }

    /// The motion of `seconds` (before_from_after). `None` before the first step.
    pub fn predict(&self, seconds: f64) -> Option<Se3> {
        let is_known = self.weight.iter().all(|weight| *weight > 0.0);
        is_known.then(|| motion_from_step(&(self.velocity.component_div(&self.weight) * seconds)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(forward_m: f64, variance: f64) -> Motion {
        let covariance = std::array::from_fn(|i| std::array::from_fn(|j| if i == j { variance } else { 0.0 }));
        let previous_from_current = Se3 { translation_m: [0.0, 0.0, forward_m], ..Se3::IDENTITY };
        Motion { previous_from_current, matches: 100, inliers: 80, rms_px: 0.3, covariance }
    }

    fn forward_m(recent: &RecentMotion, seconds: f64) -> f64 {
        recent.predict(seconds).expect("a step was added").translation_m[2]
    }

    #[test]
    fn without_steps_there_is_no_prediction_and_a_steady_velocity_is_kept() {
        let mut recent = RecentMotion::default();
        assert!(recent.predict(0.1).is_none());
        // At 1 m/s: a step of 0.1 s, then one that lasted twice as long because a frame was lost.
        recent.add(&motion(0.1, 1e-5), 0.1);
        recent.add(&motion(0.2, 1e-5), 0.2);
        assert!((forward_m(&recent, 0.3) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn velocities_are_weighted_by_variance_and_age() {
        let mut recent = RecentMotion::default();
        // Variances of 1e-4 and 3e-4 together with the 1e-6 of changing velocities.
        recent.add(&motion(1.0, 1e-4 - UNSTEADY_VARIANCE), 1.0);
        recent.add(&motion(2.0, 3e-4 - UNSTEADY_VARIANCE), 1.0);
        let (old, new) = (MEMORY, 1.0 / 3.0);
        assert!((forward_m(&recent, 1.0) - (old + 2.0 * new) / (old + new)).abs() < 1e-9);
        // A motion of huge variance has no influence.
        recent.add(&motion(50.0, 1e4), 1.0);
        assert!((forward_m(&recent, 1.0) - (old + 2.0 * new) / (old + new)).abs() < 1e-3);
    }
}
