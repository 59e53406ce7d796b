//! What running a cell of a matrix gave. The runner computes these numbers once; reports only draw them.

use crate::{CellKey, CodebookId, ExperienceId, KeyframePolicy, ObjectId, TimeSlot, TraversalId};
use serde::{Deserialize, Serialize};

/// One cell's result. The table of events has a row per live frame and candidate; see [`event`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// The cell.
    pub key: CellKey,
    /// The slot of the live pass.
    pub live: TimeSlot,
    /// The live pass.
    pub live_traversal: TraversalId,
    /// What the cell localised against, as the matrix names it: a slot, or a collective's name.
    pub experience: String,
    /// The experiences behind that name; more than one in a collective.
    pub members: Vec<Member>,
    /// The codebook.
    pub codebook: CodebookId,
    /// Words in its vocabulary.
    pub codebook_words: u32,
    /// The place recogniser: `fabmap2`.
    pub method: String,
    /// Inliers that a localisation must reach to be accepted.
    pub threshold_inliers: u32,
    /// How the experiences' nodes were chosen.
    pub keyframes: KeyframePolicy,
    /// The numbers.
    pub evaluation: Evaluation,
    /// The events, a Parquet table.
    pub events: ObjectId,
}

/// One experience behind a cell.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Member {
    /// The version.
    pub id: ExperienceId,
    /// The slot it was recorded at or mimics.
    pub slot: TimeSlot,
    /// Its nodes.
    pub nodes: u32,
}

/// Counts and curves of one cell (SPEC 4).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evaluation {
    /// Live frames offered.
    pub frames: u32,
    /// Frames answered with a place that was then verified (not "new place").
    pub returned: u32,
    /// Frames answered "new place".
    pub new_place: u32,
    /// Frames whose place did not reach the threshold.
    pub rejected: u32,
    /// Good localisations: returned with at least `threshold_inliers`.
    pub good: u32,
    /// 100 good / returned; `None` where nothing was returned.
    pub percent_good: Option<f64>,
    /// Where the travelled distance comes from: `odometry chain` or the name of a ground truth.
    pub distance_source: String,
    /// Distances between localisations.
    pub lost: LostDistance,
    /// What a ground truth says, where there is one.
    pub ground_truth: Option<GroundTruthScore>,
}

/// Lost stretches of one live pass and their curves (SPEC 4.1).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LostDistance {
    /// The route's length in metres.
    pub route_m: f64,
    /// Lengths of the lost stretches in metres, in the order driven; the first and last may be cut off by the route's ends.
    pub stretches_m: Vec<f64>,
    /// Share of the route driven lost, P(0) of the survival curve, 0 to 1.
    pub lost_fraction: f64,
    /// The longest stretch in metres; 0 where never lost.
    pub max_lost_m: f64,
    /// The mean stretch in metres; 0 where never lost.
    pub mean_lost_m: f64,
    /// The area under the survival curve in metres: sum g^2 / (2 L).
    pub area_m: f64,
    /// The curves on a common grid of distances.
    pub curve: Vec<LostPoint>,
}

/// The lost-distance variants at one distance d, each a share between 0 and 1.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LostPoint {
    /// d in metres.
    pub distance_m: f64,
    /// Chance that at a random metre more than d has been driven since the last localisation.
    pub survival: f64,
    /// Lower end of the survival's 95 % moving-block bootstrap band.
    pub survival_low: f64,
    /// Upper end of that band.
    pub survival_high: f64,
    /// Chance that a random metre lies in a lost stretch longer than d.
    pub length_biased: f64,
    /// Share of lost stretches longer than d.
    pub per_gap: f64,
}

/// Scores against a ground truth (SPEC 4.2).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroundTruthScore {
    /// Where the ground truth comes from, such as `simulation` or `GPS fix of the recording`.
    pub source: String,
    /// Accepted and right.
    pub correct: u32,
    /// Accepted and wrong.
    pub wrong: u32,
    /// Not accepted although a mapped place exists.
    pub missed: u32,
    /// Not accepted, and no mapped place exists.
    pub rightly_refused: u32,
    /// correct / (correct + wrong).
    pub precision: Option<f64>,
    /// correct / live frames that have a mapped place.
    pub recall: Option<f64>,
    /// Share of frames with a mapped place whose best candidate was right before verification.
    pub recall_at_1: Option<f64>,
    /// Root mean square distance of accepted answers to the live frame's true position, metres.
    pub position_rmse_m: Option<f64>,
    /// The largest such distance, metres.
    pub position_max_m: Option<f64>,
}

/// Column names and values of the events table: one row per live frame and candidate, in order of frame, then experience, then rank. A frame
/// that an experience answered "new place" has one row for it, with null in the node's columns.
pub mod event {
    /// i64: the live frame's header stamp.
    pub const LIVE_STAMP_NS: &str = "live_stamp_ns";
    /// f64: distance travelled by the live pass so far, metres.
    pub const TRAVELLED_M: &str = "travelled_m";
    /// String: the live left image's object id.
    pub const LIVE_IMAGE: &str = "live_image";
    /// String: id of the experience that answers.
    pub const EXPERIENCE: &str = "experience";
    /// u32: 0 for the experience's best candidate.
    pub const RANK: &str = "rank";
    /// i64, null for new place: the candidate's stamp.
    pub const NODE_STAMP_NS: &str = "node_stamp_ns";
    /// String, null for new place: the candidate's left image object id.
    pub const NODE_IMAGE: &str = "node_image";
    /// f64: log-likelihood of the candidate, or of the new place.
    pub const LOG_LIKELIHOOD: &str = "log_likelihood";
    /// f64: log-likelihood of the new place.
    pub const NEW_PLACE_LOG_LIKELIHOOD: &str = "new_place_log_likelihood";
    /// f64: posterior of the candidate, or of the new place.
    pub const POSTERIOR: &str = "posterior";
    /// u32, null where not verified: matches that entered verification.
    pub const MATCHES: &str = "matches";
    /// u32, null where not verified: inliers.
    pub const INLIERS: &str = "inliers";
    /// String: [`ACCEPTED`], [`REJECTED`], [`NEW_PLACE`], [`OUTVOTED`] or [`NOT_VERIFIED`].
    pub const DECISION: &str = "decision";
    /// f64, null without ground truth or node: distance along the ground from the live frame to the candidate, metres.
    pub const ERROR_M: &str = "error_m";
    /// bool, null without ground truth or node: whether the candidate is right.
    pub const CORRECT: &str = "correct";
    /// f64, null without ground truth: the live frame's true position, metres east of the ground truth's origin.
    pub const EAST_M: &str = "east_m";
    /// f64, null without ground truth: metres north.
    pub const NORTH_M: &str = "north_m";

    /// The frame's localisation.
    pub const ACCEPTED: &str = "accepted";
    /// Verified, below the threshold.
    pub const REJECTED: &str = "rejected";
    /// The experience called it a new place.
    pub const NEW_PLACE: &str = "new place";
    /// Reached the threshold, but another candidate had more inliers.
    pub const OUTVOTED: &str = "outvoted";
    /// A candidate behind the new place, or beyond those that are verified.
    pub const NOT_VERIFIED: &str = "not verified";
}
