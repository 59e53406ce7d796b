//! Odometry beside the ground truth, for people to look at.

use crate::RunError;
use crate::evaluate::truth::GroundTruth;
use furrow_catalog::records::TraversalRecord;
use furrow_catalog::{Objects, tables};
use furrow_ingest::odometry::compare::{Alignment, Spread, align, position_errors};
use furrow_model::Se3;

/// A traversal's chain, seen from above and laid over its ground truth by the rotation and shift of least squared
/// distance (Umeyama 1991).
#[derive(Debug, Clone, PartialEq)]
pub struct LaidTrack {
    /// What the truth comes from.
    pub source: String,
    /// True positions, east and north in metres.
    pub truth_m: Vec<[f64; 2]>,
    /// The chain's positions at the same frames, in the same frame of reference.
    pub chain_m: Vec<[f64; 2]>,
    /// Root mean square of their horizontal distance: evo's APE after alignment, without heights, in metres.
    pub rms_m: f64,
    /// The chain's length in metres.
    pub length_m: f64,
}

/// Lays a traversal's chain over its ground truth; `None` where there is none, where the chain was given and not
/// estimated, or where the positions lie on a line, so that no rotation is best.
///
/// # Errors
/// Where a table or the pose file cannot be read.
pub fn laid_over_truth(objects: &Objects, traversal: &TraversalRecord) -> Result<Option<LaidTrack>, RunError> {
    let Some(truth) = GroundTruth::of(objects, traversal)? else { return Ok(None) };
    let chain = tables::chain_from_parquet(objects.read(traversal.chain)?)?;
    if chain.steps.iter().all(|step| step.covariance.is_none()) {
        return Ok(None);
    }
    let flat = |[east, north]: [f64; 2]| Se3 { translation_m: [east, north, 0.0], ..Se3::IDENTITY };
    let (mut reference, mut estimate) = (Vec::new(), Vec::new());
    for pose in chain.poses() {
        if let Some(truth) = truth.at(pose.stamp_ns) {
            let [right_m, _, forward_m] = pose.start_from_here.translation_m;
            reference.push(flat([truth.east_m, truth.north_m]));
            estimate.push(flat([right_m, forward_m]));
        }
    }
    let Some((laid, _)) = align(&reference, &estimate, Alignment::Rigid) else { return Ok(None) };
    let Some(apart) = Spread::of(&position_errors(&reference, &laid).translation_m) else { return Ok(None) };
    let from_above = |track: &[Se3]| track.iter().map(|pose| [pose.translation_m[0], pose.translation_m[1]]).collect();
    Ok(Some(LaidTrack {
        source: truth.source,
        truth_m: from_above(&reference),
        chain_m: from_above(&laid),
        rms_m: apart.rmse,
        length_m: chain.length_m(),
    }))
}
