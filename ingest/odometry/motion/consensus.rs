//! RANSAC: the motion with which most matches agree, from random triples, each new best refitted to its inliers.

use super::agreement::Agreement;
use super::gauss_newton::Stop;
use super::observation::Observation;
use super::reprojection::{Reprojection, Weights};
use super::triples::{LANES, fit_triples};
use crate::params::RansacParams;
use crate::sampling::{draw_triple, iterations_needed};
use furrow_model::Se3;
use nalgebra::Matrix6;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

/// A motion and the observations that agree with it.
#[derive(Debug, Clone)]
pub(crate) struct Consensus {
    /// The refined motion.
    pub after_from_before: Se3,
    /// Indices of the inliers, ascending.
    pub inliers: Vec<usize>,
    /// Covariance of the motion: rotation about x, y, z (rad), then translation (m), of the frame after.
    pub covariance: Matrix6<f64>,
    /// Root mean square length of the inliers' residual vectors, px.
    pub rms_px: f64,
}

/// Finds the motion by RANSAC (Fischler and Bolles 1981) with the score of MSAC (Torr and Zisserman 2000) and a refit
/// of each new best. Gauss-Newton begins at `start`; motions that are not plausible are discarded. `None` if no triple
/// gave a plausible motion that could be refined.
pub(crate) fn find_consensus(
    reprojection: &Reprojection,
    observations: &[Observation],
    start: &Se3,
    params: &RansacParams,
    is_plausible: impl Fn(&Se3) -> bool,
) -> Option<Consensus> {
    let limit = params.inlier_px * params.inlier_px;
    let agreement = Agreement::new(reprojection, observations);
    // Inliers are chosen by pixels. Only the final fit weighs them by their noise.
    let equal = Reprojection { weights: Weights::Equal, ..*reprojection };
    let mut rng = ChaCha8Rng::seed_from_u64(params.seed);
    let mut best: Option<(f64, Se3)> = None;
    let mut needed = params.max_iterations;
    let mut iteration = 0;
    let mut fitted = [None; LANES];
    while iteration < needed {
        let lane = iteration as usize % LANES;
        if lane == 0 {
            let Some(triples) = draw_triples(&mut rng, observations.len()) else { break };
            fitted = fit_triples(reprojection, start, observations, &triples, SAMPLE_STOP);
        }
        iteration += 1;
        let Some(mut motion) = fitted[lane] else { continue };
        let least = best.as_ref().map_or(f64::INFINITY, |b| b.0);
        let score = |motion: &Se3, least: f64| {
            is_plausible(motion).then(|| agreement.truncated_error(motion, limit, least)).flatten()
        };
        let Some(mut cost) = score(&motion, least) else { continue };
        let inliers = agreement.inliers(&motion, limit);
        let weighted = inliers.iter().map(|&i| (&observations[i], 1.0));
        if let Some(refit) = equal.fit(&motion, weighted, SAMPLE_STOP)
            && let Some(refit_cost) = score(&refit, cost)
        {
            (motion, cost) = (refit, refit_cost);
        }
        let count = agreement.inliers(&motion, limit).len();
        best = Some((cost, motion));
        needed = needed.min(iterations_needed(3, count, observations.len(), params.confidence));
    }
    let (_, motion) = best?;
    refine(reprojection, observations, &agreement, &motion, limit)
        .filter(|found| is_plausible(&found.after_from_before))
}

/// For fits to triples and to the inliers of a new best.
const SAMPLE_STOP: Stop = Stop { max_iterations: 20, tolerance: 1e-4 };
/// For the fits of the refinement.
const FINAL_STOP: Stop = Stop { max_iterations: 20, tolerance: 1e-7 };
/// How often the refinement computes new weights.
const REWEIGHTINGS: usize = 5;

