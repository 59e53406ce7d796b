//! What the control hub decided, frame by frame, as programs and people read it.

use furrow_model::TimeSlot;
use furrow_runner::localiser::hub::{Decision, Moment, PairId};
use serde::Serialize;

/// A decision.
#[derive(Debug, Serialize)]
pub struct DecisionView {
    stamp_ns: i64,
    travelled_m: f64,
    /// The experience that localises; none if lost.
    pub experience: Option<String>,
    node_stamp_ns: Option<i64>,
    inliers: Option<u32>,
    /// Age of the frame that the answer is about.
    age_s: Option<f64>,
    runner_up: Option<String>,
}

/// A whole live traversal.
#[derive(Debug, Serialize)]
pub struct ReplayView {
    pub live: TimeSlot,
    pub threshold_inliers: u32,
    pub experiences: Vec<String>,
    /// Frames of the traversal.
    pub frames: usize,
    /// How many of them at least one localiser was offered.
    pub looked_at: usize,
    pub localised: usize,
    pub wall_s: f64,
    pub steps_per_s: f64,
    /// Frames that a localiser never saw, because it was computing on an earlier one.
    pub skipped: Vec<(String, u64)>,
    pub decisions: Vec<DecisionView>,
}

impl DecisionView {
    /// Names the experiences of a decision.
    pub fn of(moment: Moment, decision: &Decision, labels: &[String]) -> Self {
        let label = |pair: PairId| labels[pair.0 as usize].clone();
        let winner = decision.winner.as_ref();
        Self {
            stamp_ns: moment.stamp_ns,
            travelled_m: moment.travelled_m,
            experience: winner.map(|winner| label(winner.pair)),
            node_stamp_ns: winner.map(|winner| winner.candidate.node_stamp_ns),
            inliers: winner.map(|winner| winner.candidate.inliers),
            age_s: winner.map(|winner| winner.age_ns as f64 / 1e9),
            runner_up: decision.runner_up.as_ref().map(|second| label(second.pair)),
        }
    }

    /// The decision in a line.
    pub fn line(&self) -> String {
        let place = match (&self.experience, self.inliers, self.age_s) {
            (Some(experience), Some(inliers), Some(age_s)) => {
                format!("{experience:<24} {inliers:>4} inliers, {age_s:.2} s old")
            }
            _ => "lost".to_owned(),
        };
        format!("{:8.2} m  {place}\n", self.travelled_m)
    }
}

impl ReplayView {
    /// The sums, for people.
    pub fn text(&self) -> String {
        let skipped: Vec<String> = self.skipped.iter().map(|(label, frames)| format!("{label}: {frames}")).collect();
        format!(
            "live {}: {} of {} frames looked at, {} localised ({} inliers or more), {:.1} steps/s over {} experiences\n\
             frames that a localiser skipped: {}\n",
            self.live,
            self.looked_at,
            self.frames,
            self.localised,
            self.threshold_inliers,
            self.steps_per_s,
            self.experiences.len(),
            skipped.join(", ")
        )
    }
}
