//! What running a cell of a matrix gave. The runner computes these numbers once; reports only draw them.

use crate::{CellKey, CodebookId, Evaluation, ExperienceId, KeyframePolicy, ObjectId, TimeSlot, TraversalId};
use serde::{Deserialize, Serialize};

/// One cell's result. The table of events has a row per live frame and candidate; see [`event`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// The cell.
    pub key: CellKey,
    /// The slot of the live traversal.
    pub live: TimeSlot,
    /// The live traversal.
    pub live_traversal: TraversalId,
    /// What the cell localised against, as the matrix names it: a slot, or a collective's name.
    pub experience: String,
    /// How a collective chose among its members, as the matrix says it: `all`, or `agree 2`.
    pub policy: String,
    /// The experiences behind that name; more than one in a collective.
    pub members: Vec<Member>,
    /// The codebook; none where the recogniser knows no words.
    pub codebook: Option<CodebookId>,
    /// Words in its vocabulary.
    pub codebook_words: u32,
    /// Smallest determinant of the Hessian of the features that words and verification of a single camera rest on.
    pub hessian: f64,
    /// Whether their orientation was left at upright.
    pub upright: bool,
    /// The place recogniser, such as `fabmap2`.
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

impl Outcome {
    /// The same under the name that a cell gives it: cells of other names with the same inputs share their outcome.
    pub fn named(self, experience: &str) -> Self {
        Self { experience: experience.to_owned(), ..self }
    }
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

/// Column names and values of the events table: one row per live frame and candidate, in order of frame, then
/// experience, then rank. A frame that an experience answered "new place" has one row for it, with null in the node's
/// columns.
pub mod event {
    /// i64: the live frame's header stamp.
    pub const LIVE_STAMP_NS: &str = "live_stamp_ns";
    /// f64: distance travelled on the live traversal so far, metres.
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
    /// String: [`ACCEPTED`], [`REJECTED`], [`NEW_PLACE`], [`OUTVOTED`], [`ALONE`], [`OVERRULED`] or [`NOT_VERIFIED`].
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
    /// Reached the threshold, but too few other experiences found a place.
    pub const ALONE: &str = "alone";
    /// Reached the threshold, but the oracle says that the place is wrong.
    pub const OVERRULED: &str = "overruled";
    /// A candidate behind the new place, of an experience that was not asked, or beyond those that are verified.
    pub const NOT_VERIFIED: &str = "not verified";
}
