//! Every record that is stored, in one module: a change of format has one home. A record is JSON with its kind and format version in front;
//! keys stand in the order of the fields, floats in their shortest form that reads back the same, so equal records are equal bytes.

use crate::{CatalogError, Objects, digest};
use furrow_model::{
    Experience, ExperienceId, KeyframePolicy, ObjectId, Outcome, Purpose, RecordingId, StereoRig, TimeSlot, TraversalId,
};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Deserializer, Serialize};

/// A stored record: what names its kind and format.
pub trait Record: Serialize + DeserializeOwned {
    /// The kind, as written in the record.
    const KIND: &'static str;
    /// The version of the format; it changes whenever a field does.
    const VERSION: u32;
}

impl Record for Experience {
    const KIND: &'static str = "experience";
    const VERSION: u32 = 1;
}

impl Record for Outcome {
    const KIND: &'static str = "outcome";
    const VERSION: u32 = 3;
}

/// One pass along a route in one recording.
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

/// A codebook: vocabulary, Chow-Liu tree and sample descriptors, each a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CodebookRecord {
    /// The site its images come from.
    pub site: String,
    /// The routes they come from; nothing may be judged on these.
    pub route: String,
    /// Left images that it was trained on, in order.
    pub images: Vec<ObjectId>,
    /// Words in the vocabulary.
    pub words: u32,
    /// How features were found in the images.
    pub features: FeatureParameters,
    /// The trainer and its version.
    pub trainer: String,
    /// The trainer's seed.
    pub seed: u64,
    /// Root mean square distance of the training descriptors to their words.
    pub quantisation_error: f64,
    /// The vocabulary: a row per word.
    pub vocabulary: ObjectId,
    /// The tree: a row per word.
    pub tree: ObjectId,
    /// The sample descriptors: a row per image and word.
    pub samples: ObjectId,
}

impl Record for CodebookRecord {
    const KIND: &'static str = "codebook";
    const VERSION: u32 = 1;
}

/// A generator: what moves the images of one time of day towards another.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GeneratorRecord {
    /// What users call it.
    pub name: String,
    /// `otf`, `invariant`, `identity`, `gamma`, `noise`, `blur`, `command` or `onnx`.
    pub kind: String,
    /// The program that trained or runs it, and its version.
    pub algorithm: String,
    /// What it moves images from; none where it knows no hour.
    pub source: Option<TrainingDomain>,
    /// What it moves images towards.
    pub target: Option<TrainingDomain>,
    /// How it was trained or is run.
    pub parameters: serde_json::Value,
    /// The trained model's bytes.
    pub weights: ObjectId,
}

impl Record for GeneratorRecord {
    const KIND: &'static str = "generator";
    const VERSION: u32 = 1;
}

/// One side of a generator's training; nothing may be judged on these images or this ground.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainingDomain {
    /// The slot that the images stand for.
    pub slot: TimeSlot,
    /// The passes they come from; none for a model that was trained elsewhere.
    pub traversals: Vec<TraversalId>,
    /// The left images, in order.
    pub images: Vec<ObjectId>,
}

/// SURF's parameters, as records and keys spell them.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FeatureParameters {
    /// Smallest determinant of the Hessian.
    pub hessian: f64,
    /// Whether orientation is left at upright.
    pub upright: bool,
}

/// A run: a matrix as resolved against the store.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunRecord {
    /// The matrix' name.
    pub name: String,
    /// The site.
    pub site: String,
    /// The matrix file's text.
    pub source: String,
    /// The figures asked for.
    pub figures: Vec<String>,
    /// The cells in the matrix' order.
    pub cells: Vec<RunCell>,
    /// Cells that could not be run, and why.
    pub blocked: Vec<BlockedCell>,
    /// The passes that the matrix came to: what has to be ingested to run it again elsewhere. Not written by old versions.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub passes: Vec<TraversalId>,
    /// The generators that it names.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub generators: Vec<ObjectId>,
    /// Which contenders are set against which, setting by setting; none where the matrix asks for no contrast.
    #[serde(default, skip_serializing_if = "Vec::is_empty", deserialize_with = "one_or_many")]
    pub contrasts: Vec<RunContrasts>,
}

