//! Generators, and what they were trained on.

use super::record::Record;
use furrow_model::{ObjectId, TimeSlot, TraversalId};
use serde::{Deserialize, Serialize};

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
    /// What it moves images from; none where it knows no slot.
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
    /// The traversals they come from; none for a model that was trained elsewhere.
    pub traversals: Vec<TraversalId>,
    /// The left images, in order.
    pub images: Vec<ObjectId>,
}
