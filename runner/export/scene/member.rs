//! An experience behind the cell, and where it stands.

use super::super::answers::Answers;
use super::super::camera::Camera;
use super::super::message::world_from_camera;
use crate::RunError;
use crate::evaluate::truth::GroundTruth;
use furrow_catalog::{Objects, tables};
use furrow_model::trajectory::ChainPose;
use furrow_model::{Experience, ExperienceId, Se3, shown};
use std::collections::BTreeMap;

/// An experience.
pub(in crate::export) struct Member {
    /// From 1: its name in topics and frames of reference. Labels may hold anything.
    pub number: u32,
    pub id: ExperienceId,
    pub label: String,
    /// The left camera's first frame.
    pub odometry: String,
    /// The left camera where the answering node was taken.
    pub left: String,
    pub camera: Camera,
    /// By stamp: where odometry has the nodes.
    pub nodes: BTreeMap<i64, Se3>,
    pub placed: Placed,
}

/// How an experience's odometry stands to the live traversal.
pub(in crate::export) enum Placed {
    /// In the world, by the first node whose true pose is known.
    Truth { truth: GroundTruth, world_from_start: Se3 },
    /// Beside the live odometry, as if live frame and node of the localisation with most inliers were one.
    Localisation { live_ns: i64, live_from_start: Se3 },
    /// Nothing is known.
    Nowhere,
}

impl Member {
    /// Reads what an experience shows, `number` counted from 0. It stands nowhere yet.
    pub fn load(
        objects: &Objects,
        number: usize,
        label: &str,
        id: ExperienceId,
        record: Experience,
    ) -> Result<Self, RunError> {
        let number = number as u32 + 1;
        let chain = tables::chain_from_parquet(objects.read(record.chain)?)?;
        let poses: BTreeMap<i64, Se3> =
            chain.poses().into_iter().map(|pose| (pose.stamp_ns, pose.start_from_here)).collect();
        let nodes = record.nodes.iter().filter_map(|node| Some((node.stamp_ns, *poses.get(&node.stamp_ns)?)));
        let left = format!("experience_{number}_left");
        Ok(Self {
            number,
            id,
            label: shown(label),
            odometry: format!("experience_{number}_odometry"),
            camera: Camera::load(objects, record.calibration, left.clone())?,
            left,
            nodes: nodes.collect(),
            placed: Placed::Nowhere,
        })
    }

    /// Finds its place: by its true poses where it shares a ground truth with the live traversal, else by the
    /// localisations.
    pub fn place(&mut self, member: usize, truth: Option<GroundTruth>, live: &[ChainPose], answers: &[Answers]) {
        let known = truth.and_then(|truth| {
            let mut nodes = self.nodes.iter();
            let found = nodes.find_map(|(stamp_ns, node)| {
                truth.at(*stamp_ns).map(|at| world_from_camera(at).compose(&node.inverse()))
            });
            found.map(|world_from_start| Placed::Truth { truth, world_from_start })
        });
        self.placed = known.or_else(|| self.beside(member, live, answers)).unwrap_or(Placed::Nowhere);
    }

    fn beside(&self, member: usize, live: &[ChainPose], answers: &[Answers]) -> Option<Placed> {
        let accepted = live.iter().zip(answers).filter_map(|(pose, answers)| Some((pose, answers.accepted()?)));
        // Of equals the last is kept: the first, from behind.
        let own: Vec<_> = accepted.filter(|(_, place)| place.member == member).collect();
        let (pose, place) = own.into_iter().rev().max_by_key(|(_, place)| place.inliers)?;
        let node = self.nodes.get(&place.node?.0)?;
        let live_from_start = pose.start_from_here.compose(&node.inverse());
        Some(Placed::Localisation { live_ns: pose.stamp_ns, live_from_start })
    }

    /// How it was placed, in words.
    pub fn placed(&self) -> String {
        match &self.placed {
            Placed::Truth { truth, .. } => {
                format!("in world, by the first of its nodes with a ground truth: {}; level, at height 0", truth.source)
            }
            Placed::Localisation { live_ns, .. } => {
                format!(
                    "in live_odometry, its node taken to be where the live frame at {live_ns} ns is, which it localised with most inliers"
                )
            }
            Placed::Nowhere => "nowhere: neither a ground truth nor a localisation".to_owned(),
        }
    }
}
