//! How the camera has been moving: what a frame that cannot be matched is taken to have done, and where it is looked for again.

use crate::motion::small_motion;
use crate::odometry::Motion;
use crate::spans::small_step;
use furrow_model::Se3;
use nalgebra::Vector6;

/// What one step counts after the next one, as a share: a few steps are remembered.
const MEMORY: f64 = 0.7;

/// How much velocities differ from step to step however well they are measured, as the variance of a step's components, rad^2 and m^2.
const UNSTEADY: f64 = 1e-6;

/// The mean velocity of the last steps, component by component, each weighted by how well it was measured and how long ago.
#[derive(Debug, Clone, Default)]
pub(crate) struct RecentMotion {
    /// Sums over the steps, of weights and of weighted velocities (rotation x y z, translation x y z, a second).
    weight: Vector6<f64>,
    velocity: Vector6<f64>,
}

impl RecentMotion {
    /// Learns from a step that took `seconds`.
    pub fn learn(&mut self, motion: &Motion, seconds: f64) {
        if seconds <= 0.0 {
            return;
        }
        let velocity = small_step(&motion.previous_from_current) / seconds;
        let weight = Vector6::from_fn(|i, _| seconds * seconds / (motion.covariance[i][i] + UNSTEADY));
        self.weight = self.weight * MEMORY + weight;
        self.velocity = self.velocity * MEMORY + weight.component_mul(&velocity);
    }

    /// Where `seconds` would lead (before_from_after); `None` where nothing has been learnt.
    pub fn over(&self, seconds: f64) -> Option<Se3> {
        let known = self.weight.iter().all(|weight| *weight > 0.0);
        known.then(|| small_motion(&(self.velocity.component_div(&self.weight) * seconds)))
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
        recent.over(seconds).map_or(f64::NAN, |motion| motion.translation_m[2])
    }

    #[test]
    fn nothing_learnt_says_nothing_and_a_steady_drive_goes_on() {
        let mut recent = RecentMotion::default();
        assert!(recent.over(0.1).is_none());
        // At 1 m/s: a step of 0.1 s, then one that lasted twice as long because a frame was lost.
        recent.learn(&motion(0.1, 1e-5), 0.1);
        recent.learn(&motion(0.2, 1e-5), 0.2);
        assert!((forward_m(&recent, 0.3) - 0.3).abs() < 1e-12);
    }

    #[test]
    fn velocities_count_by_what_they_may_err_and_by_age() {
        let mut recent = RecentMotion::default();
        // Variances of 1e-4 and 3e-4 together with the drive's own 1e-6.
        recent.learn(&motion(1.0, 1e-4 - UNSTEADY), 1.0);
        recent.learn(&motion(2.0, 3e-4 - UNSTEADY), 1.0);
        let (old, new) = (MEMORY, 1.0 / 3.0);
        assert!((forward_m(&recent, 1.0) - (old + 2.0 * new) / (old + new)).abs() < 1e-9);
        // A wild guess after a steady drive moves nothing.
        recent.learn(&motion(50.0, 1e4), 1.0);
        assert!((forward_m(&recent, 1.0) - (old + 2.0 * new) / (old + new)).abs() < 1e-3);
    }
}
