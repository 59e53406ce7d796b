//! The live traversal, the experiences, and the frames of reference that they stand in.
//!
//! Odometry knows where its first frame is, and nothing else: each track has a frame of reference of its own. Where
//! true poses are known, all stand in the world by them. Else an experience is set beside the live track where a
//! localisation says that live frame and node are one place.

mod member;

pub(super) use member::{Member, Placed};

use super::Exporting;
use super::answers::{Answers, Place, read};
use super::message::world_from_camera;
use crate::RunError;
use crate::evaluate::truth::GroundTruth;
use crate::inputs::traversals::LiveTraversal;
use furrow_catalog::Catalog;
use furrow_catalog::records::{FeatureParameters, TraversalRecord};
use furrow_model::trajectory::ChainPose;
use furrow_model::{Purpose, Se3};
use std::collections::BTreeMap;

/// East, north, up: the frame of the ground truth.
pub(super) const WORLD: &str = "world";
/// The left camera's first frame in the live traversal: x right, y down, z forward.
pub(super) const LIVE_ODOMETRY: &str = "live_odometry";
/// The left camera of the live traversal.
pub(super) const LIVE_LEFT: &str = "live_left";

/// All that is shown.
pub(super) struct Scene {
    pub live: LiveTraversal,
    /// Where odometry has the live frames.
    pub poses: Vec<ChainPose>,
    /// Where they really were.
    pub truth: Option<GroundTruth>,
    pub members: Vec<Member>,
    /// What was answered to each live frame.
    pub answers: Vec<Answers>,
    pub threshold: u32,
    /// How keypoints are found where verification has one camera.
    pub features: FeatureParameters,
}

impl Scene {
    /// Reads all but images.
    pub fn load(catalog: &Catalog, exporting: Exporting<'_>) -> Result<Self, RunError> {
        let (objects, outcome) = (catalog.objects(), exporting.outcome);
        let live = LiveTraversal::load(catalog, outcome.live_traversal)?;
        let poses = live.chain.poses();
        if poses.len() != live.frames.len() {
            let (poses, frames) = (poses.len(), live.frames.len());
            return Err(RunError::Recording(format!("the chain has {poses} poses for {frames} live frames")));
        }
        let truth = GroundTruth::of(objects, &live.record)?;
        let mut answered: BTreeMap<i64, Answers> =
            read(objects, outcome)?.into_iter().map(|answers| (answers.stamp_ns, answers)).collect();
        let unanswered = |stamp_ns| Answers { stamp_ns, places: Vec::new() };
        let answers: Vec<Answers> = (live.frames.iter())
            .map(|frame| answered.remove(&frame.stamp_ns).unwrap_or_else(|| unanswered(frame.stamp_ns)))
            .collect();
        let recorded = recorded_traversals(catalog, exporting, &live.record.site)?;
        let mut members = Vec::new();
        for (number, member) in outcome.members.iter().enumerate() {
            let record = catalog.experience(member.id)?;
            let traversal = recorded.iter().find(|traversal| traversal.chain == record.chain);
            let own = traversal.map(|traversal| GroundTruth::of(objects, traversal)).transpose()?.flatten();
            let shared = truth.as_ref().zip(own).filter(|(truth, own)| truth.frame == own.frame);
            let own = shared.map(|(truth, own)| own.in_frame_of(truth));
            let label =
                if outcome.members.len() > 1 { member.slot.to_string() } else { exporting.cell.experience.clone() };
            let mut member = Member::load(objects, number, &label, member.id, record)?;
            member.place(number, own, &poses, &answers);
            members.push(member);
        }
        let features = FeatureParameters { hessian: outcome.hessian, upright: outcome.upright };
        Ok(Self { live, poses, truth, members, answers, threshold: outcome.threshold_inliers, features })
    }

    /// The first live frame whose true pose is known places the whole odometry in the world.
    fn world_from_live(&self) -> Option<Se3> {
        let truth = self.truth.as_ref()?;
        self.poses
            .iter()
            .find_map(|pose| Some(world_from_camera(truth.at(pose.stamp_ns)?).compose(&pose.start_from_here.inverse())))
    }

    /// How the live track was placed, in words.
    pub fn live_placed(&self) -> String {
        let source = self.truth.as_ref().filter(|_| self.world_from_live().is_some()).map(|truth| &truth.source);
        source.map_or_else(
            || "nowhere: no ground truth".to_owned(),
            |source| format!("in world, by the first of its frames with a ground truth: {source}; level, at height 0"),
        )
    }

    /// Transforms that hold for the whole traversal: parent, child, parent from child.
    pub fn standing(&self) -> Vec<(&str, &str, Se3)> {
        let live = self.world_from_live().map(|world_from_live| (WORLD, LIVE_ODOMETRY, world_from_live));
        let members = self.members.iter().filter_map(|member| match &member.placed {
            Placed::Truth { world_from_start, .. } => Some((WORLD, member.odometry.as_str(), *world_from_start)),
            Placed::Localisation { live_from_start, .. } => {
                Some((LIVE_ODOMETRY, member.odometry.as_str(), *live_from_start))
            }
            Placed::Nowhere => None,
        });
        live.into_iter().chain(members).collect()
    }

    /// From where a live frame was to the place that answers it: frame of reference, and both points in metres. By
    /// ground truth where both are known, else by odometry and the experience's place beside it.
    pub fn line(&self, frame: usize, place: &Place) -> Option<(&'static str, [[f64; 3]; 2])> {
        let (member, (node_ns, _)) = (&self.members[place.member], place.node?);
        let live = &self.poses[frame];
        match &member.placed {
            Placed::Truth { truth, .. } => {
                let ground = |truth: &GroundTruth, stamp_ns| truth.at(stamp_ns).map(|at| [at.east_m, at.north_m, 0.0]);
                Some((WORLD, [ground(self.truth.as_ref()?, live.stamp_ns)?, ground(truth, node_ns)?]))
            }
            Placed::Localisation { live_from_start, .. } => {
                let node = live_from_start.apply(member.nodes.get(&node_ns)?.translation_m);
                Some((LIVE_ODOMETRY, [live.start_from_here.translation_m, node]))
            }
            Placed::Nowhere => None,
        }
    }
}

/// The traversals that experiences of the site were made of, those of the run first.
fn recorded_traversals(
    catalog: &Catalog,
    exporting: Exporting<'_>,
    site: &str,
) -> Result<Vec<TraversalRecord>, RunError> {
    let mut rows = catalog.traversals()?;
    // The run's own versions go first: others may have other true poses by now.
    for id in &exporting.record.traversals {
        rows.extend(catalog.traversal_row(*id)?);
    }
    rows.retain(|row| row.site == site && row.purpose == Purpose::Experience);
    let mut ids: Vec<_> = rows.into_iter().map(|row| row.id).collect();
    ids.sort_by_key(|id| !exporting.record.traversals.contains(id));
    Ok(ids.into_iter().map(|id| catalog.traversal(id)).collect::<Result<_, _>>()?)
}
