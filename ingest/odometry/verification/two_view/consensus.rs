//! RANSAC: the epipolar geometry with which most correspondences agree.

use super::fundamental::{Normalised, squared_error};
use crate::params::RansacParams;
use crate::sampling::{draw_sample, iterations_needed};
use crate::verification::correspondence::Correspondence;
use nalgebra::Matrix3;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// Correspondences that determine a geometry.
pub(super) const SAMPLE: usize = 7;

/// Finds the geometry by RANSAC (Fischler and Bolles 1981) with the truncated squared Sampson error as score. Each new
/// best is refitted to its inliers. `None` if there are too few correspondences, or all of them are degenerate.
pub(super) fn find_consensus(kept: &[Correspondence], params: &RansacParams) -> Option<Matrix3<f64>> {
    if kept.len() <= SAMPLE {
        return None;
    }
    let normalised = Normalised::new(kept)?;
    let limit = params.inlier_px * params.inlier_px;
    let mut rng = ChaCha8Rng::seed_from_u64(params.seed);
    let mut best: Option<(f64, Matrix3<f64>)> = None;
    let (mut iteration, mut needed) = (0, params.max_iterations);
    while iteration < needed {
        iteration += 1;
        for sampled in normalised.solve_seven(&draw_sample(&mut rng, kept.len())) {
            let least = |best: &Option<(f64, Matrix3<f64>)>| best.as_ref().map_or(f64::INFINITY, |best| best.0);
            let mut matrix = normalised.to_pixels(&sampled);
            let Some(mut cost) = truncated_error(kept, &matrix, limit, least(&best)) else { continue };
            if let Some(refit) =
                normalised.fit_many(&find_inliers(kept, &matrix, limit)).map(|m| normalised.to_pixels(&m))
                && let Some(refit_cost) = truncated_error(kept, &refit, limit, cost)
            {
                (matrix, cost) = (refit, refit_cost);
            }
            let inliers = find_inliers(kept, &matrix, limit).len();
            needed = needed.min(iterations_needed(SAMPLE, inliers, kept.len(), params.confidence));
            best = Some((cost, matrix));
        }
    }
    best.map(|best| best.1)
}

/// The sum of squared errors, each truncated to `limit` (MSAC, Torr and Zisserman 2000). `None` as soon as it is not
/// below `least`.
fn truncated_error(kept: &[Correspondence], matrix: &Matrix3<f64>, limit: f64, least: f64) -> Option<f64> {
    let mut sum = 0.0;
    for chunk in kept.chunks(32) {
        sum += chunk.iter().map(|c| squared_error(matrix, c, limit)).sum::<f64>();
        if sum >= least {
            return None;
        }
    }
    Some(sum)
}

/// The correspondences whose squared error is below `limit`, ascending.
pub(super) fn find_inliers(kept: &[Correspondence], matrix: &Matrix3<f64>, limit: f64) -> Vec<usize> {
    (0..kept.len()).filter(|&i| squared_error(matrix, &kept[i], limit) < limit).collect()
}
