//! Derivatives of the residuals of an observation, and their whitening.

use super::observation::{Noise, Observation};
use super::reprojection::{Reprojection, Weights};
use furrow_model::Se3;
use nalgebra::SVector;

/// One residual: its derivatives by a small step (omega, t), then [`RESIDUAL`] and [`SLOPE`].
pub(super) type Row = SVector<f64, 8>;
/// Index of the residual itself.
pub(super) const RESIDUAL: usize = 6;
/// Index of the residual's derivative by the disparity before the motion, which gave the point's depth.
const SLOPE: usize = 7;

/// The sum over rows of the products of two entries.
fn dot_entries(rows: &[Row; 3], one: usize, other: usize) -> f64 {
    rows.iter().map(|row| row[one] * row[other]).sum()
}

impl Reprojection<'_> {
    /// The derivatives of an observation's residuals by a small step (omega, t) applied after `after_from_before`, each
    /// with its residual. The third row is for stereo only. `None` behind the camera.
    #[inline]
    pub(super) fn linearise(&self, after_from_before: &Se3, observation: &Observation) -> Option<[Row; 3]> {
        let rows = self.rows(after_from_before, &observation.point_m, &observation.seen_px)?;
        if self.weights == Weights::Equal {
            return Some(rows);
        }
        // Derivatives at the measured depth have errors that correlate with those of the residuals: fits would be
        // biased, in the same direction in every step. So the derivatives are taken at the likeliest depth, given where
        // the point was seen afterwards, and the residuals there are extrapolated to the measured depth.
        let measured = whiten(&rows, &observation.noise);
        let likely = dot_entries(&measured, SLOPE, RESIDUAL) * observation.noise.depth;
        let disparity_px = self.rig.focal_px * self.rig.baseline_m / observation.point_m[2];
        let share = (1.0 - likely / disparity_px).clamp(0.5, 2.0);
        let point_m = observation.point_m.map(|v| v / share);
        let Some(mut rows) = self.rows(after_from_before, &point_m, &observation.seen_px) else {
            return Some(measured);
        };
        for row in &mut rows {
            row[RESIDUAL] += row[SLOPE] * (1.0 - share) * disparity_px;
        }
        Some(whiten(&rows, &observation.noise))
    }

    /// The rows of left column, row and right column of a point that is seen after the motion. `None` behind the
    /// camera.
    #[inline]
    fn rows(&self, after_from_before: &Se3, point_m: &[f64; 3], seen_px: &[f64; 3]) -> Option<[Row; 3]> {
        let residuals = self.residuals(after_from_before, point_m, seen_px)?;
        let [x, y, z] = after_from_before.apply(*point_m);
        let scale = self.rig.focal_px / z;
        let by_point = [
            [scale, 0.0, -scale * x / z],
            [0.0, scale, -scale * y / z],
            [scale, 0.0, -scale * (x - self.rig.baseline_m) / z],
        ];
        // A point of disparity d lies along its ray at a distance proportional to 1 / d.
        let disparity_px = self.rig.focal_px * self.rig.baseline_m / point_m[2];
        let t = after_from_before.translation_m;
        let by_disparity = [x - t[0], y - t[1], z - t[2]].map(|turned_m| -turned_m / disparity_px);
        // d(point)/d(omega) = -[point]x, hence the row point x g.
        let row = |k: usize| {
            let g = by_point[k];
            let turn = [y * g[2] - z * g[1], z * g[0] - x * g[2], x * g[1] - y * g[0]];
            let slope = (0..3).map(|i| g[i] * by_disparity[i]).sum();
            Row::from([turn[0], turn[1], turn[2], g[0], g[1], g[2], residuals[k], slope])
        };
        Some([row(0), row(1), row(2)])
    }
}

/// The rows of column, row and disparity, multiplied by the inverse Cholesky factor of their covariance. The covariance
/// is that of what is seen plus that of the disparity before the motion, by which the residuals move as their slopes
/// say. No pivot may be below the least variance along any direction: where slopes are huge, rounding would make it so.
fn whiten([u, v, right]: &[Row; 3], noise: &Noise) -> [Row; 3] {
    let disparity = u - right;
    let [slope_u, slope_v, slope_d] = [u[SLOPE], v[SLOPE], disparity[SLOPE]];
    let [uu, uv, vv] = noise.seen;
    let first = (uu + noise.depth * slope_u * slope_u).sqrt();
    let second_first = (uv + noise.depth * slope_u * slope_v) / first;
    let second = (vv + noise.depth * slope_v * slope_v - second_first * second_first).max(1.0).sqrt();
    let third_first = noise.depth * slope_u * slope_d / first;
    let third_second = (noise.depth * slope_v * slope_d - third_first * second_first) / second;
    let rest = noise.disparity + noise.depth * slope_d * slope_d;
    let third = (rest - third_first * third_first - third_second * third_second).max(1.0).sqrt();
    let u = u / first;
    let v = (v - u * second_first) / second;
    [u, v, (disparity - u * third_first - v * third_second) / third]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::reprojection::Views;
    use crate::motion::test_scene::{RIG, true_motion};
    use crate::test_support::uniform;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn a_point_of_uncertain_depth_close_to_the_camera_gives_finite_rows() {
        let reprojection = Reprojection { rig: &RIG, views: Views::Stereo, weights: Weights::Noise };
        let mut rng = ChaCha8Rng::seed_from_u64(6);
        for _ in 0..20_000 {
            let forward_m = uniform(&mut rng, -100.0, 100.0);
            let after_from_before = Se3 { translation_m: [0.0, 0.0, forward_m], ..true_motion() };
            let seen_m =
                [uniform(&mut rng, -50.0, 50.0), uniform(&mut rng, -50.0, 50.0), uniform(&mut rng, 0.051, 0.3)];
            let point_m = after_from_before.inverse().apply(seen_m);
            let noise = Noise { seen: [2500.0, 0.0, 1.0], disparity: 1.0, depth: 2500.0 };
            let observation = Observation { point_m, seen_px: [100.0, 100.0, 90.0], noise };
            let rows = reprojection.linearise(&after_from_before, &observation).expect("in front of the camera");
            assert!(rows.iter().all(|row| row.iter().all(|v| v.is_finite())), "{observation:?}");
        }
    }
}
