//! The threshold stage: how many inliers wrong places reach by chance (Church 2023, Fig 3.5), measured on the
//! vocabulary traversals.

use crate::RunError;
use crate::inputs::sampling::spread;
use crate::inputs::traversals::LiveTraversal;
use crate::plan::Plan;
use crate::progress::Progress;
use crate::stages::verifying::{CalibrationInput, Verifier, Visitor, pair_inliers, visit};
use furrow_catalog::records::{FeatureParameters, ThresholdRecord};
use furrow_catalog::tables::Frame;
use furrow_catalog::{CatalogError, Objects};
use furrow_localiser::verification::Threshold;
use furrow_model::trajectory::ChainPose;
use furrow_model::{ObjectId, StereoRig};

/// Places at least this far apart are wrong for each other.
const APART_M: f64 = 10.0;
/// Wrong pairs measured in all: the 99.9th percentile needs a thousand.
const PAIRS: usize = 1000;
/// Frames of a traversal that pairs are drawn from, so that long traversals cost no more than short ones.
const FRAMES: usize = 64;

/// The inliers that a localisation of live frames of `rig` must reach: those that the matrix asks for, else calibrated
/// ones.
pub(crate) fn inlier_threshold(
    objects: &Objects,
    plan: &Plan,
    rig: &StereoRig,
    features: FeatureParameters,
    progress: Progress<'_>,
) -> Result<u32, RunError> {
    match plan.matrix.verification.threshold {
        Some(inliers) => Ok(inliers),
        None => Ok(calibrated(objects, &plan.vocabulary, rig, features, progress)?.inliers),
    }
}

/// The threshold for live frames of `rig`, calibrated on those of these traversals that can be verified the same way,
/// with its histogram; the least one where no two places are 10 m apart.
fn calibrated(
    objects: &Objects,
    traversals: &[LiveTraversal],
    rig: &StereoRig,
    features: FeatureParameters,
    progress: Progress<'_>,
) -> Result<Threshold, RunError> {
    visit(rig, features, Calibration { objects, traversals, progress })
}

/// The traversals that a threshold is calibrated on.
struct Calibration<'a> {
    objects: &'a Objects,
    traversals: &'a [LiveTraversal],
    progress: Progress<'a>,
}

impl Visitor for Calibration<'_> {
    type Output = Result<Threshold, RunError>;

    fn visit(self, verifier: &impl Verifier) -> Self::Output {
        calibrated_by(verifier, self.objects, self.traversals, self.progress)
    }
}

/// The key of the threshold that is calibrated for live frames of `rig`.
pub(crate) fn threshold_key(
    plan: &Plan,
    rig: &StereoRig,
    features: FeatureParameters,
) -> Result<ObjectId, CatalogError> {
    visit(rig, features, ThresholdKey { traversals: &plan.vocabulary })
}

struct ThresholdKey<'a> {
    traversals: &'a [LiveTraversal],
}

impl Visitor for ThresholdKey<'_> {
    type Output = Result<ObjectId, CatalogError>;

    fn visit(self, verifier: &impl Verifier) -> Self::Output {
        key_by(verifier, &usable(verifier, self.traversals))
    }
}

/// The traversals that show what a way to verify needs.
fn usable<'a>(verifier: &impl Verifier, traversals: &'a [LiveTraversal]) -> Vec<&'a LiveTraversal> {
    traversals.iter().filter(|traversal| verifier.can_use(&traversal.record.rig)).collect()
}

fn key_by(verifier: &impl Verifier, traversals: &[&LiveTraversal]) -> Result<ObjectId, CatalogError> {
    let input =
        |traversal: &&LiveTraversal| (traversal.record.frames, traversal.record.chain, traversal.record.calibration);
    let inputs: Vec<CalibrationInput> = traversals.iter().map(input).collect();
    verifier.threshold_key(&inputs, APART_M, PAIRS, FRAMES)
}

fn calibrated_by(
    verifier: &impl Verifier,
    objects: &Objects,
    traversals: &[LiveTraversal],
    progress: Progress<'_>,
) -> Result<Threshold, RunError> {
    let traversals = usable(verifier, traversals);
    let key = key_by(verifier, &traversals)?;
    if let Some(known) = objects.derived(key)? {
        let ThresholdRecord { inliers, histogram } = ThresholdRecord::read(objects, known)?;
        return Ok(Threshold { inliers, histogram });
    }
    let mut inliers = Vec::new();
    for traversal in &traversals {
        let (frames, pairs) =
            wrong_pairs(&traversal.frames, &traversal.chain.poses(), PAIRS.div_ceil(traversals.len()));
        inliers.extend(pair_inliers(verifier, objects, traversal.record.calibration, &frames, &pairs, progress)?);
    }
    let threshold = Threshold::calibrate(&inliers).unwrap_or_else(|_| Threshold::uncalibrated());
    let record = ThresholdRecord { inliers: threshold.inliers, histogram: threshold.histogram.clone() };
    objects.remember(key, record.write(objects)?)?;
    Ok(threshold)
}

/// Up to `wanted` pairs of frames that lie at least [`APART_M`] apart on the chain, spread evenly over all there are:
/// the frames, and pairs of their indices.
fn wrong_pairs(frames: &[Frame], poses: &[ChainPose], wanted: usize) -> (Vec<Frame>, Vec<(usize, usize)>) {
    let count = frames.len().min(poses.len());
    let chosen: Vec<usize> = (0..count).step_by(count.div_ceil(FRAMES).max(1)).collect();
    let apart = |i: usize, j: usize| {
        let here_from_there = poses[chosen[i]].start_from_here.inverse().compose(&poses[chosen[j]].start_from_here);
        here_from_there.distance_m() >= APART_M
    };
    let all: Vec<(usize, usize)> =
        (0..chosen.len()).flat_map(|i| (0..chosen.len()).map(move |j| (i, j))).filter(|&(i, j)| apart(i, j)).collect();
    (chosen.into_iter().map(|i| frames[i]).collect(), spread(&all, wanted))
}
