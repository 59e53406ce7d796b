//! The motion that most matches agree with: random triples, early exit, refits on the agreeing matches.

use crate::agreement::Agreement;
use crate::motion::{Observation, Reprojection, Weights};
use crate::params::RansacParams;
use crate::triples::{LANES, fit_triples};
use furrow_model::Se3;
use nalgebra::Matrix6;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;

/// A motion with the matches that agree with it.
#[derive(Debug, Clone)]
pub(crate) struct Consensus {
    /// The refined motion.
    pub after_from_before: Se3,
    /// Indices of the agreeing observations, ascending.
    pub inliers: Vec<usize>,
    /// Covariance of the motion: rotation about x, y, z (rad), then translation (m), of the frame after.
    pub covariance: Matrix6<f64>,
    /// Median-free scale of the agreeing residuals: root mean square of their length, px.
    pub rms_px: f64,
}

/// Finds the motion (Fischler and Bolles 1981, with the truncated squared error of MSAC as score and a refit of each new best).
/// `start` is where Gauss-Newton begins, `plausible` refuses motions out of hand. `None` where no triple gave a plausible motion that
/// could be refined.
pub(crate) fn consensus(
    reprojection: &Reprojection,
    observations: &[Observation],
    start: &Se3,
    params: &RansacParams,
    plausible: impl Fn(&Se3) -> bool,
) -> Option<Consensus> {
    let limit = params.inlier_px * params.inlier_px;
    let agreement = Agreement::new(reprojection, observations);
    // Who agrees is a matter of pixels; only among them it counts how much each may err.
    let equal = Reprojection { weights: Weights::Equal, ..*reprojection };
    let mut rng = ChaCha8Rng::seed_from_u64(params.seed);
    let mut best: Option<(f64, Se3)> = None;
    let mut rounds = params.max_rounds;
    let mut round = 0;
    let mut fitted = [None; LANES];
    while round < rounds {
        let lane = round as usize % LANES;
        if lane == 0 {
            let Some(triples) = samples(&mut rng, observations.len()) else { break };
            fitted = fit_triples(reprojection, start, observations, &triples, (TRIPLE_ROUNDS, TRIPLE_SETTLED));
        }
        round += 1;
        let Some(mut motion) = fitted[lane] else { continue };
        let least = best.as_ref().map_or(f64::INFINITY, |b| b.0);
        let score = |motion: &Se3, least: f64| {
            plausible(motion).then(|| agreement.truncated_error(motion, limit, least)).flatten()
        };
        let Some(mut cost) = score(&motion, least) else { continue };
        let inliers = agreement.agreeing(&motion, limit);
        let support = inliers.iter().map(|&i| (&observations[i], 1.0));
        if let Some(refit) = equal.fit(&motion, support, REFIT_ROUNDS, TRIPLE_SETTLED)
            && let Some(refit_cost) = score(&refit, cost)
        {
            (motion, cost) = (refit, refit_cost);
        }
        let count = agreement.agreeing(&motion, limit).len();
        best = Some((cost, motion));
        rounds = rounds.min(rounds_needed(count, observations.len(), params.confidence));
    }
    let (_, motion) = best?;
    refine(reprojection, observations, &agreement, &motion, limit).filter(|found| plausible(&found.after_from_before))
}

const TRIPLE_ROUNDS: usize = 20;
const TRIPLE_SETTLED: f64 = 1e-4;
const REFIT_ROUNDS: usize = 20;
const FINAL_SETTLED: f64 = 1e-7;
const REWEIGHTINGS: usize = 5;

/// Squared scale of Cauchy's weights as a fraction of the squared inlier limit: most residuals are far below the limit, and those of places
/// refined at one hour (the ones weighed by their noise) farther than those of two. A vague place is forgiven no more than a sharp one: where a
/// wire crosses a cloud, neither moves as the ground does.
fn cauchy_scale(weights: Weights) -> f64 {
    match weights {
        Weights::Equal => 1.0 / 16.0,
        Weights::Noise => 1.0 / 128.0,
    }
}

