//! Motion from 3-D points and where they are seen afterwards: Gauss-Newton on the reprojection error (Geiger et al. 2011, III B).

use furrow_model::{Se3, StereoRig};
use nalgebra::{Matrix6, SVector, Vector6};

/// A point of the earlier (or live) view and where it is seen from the later (or candidate's) camera.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Observation {
    /// In the frame before the motion, metres.
    pub point_m: [f64; 3],
    /// Column and row in the left image after the motion, and the column in the right one where that is used, in px.
    pub seen_px: [f64; 3],
    /// How much these numbers may err.
    pub noise: Noise,
}

/// Variances of what an observation rests on, in one unit: what counts is how they compare. None is below 1, along whatever direction, but that
/// of a depth that is known.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Noise {
    /// Of column and row after the motion, with their covariance: uu, uv, vv.
    pub seen: [f64; 3],
    /// Of the disparity after the motion.
    pub disparity: f64,
    /// Of the disparity before the motion, behind the point's depth.
    pub depth: f64,
}

impl Noise {
    /// All that is seen errs alike, and the point is known.
    pub const EQUAL: Self = Self { seen: [1.0, 0.0, 1.0], disparity: 1.0, depth: 0.0 };
}

/// What fits make of an observation's [`Noise`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Weights {
    /// Nothing: residuals are those of the columns and the row, in px.
    Equal,
    /// Residuals are those of column, row and disparity, mixed such that all err alike and on their own (Matthies and Shafer 1987): an error of
    /// depth moves all of them together, and much where the motion is large.
    Noise,
}

/// Six derivatives, a residual, and its derivative by the disparity behind the point's depth.
type Row = SVector<f64, 8>;
const RESIDUAL: usize = 6;
const SLOPE: usize = 7;

/// The sum over rows of the products of two columns.
fn rows_dot(rows: &[Row; 3], one: usize, other: usize) -> f64 {
    rows.iter().map(|row| row[one] * row[other]).sum()
}

/// Which images after the motion are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Views {
    /// The left only: residuals (u, v).
    Left,
    /// Left and right: residuals (u left, v, u right).
    Stereo,
}

/// Reprojection errors of one rig.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Reprojection<'a> {
    pub rig: &'a StereoRig,
    pub views: Views,
    pub weights: Weights,
}

/// Nearest depth that projects sensibly, in metres.
pub(crate) const NEAR_M: f64 = 0.05;

