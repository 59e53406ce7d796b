//! Right or wrong, by ground truth: a candidate is right where it lies near the live frame along, across and in
//! heading.

use crate::RunError;
use crate::evaluate::truth::{GroundPose, GroundTruth, wrap};
use crate::inputs::contender::Contender;
use crate::inputs::traversals::LiveTraversal;
use furrow_catalog::Objects;
use furrow_model::KeyframePolicy;

/// A localisation is right within this distance along the route, or the keyframe spacing if that is more.
const ALONG_M: f64 = 2.5;
/// And within this distance across.
const ACROSS_M: f64 = 2.0;
/// And looking within this angle of the same way.
const TURN_RAD: f64 = 15.0 * std::f64::consts::PI / 180.0;

/// A live frame: when, how far into the traversal, and where it really was.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LiveMoment {
    /// Header stamp.
    pub stamp_ns: i64,
    /// Distance travelled along the chain, metres.
    pub travelled_m: f64,
    /// The true pose, where it is known.
    pub truth: Option<GroundPose>,
}

/// A candidate against the truth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judged {
    /// Distance on the ground between the live frame and the node, metres.
    pub error_m: f64,
    /// Whether it is the right place.
    pub correct: bool,
}

/// Knows where live frames and nodes really were.
#[derive(Debug)]
pub struct Judge {
    moments: Vec<LiveMoment>,
    /// Per experience, per node.
    nodes: Vec<Vec<Option<GroundPose>>>,
    /// Per experience, per node: distance along its chain, metres.
    travelled_m: Vec<Vec<f64>>,
    source: Option<String>,
    distance_source: String,
    along_m: f64,
}

impl Judge {
    /// For a live traversal against experiences. Without a ground truth that live traversal and all experiences share,
    /// nothing is judged.
    ///
    /// # Errors
    /// Where a ground truth cannot be read.
    pub fn new(
        objects: &Objects,
        live: &LiveTraversal,
        members: &[&Contender],
        keyframes: KeyframePolicy,
    ) -> Result<Self, RunError> {
        let truth = GroundTruth::of(objects, &live.record)?;
        let mut others: Vec<Option<GroundTruth>> =
            members.iter().map(|member| GroundTruth::of(objects, &member.traversal)).collect::<Result<_, _>>()?;
        if let Some(truth) = &truth {
            others = others.into_iter().map(|other| other.map(|other| other.in_frame_of(truth))).collect();
        }
        let shared =
            truth.filter(|truth| others.iter().all(|other| other.as_ref().is_some_and(|o| o.frame == truth.frame)));
        let at = |truth: Option<&GroundTruth>, stamp_ns| truth.and_then(|truth| truth.at(stamp_ns));
        let moments = live.chain.poses().into_iter().map(|pose| LiveMoment {
            stamp_ns: pose.stamp_ns,
            travelled_m: pose.travelled_m,
            truth: at(shared.as_ref(), pose.stamp_ns),
        });
        let nodes = members.iter().zip(&others).map(|(member, other)| {
            let other = other.as_ref().filter(|_| shared.is_some());
            member.record.nodes.iter().map(|node| at(other, node.stamp_ns)).collect()
        });
        Ok(Self {
            moments: moments.collect(),
            nodes: nodes.collect(),
            travelled_m: members.iter().map(|member| member.travelled_m(objects)).collect::<Result<_, _>>()?,
            source: shared.as_ref().map(|truth| truth.source.clone()),
            distance_source: furrow_ingest::traversal::distance_source(&live.record),
            along_m: keyframes.distance_m.max(ALONG_M),
        })
    }

    /// The live frames.
    pub fn moments(&self) -> &[LiveMoment] {
        &self.moments
    }

    /// What the truth comes from; `None` where nothing is judged.
    pub fn source(&self) -> Option<&str> {
        self.source.as_deref()
    }

    /// What the live frames' distances come from.
    pub fn distance_source(&self) -> &str {
        &self.distance_source
    }

    /// How many experiences answer.
    pub fn members(&self) -> usize {
        self.nodes.len()
    }

    /// How far along its experience's chain a node was taken, metres.
    pub fn node_travelled_m(&self, member: usize, node: u32) -> Option<f64> {
        self.travelled_m.get(member)?.get(node as usize).copied()
    }

    /// A candidate against the truth; `None` where either pose is not known.
    pub fn judge(&self, frame: usize, member: usize, node: u32) -> Option<Judged> {
        let live = self.moments.get(frame)?.truth?;
        let place = (*self.nodes.get(member)?.get(node as usize)?)?;
        Some(self.compare(live, place))
    }

    /// Whether some node of some experience would be right for a live frame; `None` where the frame's pose is not
    /// known.
    pub fn has_mapped_place(&self, frame: usize) -> Option<bool> {
        let live = self.moments.get(frame)?.truth?;
        Some(self.nodes.iter().flatten().flatten().any(|place| self.compare(live, *place).correct))
    }

    fn compare(&self, live: GroundPose, place: GroundPose) -> Judged {
        let (east_m, north_m) = (place.east_m - live.east_m, place.north_m - live.north_m);
        let (cos, sin) = (libm::cos(live.heading_rad), libm::sin(live.heading_rad));
        let (along_m, across_m) = (east_m * cos + north_m * sin, north_m * cos - east_m * sin);
        let turn_rad = wrap(place.heading_rad - live.heading_rad);
        Judged {
            error_m: libm::hypot(east_m, north_m),
            correct: along_m.abs() <= self.along_m && across_m.abs() <= ACROSS_M && turn_rad.abs() <= TURN_RAD,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judge() -> Judge {
        Judge {
            moments: Vec::new(),
            nodes: Vec::new(),
            travelled_m: Vec::new(),
            source: None,
            distance_source: String::new(),
            along_m: 2.5,
        }
    }

    #[test]
    fn what_right_means_is_told_in_these_numbers() {
        let turn = format!("within {:.0} degrees", TURN_RAD.to_degrees());
        for said in [format!("within {ALONG_M} m"), format!("within {ACROSS_M} m across"), turn] {
            assert!(furrow_model::metric::RIGHT.contains(&said), "{said}");
        }
    }

    #[test]
    fn right_means_near_along_across_and_in_turn() {
        // Looking north-east: along is (1, 1) / sqrt 2.
        let heading_rad = std::f64::consts::FRAC_PI_4;
        let live = GroundPose { east_m: 10.0, north_m: 20.0, heading_rad };
        let place = |along: f64, across: f64, turn: f64| {
            let half = std::f64::consts::FRAC_1_SQRT_2;
            let (east_m, north_m) = (10.0 + half * (along - across), 20.0 + half * (along + across));
            judge().compare(live, GroundPose { east_m, north_m, heading_rad: heading_rad + turn })
        };
        assert!(place(2.4, 0.0, 0.0).correct && place(-2.4, 1.9, 0.2).correct);
        assert!(!place(2.6, 0.0, 0.0).correct && !place(0.0, 2.1, 0.0).correct && !place(0.0, 0.0, 0.3).correct);
        assert!((place(3.0, 4.0, 0.0).error_m - 5.0).abs() < 1e-9);
        assert!(place(0.0, 0.0, std::f64::consts::TAU).correct);
    }
}
