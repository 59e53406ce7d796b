//! Experiences: immutable versions of what a robot saw along a route.

use crate::{ExperienceId, KeyframePolicy, ObjectId, StereoRig, TimeSlot};
use serde::{Deserialize, Serialize};

/// How far a generated image has travelled from its parent's domain to the target's: 0 is the parent, 1 the target,
/// beyond is extrapolation (Church 2023, section 5.2).
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize)]
#[serde(transparent)]
pub struct Domainness(pub f64);

/// Where an experience's images come from.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum ExperienceKind {
    /// From a camera.
    Recorded,
    /// From another experience's images, on that experience's chain and timestamps.
    Generated {
        /// The experience whose images were moved.
        parent: ExperienceId,
        /// The generator's record.
        generator: ObjectId,
        /// How far they were moved.
        domainness: Domainness,
        /// The slot that the result stands for.
        mimics: TimeSlot,
    },
}

/// One place of an experience: the left image at a moment of the chain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Node {
    /// Header stamp; the join key into the chain.
    pub stamp_ns: i64,
    /// The left image as stored: the recording's own bytes if compressed, else PNG.
    pub left: ObjectId,
}

/// An experience. Its id is the digest of this record, so equal contents have equal ids, whatever container they came
/// in.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Experience {
    /// Where.
    pub site: String,
    /// Along which route.
    pub route: String,
    /// At what time of day.
    pub slot: TimeSlot,
    /// Recorded or generated.
    pub kind: ExperienceKind,
    /// The rectified rig.
    pub rig: StereoRig,
    /// How stored images become rectified ones: the calibration record.
    pub calibration: ObjectId,
    /// The chain of transforms, a table of its own.
    pub chain: ObjectId,
    /// How nodes were chosen from the chain's frames.
    pub keyframes: KeyframePolicy,
    /// The places, strictly increasing in time, each stamp on the chain.
    pub nodes: Vec<Node>,
}
