//! Traversals: what one run along a route in one recording left.

use super::record::Record;
use furrow_model::{ExperienceId, KeyframePolicy, ObjectId, Purpose, RecordingId, StereoRig, TimeSlot};
use serde::{Deserialize, Serialize};

/// A traversal: one run along a route in one recording.
///
/// In records from before there were single cameras, `right_source` is always a text.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TraversalRecord {
    /// The recording it was cut from.
    pub recording: RecordingId,
    /// Where.
    pub site: String,
    /// Along which route.
    pub route: String,
    /// At what time of day.
    pub slot: TimeSlot,
    /// What for.
    pub purpose: Purpose,
    /// Which of the recording's pairs: `all`, `even`, `odd` or `A..B`.
    pub selection: String,
    /// Where the left images came from: a topic, or a folder's name.
    pub left_source: String,
    /// Where the right images came from; `None` where a single camera recorded.
    pub right_source: Option<String>,
    /// The rectified rig.
    pub rig: StereoRig,
    /// The calibration that turns stored images into rectified ones.
    pub calibration: ObjectId,
    /// The table of frames: one row per stereo pair, or per image of a single camera.
    pub frames: ObjectId,
    /// The chain of steps.
    pub chain: ObjectId,
    /// The version of the odometry that made it, or what gave the steps in its place: a spacing or a file of poses.
    pub odometry: String,
    /// The policy by which `keyframes` was counted.
    pub keyframes: KeyframePolicy,
    /// The experience made from it, where that is its purpose.
    pub experience: Option<ExperienceId>,
    /// Counts of what was read.
    pub counts: TraversalCounts,
    /// Frames whose partner is missing.
    pub unpaired: Vec<Unpaired>,
    /// Other sensors' tables.
    pub sensors: Vec<SensorTable>,
    /// A file of true poses in TUM form that came with the recording.
    pub ground_truth: Option<ObjectId>,
}

impl Record for TraversalRecord {
    const KIND: &'static str = "traversal";
    const VERSION: u32 = 1;
}

/// What a traversal holds.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TraversalCounts {
    /// Stereo pairs, or a single camera's images, in the recording, before the selection.
    pub pairs: u32,
    /// Frames on the chain, after the selection.
    pub frames: u32,
    /// Frames that the camera should have delivered and did not: gaps in the stamps.
    pub dropped: u32,
    /// Messages whose stamp does not come after the one before.
    pub out_of_order: u32,
    /// The chain's length in metres.
    pub length_m: f64,
    /// Steps where odometry failed.
    pub failed_steps: u32,
    /// Keyframes.
    pub keyframes: u32,
}

/// A frame without a partner.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Unpaired {
    /// Its header stamp.
    pub stamp_ns: i64,
    /// `left` or `right`: the side that is there.
    pub side: String,
}

/// Messages of another sensor, kept as Parquet tables in the order of receipt.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SensorTable {
    /// The topic.
    pub topic: String,
    /// `imu`, `nav_sat_fix` or `odometry`.
    pub kind: String,
    /// Rows in all parts.
    pub rows: u64,
    /// The table's parts in order.
    pub parts: Vec<ObjectId>,
}
