//! Verification without a second camera: the matches between one live image and the candidate's must agree on an epipolar geometry. Nothing
//! is known of distances, so no pose results, and a view from far down the road may pass where three views would refuse it.

mod fundamental;

use crate::bucket::best_of_buckets;
use crate::params::{BucketParams, RansacParams};
use crate::verify::Correspondence;
use fundamental::{Normalised, squared_error};
use nalgebra::Matrix3;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

/// Verification of a candidate by two views.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TwoViewParams {
    /// Thinning by places in the live image; inlier counts depend on it.
    pub bucket: BucketParams,
    /// Sampling; `min_inliers` below 8 mean nothing, since any 7 matches agree on some geometry.
    pub ransac: RansacParams,
}

impl Default for TwoViewParams {
    fn default() -> Self {
        Self {
            bucket: BucketParams { side_px: 25, matches: 2 },
            ransac: RansacParams { seed: 0, max_rounds: 2000, confidence: 0.999, inlier_px: 1.5, min_inliers: 8 },
        }
    }
}

/// What a live image and a candidate have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct TwoViewEstimate {
    /// Matches kept by bucketing.
    pub matches: usize,
    /// Matches that agree on one epipolar geometry: the number that decides whether the localisation is believed.
    pub inliers: usize,
    /// That geometry: candidate^T F live = 0 for places (u, v, 1) in px, by rows; `None` where no eight matches agree.
    pub candidate_from_live: Option<[[f64; 3]; 3]>,
    /// The agreeing matches, for drawing.
    pub correspondences: Vec<Correspondence>,
}

/// A match of two images that some matcher found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoViewMatch {
    /// Where both images show it.
    pub at: Correspondence,
    /// How unlike its two ends are, from 0, in the matcher's own measure; only its order counts.
    pub distance: f32,
}

/// Verifies one candidate: thins the matches, finds the epipolar geometry that most agree on (Fischler and Bolles 1981; truncated squared
/// Sampson error as score, sampled by sevens, each new best refitted to all that agree with it), counts those.
pub fn verify_two_view(matches: &[TwoViewMatch], params: &TwoViewParams) -> TwoViewEstimate {
    let finite = |m: &&TwoViewMatch| [m.at.live_px, m.at.candidate_px].iter().flatten().all(|v| v.is_finite());
    let matches: Vec<&TwoViewMatch> = matches.iter().filter(finite).collect();
    let places: Vec<_> = matches.iter().map(|m| m.at.live_px.map(|px| px as f32)).collect();
    // Floats from 0 on are in the order of their bits.
    let distances: Vec<u32> = matches.iter().map(|m| m.distance.max(0.0).to_bits()).collect();
    let kept: Vec<Correspondence> =
        best_of_buckets(&places, &distances, &params.bucket).into_iter().map(|i| matches[i].at).collect();
    let limit = params.ransac.inlier_px * params.ransac.inlier_px;
    let found = consensus(&kept, &params.ransac)
        .map(|matrix| (matrix, agreeing(&kept, &matrix, limit)))
        .filter(|(_, inliers)| inliers.len() >= params.ransac.min_inliers.max(SAMPLE + 1));
    let inliers = found.as_ref().map_or(&[][..], |(_, inliers)| inliers);
    TwoViewEstimate {
        matches: kept.len(),
        inliers: inliers.len(),
        correspondences: inliers.iter().map(|&i| kept[i]).collect(),
        candidate_from_live: found
            .as_ref()
            .map(|(matrix, _)| std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)]))),
    }
}

/// Correspondences that determine a geometry.
const SAMPLE: usize = 7;

fn consensus(kept: &[Correspondence], params: &RansacParams) -> Option<Matrix3<f64>> {
    if kept.len() <= SAMPLE {
        return None;
    }
    let normalised = Normalised::of(kept)?;
    let limit = params.inlier_px * params.inlier_px;
    let mut rng = ChaCha8Rng::seed_from_u64(params.seed);
    let mut best: Option<(f64, Matrix3<f64>)> = None;
    let (mut round, mut rounds) = (0, params.max_rounds);
    while round < rounds {
        round += 1;
        for sampled in normalised.of_seven(&sample(&mut rng, kept.len())) {
            let least = |best: &Option<(f64, Matrix3<f64>)>| best.as_ref().map_or(f64::INFINITY, |best| best.0);
            let mut matrix = normalised.to_pixels(&sampled);
            let Some(mut cost) = truncated_error(kept, &matrix, limit, least(&best)) else { continue };
            if let Some(refit) = normalised.of_many(&agreeing(kept, &matrix, limit)).map(|m| normalised.to_pixels(&m))
                && let Some(refit_cost) = truncated_error(kept, &refit, limit, cost)
            {
                (matrix, cost) = (refit, refit_cost);
            }
            rounds = rounds.min(rounds_needed(agreeing(kept, &matrix, limit).len(), kept.len(), params.confidence));
            best = Some((cost, matrix));
        }
    }
    best.map(|best| best.1)
}

/// Seven different indices below `count`, which must be more than seven.
fn sample(rng: &mut impl Rng, count: usize) -> [usize; SAMPLE] {
    let mut chosen = [0; SAMPLE];
    for i in 0..SAMPLE {
        chosen[i] = loop {
            let index = ((u64::from(rng.next_u32()) * count as u64) >> 32) as usize;
            if !chosen[..i].contains(&index) {
                break index;
            }
        };
    }
    chosen
}

/// The sum of squared errors, each at most `limit`; `None` as soon as it is not below `least`.
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

fn agreeing(kept: &[Correspondence], matrix: &Matrix3<f64>, limit: f64) -> Vec<usize> {
    (0..kept.len()).filter(|&i| squared_error(matrix, &kept[i], limit) < limit).collect()
}

/// How many rounds leave a chance of 1 - confidence that no sample was free of outliers.
fn rounds_needed(inliers: usize, count: usize, confidence: f64) -> u32 {
    let share = inliers as f64 / count as f64;
    let miss = 1.0 - (0..SAMPLE).map(|_| share).product::<f64>();
    // Counted by multiplication, since logarithms differ between machines.
    let (mut chance, mut rounds) = (1.0, 0);
    while chance > 1.0 - confidence && rounds < 100_000 {
        chance *= miss;
        rounds += 1;
    }
    rounds
}

#[cfg(test)]
mod tests;
