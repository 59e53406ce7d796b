//! The numbers of one cell. The runner computes them; reports only draw them.

use serde::{Deserialize, Serialize};

/// Counts and curves of one cell.
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
    /// Good localisations: returned with at least the threshold's inliers.
    pub good: u32,
    /// The 95 % interval of `good` along this one traversal: Wilson's, with the trials that the correlation along the
    /// road leaves. `None` of too little road, below 60 m.
    pub good_interval: Option<[u32; 2]>,
    /// 100 good / frames; 0 without frames. Cells are ranked by it.
    pub percent_of_frames: f64,
    /// 100 good / returned; `None` where nothing was returned.
    pub percent_good: Option<f64>,
    /// Consecutive good localisations between which the place moved over 5 m further along the map than the robot
    /// travelled.
    pub jumps: u32,
    /// Where the travelled distance comes from: `odometry chain` or the name of a ground truth.
    pub distance_source: String,
    /// Distances between localisations.
    pub lost: LostDistance,
    /// The same at other thresholds, the lowest first.
    pub thresholds: Vec<AtThreshold>,
    /// What a ground truth says, where there is one.
    pub ground_truth: Option<GroundTruthScore>,
}

/// What another threshold would have given: 0.75 and 1.5 times the one in use stand beside it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct AtThreshold {
    /// The threshold.
    pub inliers: u32,
    /// Good localisations.
    pub good: u32,
    /// 100 good / returned; `None` where nothing was returned.
    pub percent_good: Option<f64>,
    /// Share of the route travelled lost.
    pub lost_fraction: f64,
    /// The longest lost stretch in metres.
    pub max_lost_m: f64,
    /// Accepted and right; `None` without ground truth.
    pub correct: Option<u32>,
    /// Accepted and wrong; `None` without ground truth.
    pub wrong: Option<u32>,
}

/// Lost stretches of one live traversal and their curves (Church 2023, section 6.4.1, Fig. 6.3).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LostDistance {
    /// The route's length in metres; without the stretches that were dropped.
    pub route_m: f64,
    /// The lost stretches in the order travelled.
    pub stretches: Vec<LostStretch>,
    /// Share of the route travelled lost, P(0) of the survival curve, 0 to 1.
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

/// A stretch of route travelled without a localisation.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LostStretch {
    /// Distance travelled where it begins, metres.
    pub from_m: f64,
    /// Distance travelled where it ends, metres.
    pub to_m: f64,
    /// Whether the route's start or end cuts it off: the robot may have been lost for longer.
    pub censored: bool,
}

impl LostStretch {
    /// Its length in metres.
    pub fn length_m(self) -> f64 {
        self.to_m - self.from_m
    }
}

/// What becomes of stretches that the route's ends cut off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Censored {
    /// They count as long as they are.
    #[default]
    Keep,
    /// They do not count, and their length is not part of the route's.
    Drop,
}

/// The lost-distance variants at one distance d, each a share between 0 and 1, with their 95 % bands along this one
/// road; `None` of too little road, and of lengths of stretches where nothing was lost.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LostPoint {
    /// d in metres.
    pub distance_m: f64,
    /// Chance that at a random metre more than d has been travelled since the last localisation. The CDF variant is 1
    /// less this.
    pub survival: f64,
    /// Lower and upper end of its band.
    pub survival_band: Option<[f64; 2]>,
    /// Chance that a random metre lies in a lost stretch longer than d.
    pub length_biased: f64,
    /// Lower and upper end of its band.
    pub length_biased_band: Option<[f64; 2]>,
    /// Share of lost stretches longer than d.
    pub per_gap: f64,
    /// Lower and upper end of its band.
    pub per_gap_band: Option<[f64; 2]>,
}

/// Scores against a ground truth.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GroundTruthScore {
    /// Where the ground truth comes from, such as `simulation` or `GPS fix of the recording`.
    pub source: String,
    /// Live frames that have a mapped place: the denominator of every recall.
    pub mapped: u32,
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
    /// correct / mapped.
    pub recall: Option<f64>,
    /// wrong / (correct + wrong).
    pub false_acceptance: Option<f64>,
    /// Share of frames without a mapped place that were accepted.
    pub false_positive_rate: Option<f64>,
    /// Share of mapped frames whose verified candidate with most inliers is right, whatever the threshold.
    pub recall_of_answers: Option<f64>,
    /// The greatest recall that some threshold gives without a wrong answer.
    pub recall_at_full_precision: Option<f64>,
    /// Share of mapped frames whose most likely hypothesis, new place among them, was right before verification. Like
    /// the next three `None` of a collective: its hub ranks by inliers, not by likelihood.
    pub recall_at_1: Option<f64>,
    /// Share of mapped frames with a right one among the five most likely.
    pub recall_at_5: Option<f64>,
    /// Among the ten most likely.
    pub recall_at_10: Option<f64>,
    /// Among the twenty most likely.
    pub recall_at_20: Option<f64>,
    /// Recall over the tolerated distance; empty without mapped frames.
    pub recall_within: Vec<RecallWithin>,
    /// How much of the route has a wanted recall; empty without mapped frames.
    pub route_recalled: Vec<RouteRecalled>,
    /// Precision and recall at every number of inliers that occurs, the highest first.
    pub precision_recall: Vec<PrecisionRecall>,
    /// The area under that curve: each step of recall counts with the precision it ends at. `None` without mapped
    /// frames.
    pub average_precision: Option<f64>,
    /// Root mean square distance of accepted answers to the live frame's true position, metres.
    pub position_rmse_m: Option<f64>,
    /// The largest such distance, metres.
    pub position_max_m: Option<f64>,
}

/// Precision and recall of accepting what has at least so many inliers.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrecisionRecall {
    /// The threshold.
    pub inliers: u32,
    /// Right answers among the accepted ones.
    pub precision: f64,
    /// Right answers among the mapped frames.
    pub recall: f64,
}

/// Share of mapped frames accepted within a distance of the true position, whatever the heading.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RecallWithin {
    /// The distance on the ground, metres.
    pub metres: f64,
    /// Accepted within it / mapped.
    pub recall: f64,
}

/// Share of the stretches of 10 m, of those with mapped frames, that reach a recall.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RouteRecalled {
    /// The wanted share of the stretch's mapped frames that are localised right.
    pub recall: f64,
    /// Stretches that reach it / stretches.
    pub share: f64,
}