/// Runs from before there were settings have the contrasts of the only one, and name no cells: run again, they are made.
fn one_or_many<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<RunContrasts>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Written {
        Many(Vec<RunContrasts>),
        One(RunContrasts),
    }
    Ok(match Written::deserialize(deserializer)? {
        Written::Many(many) => many,
        Written::One(one) => vec![one],
    })
}

/// The contrasts of a run in one setting, as resolved against the store.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunContrasts {
    /// What tells the setting from the matrix' others; not written where there is one only.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub setting: String,
    /// In the matrix' order.
    pub pairs: Vec<ContrastPair>,
    /// What becomes of lost stretches that the route's ends cut off.
    pub censored: furrow_model::Censored,
    /// Seeds the bootstrap.
    pub seed: u64,
    /// What a careful reader should know: claims without a placebo, contrasts that name what does not exist.
    pub warnings: Vec<String>,
}

/// One contender set against another.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContrastPair {
    /// The label of the contender that is asked about.
    pub of: String,
    /// The label of the one that it should beat.
    pub over: String,
    /// The cells of the two, by live pass: a setting may share them with another, which then lists them.
    #[serde(default)]
    pub cells: Vec<[furrow_model::CellKey; 2]>,
}

impl Record for RunRecord {
    const KIND: &'static str = "run";
    const VERSION: u32 = 1;
}

/// A cell of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunCell {
    /// The cell's key.
    pub key: furrow_model::CellKey,
    /// The live slot.
    pub live: TimeSlot,
    /// The experience axis' label.
    pub experience: String,
    /// What tells its setting from the matrix' others; not written where there is one only.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub setting: String,
}

/// A cell that could not be run.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BlockedCell {
    /// The live slot.
    pub live: TimeSlot,
    /// The experience axis' label.
    pub experience: String,
    /// Why, and what to do.
    pub reason: String,
    /// As of a [`RunCell`].
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub setting: String,
}

#[derive(Serialize)]
struct Written<'a, R> {
    kind: &'a str,
    version: u32,
    body: &'a R,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Head {
    kind: String,
    version: u32,
    body: serde_json::Value,
}

/// A record's bytes.
pub fn encode<R: Record>(record: &R) -> Vec<u8> {
    // Records are plain structs with text keys: writing them to memory cannot fail.
    serde_json::to_vec(&Written { kind: R::KIND, version: R::VERSION, body: record }).unwrap_or_default()
}

/// The id that a record has or will have.
pub fn record_id<R: Record>(record: &R) -> ObjectId {
    digest(&encode(record))
}

/// Reads a record back from its bytes.
///
/// # Errors
/// [`CatalogError::WrongRecord`] where the bytes are of another kind, version or form.
pub fn decode<R: Record>(id: ObjectId, bytes: &[u8]) -> Result<R, CatalogError> {
    let expected = || format!("{} (format {})", R::KIND, R::VERSION);
    let wrong = |found: String| CatalogError::WrongRecord { id, expected: expected(), found };
    let head: Head = serde_json::from_slice(bytes).map_err(|error| wrong(format!("no record at all: {error}")))?;
    if head.kind != R::KIND || head.version != R::VERSION {
        return Err(wrong(format!("{} (format {})", head.kind, head.version)));
    }
    serde_json::from_value(head.body).map_err(|error| wrong(format!("a damaged one: {error}")))
}

/// Reads a record from the store.
///
/// # Errors
/// As [`Objects::read`] and [`decode`].
pub fn read<R: Record>(objects: &Objects, id: ObjectId) -> Result<R, CatalogError> {
    decode(id, &objects.read(id)?)
}
