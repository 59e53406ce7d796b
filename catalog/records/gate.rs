//! What the quality gate measured of a generator.

use super::record::Record;
use furrow_model::{ExperienceId, Measures, ObjectId, SwitchIndex};
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What was measured of a generator at one domainness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct GateRecord {
    /// The generator.
    pub generator: ObjectId,
    /// The experience whose images it was measured on.
    pub parent: ExperienceId,
    /// The images.
    pub images: Vec<ObjectId>,
    /// How evenly it moves from z = 0 to 1; none where it does not paint all of that.
    pub switch: Option<SwitchIndex>,
    /// The measures at this domainness.
    pub measures: Measures,
    /// Why it is to be doubted; empty where it passes.
    pub doubts: Vec<String>,
}

impl Record for GateRecord {
    const KIND: &'static str = "gate";
    const VERSION: u32 = 2;

    fn upgrade(_: u32, mut body: Value) -> Result<Value, String> {
        // Version 1 did not look at what is mimicked, and counted white pixels as clipped, not black ones.
        let measures = body.get_mut("measures").and_then(Value::as_object_mut).ok_or("expected measures")?;
        measures.insert("clipped_target".to_owned(), Value::Null);
        Ok(body)
    }
}

/// How evenly a generator moves from z = 0 to 1, which is the same for every domainness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SwitchRecord {
    /// None where it does not paint all of 0 to 1.
    pub switch: Option<SwitchIndex>,
}

impl Record for SwitchRecord {
    const KIND: &'static str = "switch index";
    const VERSION: u32 = 1;
}
