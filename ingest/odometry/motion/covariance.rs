//! The covariance of a fit.

use super::linearise::RESIDUAL;
use super::observation::Observation;
use super::reprojection::Reprojection;
use furrow_model::Se3;
use nalgebra::{Matrix6, Vector6};

impl Reprojection<'_> {
    /// The covariance of a fitted motion: rotation about x, y, z (rad), then translation (m), of the frame after. It is
    /// the sandwich estimator (Huber 1967, White 1980), clustered by observation: it stays right if variances differ
    /// and if the residuals of one observation correlate. `None` if singular.
    pub(super) fn covariance<'o>(
        &self,
        after_from_before: &Se3,
        observations: impl Iterator<Item = (&'o Observation, f64)> + Clone,
    ) -> Option<Matrix6<f64>> {
        let (information, _) = self.normal_equations(after_from_before, observations.clone());
        let (mut scores, mut count) = (Matrix6::<f64>::zeros(), 0.0);
        for (observation, weight) in observations {
            let Some(rows) = self.linearise(after_from_before, observation) else { continue };
            let mut score = Vector6::zeros();
            for row in rows.iter().take(self.residual_count()) {
                score += row.fixed_rows::<6>(0) * (weight * row[RESIDUAL]);
            }
            scores += score * score.transpose();
            count += 1.0;
        }
        // Six numbers were fitted.
        let fitted = 6.0 / self.residual_count() as f64;
        let inverse = information.cholesky()?.inverse();
        (count > fitted).then(|| inverse * scores * inverse * (count / (count - fitted)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::gauss_newton::Stop;
    use crate::motion::observation::Noise;
    use crate::motion::reprojection::{Views, Weights};
    use crate::motion::test_scene::{RIG, exact_observations, true_motion};
    use crate::test_support::uniform;
    use furrow_model::StereoRig;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    const STOP: Stop = Stop { max_iterations: 20, tolerance: 1e-9 };

    /// The error of `found`: a small rotation about x, y, z (rad), then metres.
    fn motion_error(found: &Se3, truth: &Se3) -> Vector6<f64> {
        let off = found.compose(&truth.inverse());
        let [x, y, z] = off.translation_m;
        Vector6::new(off.rotation[2][1], off.rotation[0][2], off.rotation[1][0], x, y, z)
    }

    /// Variances of the six numbers of a motion over 400 fits to what `draw` makes of the true views: measured, then
    /// predicted.
    fn fit_repeatedly(
        weights: Weights,
        truth: &[Observation],
        mut draw: impl FnMut(&Observation) -> Observation,
    ) -> (Vector6<f64>, Vector6<f64>) {
        let reprojection = Reprojection { rig: &RIG, views: Views::Stereo, weights };
        let (mut measured, mut predicted) = (Vector6::zeros(), Vector6::zeros());
        for _ in 0..400 {
            let observations: Vec<Observation> = truth.iter().map(&mut draw).collect();
            let weighted = observations.iter().map(|o| (o, 1.0));
            let fit = reprojection.fit(&true_motion(), weighted.clone(), STOP).unwrap();
            let error = motion_error(&fit, &true_motion());
            measured += error.component_mul(&error) / 400.0;
            predicted += reprojection.covariance(&fit, weighted).unwrap().diagonal() / 400.0;
        }
        (measured, predicted)
    }

    #[test]
    fn the_covariance_is_that_of_fits_to_noisy_views() {
        // Disparities have errors, so those of both columns of a point correlate.
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        let mut noise = |limit: f64| uniform(&mut rng, -limit, limit);
        let draw = |o: &Observation| {
            let shared = noise(0.8);
            let seen_px = [o.seen_px[0] + shared, o.seen_px[1] + noise(0.3), o.seen_px[2] + shared + noise(0.2)];
            Observation { seen_px, ..*o }
        };
        let (measured, predicted) = fit_repeatedly(Weights::Equal, &exact_observations(&true_motion(), 60, 3), draw);
        for i in 0..6 {
            // 400 draws give a variance to 7 % (one standard deviation).
            let ratio = predicted[i] / measured[i];
            assert!((0.8..1.25).contains(&ratio), "{i}: {} for {}", predicted[i], measured[i]);
        }
    }

    /// [`fit_repeatedly`] where the errors have the variances that the noise says, in units of 0.01 px.
    fn fit_by_noise(weights: Weights) -> (Vector6<f64>, Vector6<f64>) {
        let mut truth = exact_observations(&true_motion(), 80, 3);
        for (i, observation) in truth.iter_mut().enumerate() {
            // Every other one is an edge: vertical or diagonal.
            observation.noise = match i % 4 {
                0 => Noise { seen: [900.0, 0.0, 1.0], disparity: 900.0, depth: 900.0 },
                2 => Noise { seen: [30.0, 29.0, 30.0], disparity: 4.0, depth: 4.0 },
                _ => Noise { seen: [1.0, 0.0, 1.0], disparity: 1.0, depth: 1.0 },
            };
        }
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        // Uniform numbers of the given variance.
        let mut noise = |variance: f64| uniform(&mut rng, -1.0, 1.0) * (3.0 * variance).sqrt() * 0.01;
        let draw = |o: &Observation| {
            let Noise { seen: [uu, uv, vv], disparity, depth } = o.noise;
            let du = noise(uu);
            let dv = uv / uu * du + noise(vv - uv * uv / uu);
            let [u, v, right_u] = o.seen_px;
            let seen_px = [u + du, v + dv, right_u + du + noise(disparity)];
            let before_px = RIG.focal_px * RIG.baseline_m / o.point_m[2];
            let farther = before_px / (before_px + noise(depth));
            Observation { point_m: o.point_m.map(|v| v * farther), seen_px, ..*o }
        };
        fit_repeatedly(weights, &truth, draw)
    }

    #[test]
    fn weights_by_noise_make_better_motions_and_true_covariances() {
        let (equal, _) = fit_by_noise(Weights::Equal);
        let (by_noise, predicted) = fit_by_noise(Weights::Noise);
        for i in 0..6 {
            assert!(by_noise[i] < 0.5 * equal[i], "{i}: {} against {}", by_noise[i], equal[i]);
            let ratio = predicted[i] / by_noise[i];
            assert!((0.75..1.33).contains(&ratio), "{i}: {} for {}", predicted[i], by_noise[i]);
        }
    }

    #[test]
    fn errors_of_depth_do_not_bias_the_motion() {
        // A camera that looks at the ground before it, more of it on its right, and moves forward.
        let rig = StereoRig { width: 640, height: 360, focal_px: 264.0, cu_px: 319.5, cv_px: 179.5, baseline_m: 0.12 };
        let reprojection = Reprojection { rig: &rig, views: Views::Stereo, weights: Weights::Noise };
        let truth = Se3 { translation_m: [0.0, 0.0, -0.09], ..Se3::IDENTITY };
        let mut rng = ChaCha8Rng::seed_from_u64(12);
        const DRAWS: usize = 3000;
        let (mut mean, mut square) = (Vector6::zeros(), Vector6::zeros());
        for _ in 0..DRAWS {
            let mut observe = || {
                let z = uniform(&mut rng, 0.9, 2.5);
                let point_m = [uniform(&mut rng, -0.3, 0.9) * z, uniform(&mut rng, 0.6, 0.9), z];
                let seen = truth.apply(point_m);
                let [u, v] = rig.project(seen);
                // Half a pixel (one standard deviation) where the point is seen, and in both disparities.
                let mut noise = || uniform(&mut rng, -0.87, 0.87);
                let (du, dv) = (noise(), noise());
                let seen_px = [u + du, v + dv, u + du - rig.focal_px * rig.baseline_m / seen[2] + noise()];
                let before_px = rig.focal_px * rig.baseline_m / z;
                let farther = before_px / (before_px + noise());
                let noise = Noise { depth: 1.0, ..Noise::EQUAL };
                Observation { point_m: point_m.map(|v| v * farther), seen_px, noise }
            };
            let observations: Vec<Observation> = (0..40).map(|_| observe()).collect();
            let fit = reprojection.fit(&truth, observations.iter().map(|o| (o, 1.0)), STOP).unwrap();
            let error = motion_error(&fit, &truth);
            mean += error / DRAWS as f64;
            square += error.component_mul(&error) / DRAWS as f64;
        }
        for i in 0..6 {
            // Over 400 steps, a bias of a twentieth of a step's standard deviation adds up to as much as all their
            // scatter.
            let std = square[i].sqrt();
            assert!(mean[i].abs() < 0.05 * std, "{i}: a bias of {} at a standard deviation of {std}", mean[i]);
        }
    }
}