impl Reprojection<'_> {
    /// Predicted less seen, in px; `None` behind the camera. The third is 0 where the right view is not used.
    #[inline]
    pub fn residuals(&self, after_from_before: &Se3, observation: &Observation) -> Option<[f64; 3]> {
        self.residuals_of(after_from_before, &observation.point_m, &observation.seen_px)
    }

    #[inline]
    fn residuals_of(&self, after_from_before: &Se3, point_m: &[f64; 3], seen_px: &[f64; 3]) -> Option<[f64; 3]> {
        let [x, y, z] = after_from_before.apply(*point_m);
        if z < NEAR_M {
            return None;
        }
        let scale = self.rig.focal_px / z;
        let u = x * scale + self.rig.cu_px - seen_px[0];
        let v = y * scale + self.rig.cv_px - seen_px[1];
        let right = match self.views {
            Views::Left => 0.0,
            Views::Stereo => (x - self.rig.baseline_m) * scale + self.rig.cu_px - seen_px[2],
        };
        Some([u, v, right])
    }

    /// The squared length of the residual vector in px^2; infinite behind the camera.
    #[inline]
    pub fn error(&self, after_from_before: &Se3, observation: &Observation) -> f64 {
        self.residuals(after_from_before, observation)
            .map_or(f64::INFINITY, |r| r[0] * r[0] + r[1] * r[1] + r[2] * r[2])
    }

    /// The derivatives of an observation's residuals by a small motion (omega, t) applied after `after_from_before`, each with the residual
    /// behind them; the third is for stereo only. `None` behind the camera.
    fn linearised(&self, after_from_before: &Se3, observation: &Observation) -> Option<[Row; 3]> {
        let rows = self.rows(after_from_before, &observation.point_m, &observation.seen_px)?;
        if self.weights == Weights::Equal {
            return Some(rows);
        }
        // Derivatives at a depth that errs err with it, and as the residuals do: fits would lean to one side, the same in every step. So they are
        // taken at the depth that is likeliest where the point was seen afterwards, and the residuals there say what they would at the one measured.
        let measured = whitened(&rows, &observation.noise);
        let likely = rows_dot(&measured, SLOPE, RESIDUAL) * observation.noise.depth;
        let disparity_px = self.rig.focal_px * self.rig.baseline_m / observation.point_m[2];
        let share = (1.0 - likely / disparity_px).clamp(0.5, 2.0);
        let point_m = observation.point_m.map(|v| v / share);
        let Some(mut rows) = self.rows(after_from_before, &point_m, &observation.seen_px) else {
            return Some(measured);
        };
        for row in &mut rows {
            row[RESIDUAL] += row[SLOPE] * (1.0 - share) * disparity_px;
        }
        Some(whitened(&rows, &observation.noise))
    }

    /// [`Row`]s of left column, row and right column of a point that is seen after the motion. `None` behind the camera.
    fn rows(&self, after_from_before: &Se3, point_m: &[f64; 3], seen_px: &[f64; 3]) -> Option<[Row; 3]> {
        let residuals = self.residuals_of(after_from_before, point_m, seen_px)?;
        let [x, y, z] = after_from_before.apply(*point_m);
        let scale = self.rig.focal_px / z;
        let of_point = [
            [scale, 0.0, -scale * x / z],
            [0.0, scale, -scale * y / z],
            [scale, 0.0, -scale * (x - self.rig.baseline_m) / z],
        ];
        // A point at disparity d lies along its ray at a distance that is inverse to d.
        let disparity_px = self.rig.focal_px * self.rig.baseline_m / point_m[2];
        let t = after_from_before.translation_m;
        let by_disparity = [x - t[0], y - t[1], z - t[2]].map(|turned_m| -turned_m / disparity_px);
        // d(point)/d(omega) = -[point]x, hence the row point x g.
        let row = |k: usize| {
            let g = of_point[k];
            let turn = [y * g[2] - z * g[1], z * g[0] - x * g[2], x * g[1] - y * g[0]];
            let slope = (0..3).map(|i| g[i] * by_disparity[i]).sum();
            Row::from([turn[0], turn[1], turn[2], g[0], g[1], g[2], residuals[k], slope])
        };
        Some([row(0), row(1), row(2)])
    }

    /// Numbers that an observation contributes.
    fn numbers(&self) -> usize {
        if self.views == Views::Stereo { 3 } else { 2 }
    }

    /// Normal equations J^T W J, J^T W r of a small motion (omega, t) applied after `after_from_before`, of weighted observations.
    fn normal_equations<'o>(
        &self,
        after_from_before: &Se3,
        observations: impl Iterator<Item = (&'o Observation, f64)>,
    ) -> (Matrix6<f64>, Vector6<f64>) {
        let (mut matrix, mut vector) = (Matrix6::zeros(), Vector6::zeros());
        for (observation, weight) in observations {
            let Some(rows) = self.linearised(after_from_before, observation) else { continue };
            for row in rows.iter().take(self.numbers()) {
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

    /// The covariance of a fit: rotation about x, y, z (rad), then translation (m), of the frame after. What each observation pulls with, its
    /// three residuals together, stands for how much it may err (the sandwich of Huber 1967 and White 1980), so that neither unequal errors
    /// nor those that an observation's residuals share make it too small. `None` where singular.
    pub fn covariance<'o>(
        &self,
        after_from_before: &Se3,
        observations: impl Iterator<Item = (&'o Observation, f64)> + Clone,
    ) -> Option<Matrix6<f64>> {
        let (information, _) = self.normal_equations(after_from_before, observations.clone());
        let (mut pulls, mut count) = (Matrix6::<f64>::zeros(), 0.0);
        for (observation, weight) in observations {
            let Some(rows) = self.linearised(after_from_before, observation) else { continue };
            let mut pull = Vector6::zeros();
            for row in rows.iter().take(self.numbers()) {
                pull += row.fixed_rows::<6>(0) * (weight * row[RESIDUAL]);
            }
            pulls += pull * pull.transpose();
            count += 1.0;
        }
        // Six numbers were fitted.
        let fitted = 6.0 / self.numbers() as f64;
        let inverse = information.cholesky()?.inverse();
        (count > fitted).then(|| inverse * pulls * inverse * (count / (count - fitted)))
    }

    /// The motion (after from before) by Gauss-Newton over weighted observations from `start` until a step is shorter than `settled` (rad and m) or `rounds` are spent; `None` where the equations
    /// are singular or it does not settle.
    pub fn fit<'o>(
        &self,
        start: &Se3,
        observations: impl Iterator<Item = (&'o Observation, f64)> + Clone,
        rounds: usize,
        settled: f64,
    ) -> Option<Se3> {
        let mut motion = *start;
        for _ in 0..rounds {
            let (information, vector) = self.normal_equations(&motion, observations.clone());
            let step = -information.cholesky()?.solve(&vector);
            motion = small_motion(&step).compose(&motion);
            let shorter_than = |limit: f64| step.iter().all(|v| v.abs() < limit);
            // NaN is not shorter than anything.
            if !shorter_than(DIVERGED) {
                return None;
            }
            if shorter_than(settled) {
                return Some(orthonormal(&motion));
            }
        }
        None
    }
}

/// The rows of column, row and disparity after division by the factor of Cholesky of their covariance: the noise of what is seen, and of the
/// disparity before the motion, by which they move as their slopes say. No pivot is below
/// the least variance along any direction; where slopes are huge, rounding says otherwise.
fn whitened([u, v, right]: &[Row; 3], noise: &Noise) -> [Row; 3] {
    let disparity = u - right;
    let [of_u, of_v, of_disparity] = [u[SLOPE], v[SLOPE], disparity[SLOPE]];
    let [uu, uv, vv] = noise.seen;
    let first = (uu + noise.depth * of_u * of_u).sqrt();
    let second_first = (uv + noise.depth * of_u * of_v) / first;
    let second = (vv + noise.depth * of_v * of_v - second_first * second_first).max(1.0).sqrt();
    let third_first = noise.depth * of_u * of_disparity / first;
    let third_second = (noise.depth * of_v * of_disparity - third_first * second_first) / second;
    let rest = noise.disparity + noise.depth * of_disparity * of_disparity;
    let third = (rest - third_first * third_first - third_second * third_second).max(1.0).sqrt();
    let u = u / first;
    let v = (v - u * second_first) / second;
    [u, v, (disparity - u * third_first - v * third_second) / third]
}

/// A single step of more metres or radians than this has left the road.
pub(crate) const DIVERGED: f64 = 100.0;

/// The motion of a small rotation vector and translation. The rotation is the unit quaternion (omega/2, 1): right to second order, which
/// is all that Gauss-Newton needs, and free of transcendental functions.
pub(crate) fn small_motion(step: &Vector6<f64>) -> Se3 {
    let quaternion = [step[0] / 2.0, step[1] / 2.0, step[2] / 2.0, 1.0];
    Se3::from_quaternion(quaternion, [step[3], step[4], step[5]])
}

/// The same motion with rounding washed out of the rotation.
pub(crate) fn orthonormal(motion: &Se3) -> Se3 {
    Se3::from_quaternion(motion.quaternion_xyzw(), motion.translation_m)
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    pub(crate) const RIG: StereoRig =
        StereoRig { width: 1226, height: 370, focal_px: 707.0, cu_px: 602.0, cv_px: 183.0, baseline_m: 0.54 };

    pub(crate) fn uniform(rng: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
        low + (high - low) * f64::from(rng.next_u32()) / f64::from(u32::MAX)
    }

    /// Points in front of the camera and where `after_from_before` shows them, without error.
    pub(crate) fn exact(after_from_before: &Se3, count: usize, seed: u64) -> Vec<Observation> {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let mut observe = || {
            let z = uniform(&mut rng, 5.0, 40.0);
            let point_m = [uniform(&mut rng, -0.6, 0.6) * z, uniform(&mut rng, -0.2, 0.2) * z, z];
            let seen = after_from_before.apply(point_m);
            let [u, v] = RIG.project(seen);
            let seen_px = [u, v, u - RIG.focal_px * RIG.baseline_m / seen[2]];
            Observation { point_m, seen_px, noise: Noise::EQUAL }
        };
        (0..count).map(|_| observe()).collect()
    }

    pub(crate) fn motion() -> Se3 {
        Se3::from_quaternion([0.01, -0.06, 0.02, 1.0], [0.2, -0.05, -1.3])
    }

    #[test]
    fn exact_views_give_back_the_motion() {
        for views in [Views::Left, Views::Stereo] {
            let observations = exact(&motion(), 40, 3);
            let weighted = observations.iter().map(|o| (o, 1.0));
            let found = Reprojection { rig: &RIG, views, weights: Weights::Equal }
                .fit(&Se3::IDENTITY, weighted, 20, 1e-10)
                .unwrap();
            let error = motion().inverse().compose(&found);
            assert!(error.distance_m() < 1e-9 && error.angle_rad() < 1e-7, "{views:?} {error:?}");
        }
    }

    #[test]
    fn the_jacobian_is_the_derivative_of_the_residuals() {
        // J^T r from the normal equations against the central difference of half the squared error.
        let reprojection = Reprojection { rig: &RIG, views: Views::Stereo, weights: Weights::Equal };
        let observations = exact(&motion(), 7, 5);
        let at = Se3::from_quaternion([0.02, 0.01, -0.01, 1.0], [0.1, 0.1, -0.9]);
        let (_, gradient) = reprojection.normal_equations(&at, observations.iter().map(|o| (o, 1.0)));
        let half_error = |step: &Vector6<f64>| {
            let moved = small_motion(step).compose(&at);
            observations.iter().map(|o| reprojection.error(&moved, o)).sum::<f64>() / 2.0
        };
        for i in 0..6 {
            let mut step = Vector6::zeros();
            step[i] = 1e-6;
            let numeric = (half_error(&step) - half_error(&-step)) / 2e-6;
            assert!((numeric - gradient[i]).abs() < 1e-5 * gradient.norm(), "{i}: {numeric} {}", gradient[i]);
        }
    }

    /// What `found` is off by: a small turn about x, y, z (rad), then metres.
    fn error_of(found: &Se3, truth: &Se3) -> Vector6<f64> {
        let off = found.compose(&truth.inverse());
        let [x, y, z] = off.translation_m;
        Vector6::new(off.rotation[2][1], off.rotation[0][2], off.rotation[1][0], x, y, z)
    }

    /// Variances of the six numbers of a motion over 400 fits to what `draw` makes of the true views: as they scatter, and as they are claimed.
    fn scatter(
        weights: Weights,
        truth: &[Observation],
        mut draw: impl FnMut(&Observation) -> Observation,
    ) -> (Vector6<f64>, Vector6<f64>) {
        let reprojection = Reprojection { rig: &RIG, views: Views::Stereo, weights };
        let (mut found, mut claimed) = (Vector6::zeros(), Vector6::zeros());
        for _ in 0..400 {
            let observations: Vec<Observation> = truth.iter().map(&mut draw).collect();
            let weighted = observations.iter().map(|o| (o, 1.0));
            let fit = reprojection.fit(&motion(), weighted.clone(), 20, 1e-9).unwrap();
            let error = error_of(&fit, &motion());
            found += error.component_mul(&error) / 400.0;
            claimed += reprojection.covariance(&fit, weighted).unwrap().diagonal() / 400.0;
        }
        (found, claimed)
    }

    #[test]
    fn the_covariance_is_the_scatter_of_fits_to_noisy_views() {
        // Disparities err, so that both columns of a point err together.
        let mut rng = ChaCha8Rng::seed_from_u64(9);
        let mut noise = |limit: f64| uniform(&mut rng, -limit, limit);
        let draw = |o: &Observation| {
            let shared = noise(0.8);
            let seen_px = [o.seen_px[0] + shared, o.seen_px[1] + noise(0.3), o.seen_px[2] + shared + noise(0.2)];
            Observation { seen_px, ..*o }
        };
        let (found, claimed) = scatter(Weights::Equal, &exact(&motion(), 60, 3), draw);
        for i in 0..6 {
            // 400 draws tell a variance to 7 % (one sigma).
            assert!((0.8..1.25).contains(&(claimed[i] / found[i])), "{i}: {} for {}", claimed[i], found[i]);
        }
    }

    /// [`scatter`] where views err as their noise says, in units of 0.01 px.
    fn scatter_by_noise(weights: Weights) -> (Vector6<f64>, Vector6<f64>) {
        let mut truth = exact(&motion(), 80, 3);
        for (i, observation) in truth.iter_mut().enumerate() {
            // Every other one is an edge: across the view, or along it.
            observation.noise = match i % 4 {
                0 => Noise { seen: [900.0, 0.0, 1.0], disparity: 900.0, depth: 900.0 },
                2 => Noise { seen: [30.0, 29.0, 30.0], disparity: 4.0, depth: 4.0 },
                _ => Noise { seen: [1.0, 0.0, 1.0], disparity: 1.0, depth: 1.0 },
            };
        }
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        // Uniform numbers of the wanted variance.
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
        scatter(weights, &truth, draw)
    }

    #[test]
    fn weights_by_noise_make_better_motions_and_true_claims() {
        let (equal, _) = scatter_by_noise(Weights::Equal);
        let (by_noise, claimed) = scatter_by_noise(Weights::Noise);
        for i in 0..6 {
            assert!(by_noise[i] < 0.5 * equal[i], "{i}: {} against {}", by_noise[i], equal[i]);
            assert!((0.75..1.33).contains(&(claimed[i] / by_noise[i])), "{i}: {} for {}", claimed[i], by_noise[i]);
        }
    }

    #[test]
    fn errors_of_depth_do_not_pull_the_motion_to_one_side() {
        // A camera that looks at the ground before it, more of it on its right, and moves on by a step.
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
                // Half a pixel (one sigma) where the point is seen, and in both disparities.
                let mut noise = || uniform(&mut rng, -0.87, 0.87);
                let (du, dv) = (noise(), noise());
                let seen_px = [u + du, v + dv, u + du - rig.focal_px * rig.baseline_m / seen[2] + noise()];
                let before_px = rig.focal_px * rig.baseline_m / z;
                let farther = before_px / (before_px + noise());
                Observation {
                    point_m: point_m.map(|v| v * farther),
                    seen_px,
                    noise: Noise { depth: 1.0, ..Noise::EQUAL },
                }
            };
            let observations: Vec<Observation> = (0..40).map(|_| observe()).collect();
            let fit = reprojection.fit(&truth, observations.iter().map(|o| (o, 1.0)), 20, 1e-9).unwrap();
            let error = error_of(&fit, &truth);
            mean += error / DRAWS as f64;
            square += error.component_mul(&error) / DRAWS as f64;
        }
        for i in 0..6 {
            // A twentieth of a step's scatter adds up, over 400 steps, to as much as all their scatter.
            assert!(mean[i].abs() < 0.05 * square[i].sqrt(), "{i}: {} of a scatter of {}", mean[i], square[i].sqrt());
        }
    }

    #[test]
    fn a_vague_point_close_to_the_camera_leaves_numbers() {
        let reprojection = Reprojection { rig: &RIG, views: Views::Stereo, weights: Weights::Noise };
        let mut rng = ChaCha8Rng::seed_from_u64(6);
        for _ in 0..20_000 {
            let after_from_before = Se3 { translation_m: [0.0, 0.0, uniform(&mut rng, -100.0, 100.0)], ..motion() };
            let seen_m =
                [uniform(&mut rng, -50.0, 50.0), uniform(&mut rng, -50.0, 50.0), uniform(&mut rng, 0.051, 0.3)];
            let point_m = after_from_before.inverse().apply(seen_m);
            let noise = Noise { seen: [2500.0, 0.0, 1.0], disparity: 1.0, depth: 2500.0 };
            let observation = Observation { point_m, seen_px: [100.0, 100.0, 90.0], noise };
            let rows = reprojection.linearised(&after_from_before, &observation).expect("in front of the camera");
            assert!(rows.iter().all(|row| row.iter().all(|v| v.is_finite())), "{observation:?}");
        }
    }

    #[test]
    fn too_little_to_go_by_is_refused() {
        let reprojection = Reprojection { rig: &RIG, views: Views::Left, weights: Weights::Equal };
        let one = exact(&motion(), 1, 1);
        for observations in [vec![], one.clone(), vec![one[0]; 9]] {
            let weighted = observations.iter().map(|o| (o, 1.0));
            assert!(reprojection.fit(&Se3::IDENTITY, weighted, 20, 1e-9).is_none());
        }
    }
}