/// Triples of different indices below `count`; none below three.
fn samples(rng: &mut impl Rng, count: usize) -> Option<[[usize; 3]; LANES]> {
    (count >= 3).then(|| std::array::from_fn(|_| sample(rng, count)))
}

/// Three different indices below `count`, which is at least three.
fn sample(rng: &mut impl Rng, count: usize) -> [usize; 3] {
    let mut below = || ((u64::from(rng.next_u32()) * count as u64) >> 32) as usize;
    let mut triple = [below(), below(), below()];
    while triple[1] == triple[0] {
        triple[1] = below();
    }
    while triple[2] == triple[0] || triple[2] == triple[1] {
        triple[2] = below();
    }
    triple
}

/// How many rounds leave a chance of 1 - confidence that no triple was free of outliers.
fn rounds_needed(inliers: usize, count: usize, confidence: f64) -> u32 {
    let share = inliers as f64 / count as f64;
    let miss = 1.0 - share * share * share;
    // Counted by multiplication, since logarithms differ between machines.
    let (mut chance, mut rounds) = (1.0, 0);
    while chance > 1.0 - confidence && rounds < 100_000 {
        chance *= miss;
        rounds += 1;
    }
    rounds
}

/// Refits on the agreeing matches with robust weights (Cauchy), each time anew, as better motions agree with other matches.
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
        let weights = weighted(&motion, &agreement.agreeing(&motion, limit));
        motion = reprojection.fit(&motion, weights.iter().copied(), REFIT_ROUNDS, FINAL_SETTLED)?;
    }
    let inliers = agreement.agreeing(&motion, limit);
    let weights = weighted(&motion, &inliers);
    let covariance = reprojection.covariance(&motion, weights.iter().copied())?;
    let squares: f64 = inliers.iter().map(|&i| reprojection.error(&motion, &observations[i])).sum();
    let rms_px = (squares / inliers.len().max(1) as f64).sqrt();
    Some(Consensus { after_from_before: motion, inliers, covariance, rms_px })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Views;
    use crate::motion::tests::{RIG, exact, motion, uniform};

    fn params() -> RansacParams {
        RansacParams { seed: 7, max_rounds: 1000, confidence: 0.9999, inlier_px: 2.0, min_inliers: 6 }
    }

    #[test]
    fn the_motion_survives_a_majority_of_wrong_matches() {
        for views in [Views::Left, Views::Stereo] {
            let mut observations = exact(&motion(), 120, 11);
            let mut rng = ChaCha8Rng::seed_from_u64(2);
            for observation in &mut observations[40..] {
                let [u, v] = [uniform(&mut rng, 0.0, 1226.0), uniform(&mut rng, 0.0, 370.0)];
                observation.seen_px = [u, v, u - uniform(&mut rng, 5.0, 80.0)];
            }
            let reprojection = Reprojection { rig: &RIG, views, weights: Weights::Equal };
            let found = consensus(&reprojection, &observations, &Se3::IDENTITY, &params(), |_| true).unwrap();
            let error = motion().inverse().compose(&found.after_from_before);
            assert!(error.distance_m() < 0.01 && error.angle_rad() < 1e-3, "{views:?} {error:?}");
            assert!((0..40).all(|i| found.inliers.contains(&i)) && found.inliers.len() < 46, "{:?}", found.inliers);
        }
    }

    #[test]
    fn implausible_motions_and_too_few_matches_give_none() {
        let reprojection = Reprojection { rig: &RIG, views: Views::Stereo, weights: Weights::Equal };
        let observations = exact(&motion(), 30, 1);
        assert!(consensus(&reprojection, &observations, &Se3::IDENTITY, &params(), |m| m.distance_m() < 1.0).is_none());
        assert!(consensus(&reprojection, &observations[..2], &Se3::IDENTITY, &params(), |_| true).is_none());
    }

    #[test]
    fn rounds_follow_the_textbook_formula() {
        // log(1 - 0.99) / log(1 - 0.5^3) = 34.5
        assert_eq!(rounds_needed(50, 100, 0.99), 35);
        assert_eq!(rounds_needed(100, 100, 0.99), 1);
    }
}