/// Squared scale of the Cauchy weights as a fraction of the squared inlier limit. Most residuals are far below the
/// limit, and those weighed by their noise, which come from images of one time of day, are smaller than those from two.
/// The scale is the same for exact and inexact places: where a wire crosses a cloud, neither moves as the ground does.
fn cauchy_scale(weights: Weights) -> f64 {
    match weights {
        Weights::Equal => 1.0 / 16.0,
        Weights::Noise => 1.0 / 128.0,
    }
}

/// Triples of different indices below `count`. `None` if `count` is below three.
fn draw_triples(rng: &mut ChaCha8Rng, count: usize) -> Option<[[usize; 3]; LANES]> {
    (count >= 3).then(|| std::array::from_fn(|_| draw_triple(rng, count)))
}

/// Iteratively reweighted fits to the inliers with the weights of Cauchy's robust loss. Inliers are chosen again for
/// each fit.
fn refine(
    reprojection: &Reprojection,
    observations: &[Observation],
    agreement: &Agreement<'_>,
    motion: &Se3,
    limit: f64,
) -> Option<Consensus> {
    let scale = cauchy_scale(reprojection.weights) * limit;
    let weighted = |motion: &Se3, inliers: &[usize]| -> Vec<(&Observation, f64)> {
        let weight = |o: &Observation| 1.0 / (1.0 + reprojection.error(motion, o) / scale);
        inliers.iter().map(|&i| (&observations[i], weight(&observations[i]))).collect()
    };
    let mut motion = *motion;
    for _ in 0..REWEIGHTINGS {
        let weights = weighted(&motion, &agreement.inliers(&motion, limit));
        motion = reprojection.fit(&motion, weights.iter().copied(), FINAL_STOP)?;
    }
    let inliers = agreement.inliers(&motion, limit);
    let weights = weighted(&motion, &inliers);
    let covariance = reprojection.covariance(&motion, weights.iter().copied())?;
    let squares: f64 = inliers.iter().map(|&i| reprojection.error(&motion, &observations[i])).sum();
    let rms_px = (squares / inliers.len().max(1) as f64).sqrt();
    Some(Consensus { after_from_before: motion, inliers, covariance, rms_px })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::reprojection::Views;
    use crate::motion::test_scene::{RIG, exact_observations, true_motion};
    use crate::test_support::uniform;

    fn params() -> RansacParams {
        RansacParams { seed: 7, max_iterations: 1000, confidence: 0.9999, inlier_px: 2.0, min_inliers: 6 }
    }

    #[test]
    fn the_motion_survives_a_majority_of_wrong_matches() {
        for views in [Views::Left, Views::Stereo] {
            let mut observations = exact_observations(&true_motion(), 120, 11);
            let mut rng = ChaCha8Rng::seed_from_u64(2);
            for observation in &mut observations[40..] {
                let [u, v] = [uniform(&mut rng, 0.0, 1226.0), uniform(&mut rng, 0.0, 370.0)];
                observation.seen_px = [u, v, u - uniform(&mut rng, 5.0, 80.0)];
            }
            let reprojection = Reprojection { rig: &RIG, views, weights: Weights::Equal };
            let found = find_consensus(&reprojection, &observations, &Se3::IDENTITY, &params(), |_| true).unwrap();
            let error = true_motion().inverse().compose(&found.after_from_before);
            assert!(error.distance_m() < 0.01 && error.angle_rad() < 1e-3, "{views:?} {error:?}");
            assert!((0..40).all(|i| found.inliers.contains(&i)) && found.inliers.len() < 46, "{:?}", found.inliers);
        }
    }

    #[test]
    fn implausible_motions_and_too_few_matches_give_none() {
        let reprojection = Reprojection { rig: &RIG, views: Views::Stereo, weights: Weights::Equal };
        let observations = exact_observations(&true_motion(), 30, 1);
        assert!(
            find_consensus(&reprojection, &observations, &Se3::IDENTITY, &params(), |m| m.distance_m() < 1.0).is_none()
        );
        assert!(find_consensus(&reprojection, &observations[..2], &Se3::IDENTITY, &params(), |_| true).is_none());
    }
}
