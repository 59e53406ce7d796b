//! Runs: a matrix as resolved against the store.

use super::record::Record;
use furrow_model::{CellKey, Censored, ObjectId, TimeSlot, TraversalId};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

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
    /// The traversals that the matrix came to: what has to be ingested to run it again elsewhere. Empty in runs that do
    /// not say it (version 1).
    #[serde(rename = "passes")]
    pub traversals: Vec<TraversalId>,
    /// The generators that it names.
    pub generators: Vec<ObjectId>,
    /// Which contenders are set against which, setting by setting; empty where the matrix asks for no contrast.
    pub contrasts: Vec<RunContrasts>,
}

/// A cell of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunCell {
    /// The cell's key.
    pub key: CellKey,
    /// The live slot.
    pub live: TimeSlot,
    /// The experience axis' label.
    pub experience: String,
    /// What tells its setting from the matrix' others; empty where there is one only.
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
    pub setting: String,
}

/// The contrasts of a run in one setting.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RunContrasts {
    /// As of a [`RunCell`].
    pub setting: String,
    /// In the matrix' order.
    pub pairs: Vec<ContrastPair>,
    /// What becomes of lost stretches that the route's ends cut off.
    pub censored: Censored,
    /// The matrix' seed. Intervals were once drawn with it; it is kept so that the ids of runs stay.
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
    /// The cells of the two, by live traversal: a setting may share them with another, which then lists them. Empty in
    /// runs that do not say it (version 1).
    pub cells: Vec<[CellKey; 2]>,
}

impl Record for RunRecord {
    const KIND: &'static str = "run";
    const VERSION: u32 = 2;

    /// Version 1 had four forms. All of them name the cells; the second added one object of contrasts without cells,
    /// the third traversals and generators and contrasts setting by setting, the last the cells of contrasts. Each left
    /// out what was empty.
    fn upgrade(_: u32, mut body: Value) -> Result<Value, String> {
        let run = body.as_object_mut().ok_or("expected an object")?;
        for list in ["passes", "generators", "contrasts"] {
            run.entry(list).or_insert_with(|| json!([]));
        }
        if let Some(contrasts) = run.get_mut("contrasts").filter(|contrasts| contrasts.is_object()) {
            *contrasts = json!([contrasts.take()]);
        }
        for list in ["cells", "blocked", "contrasts"] {
            fill_in(run.get_mut(list), "setting", &json!(""));
        }
        for contrasts in run.get_mut("contrasts").and_then(Value::as_array_mut).into_iter().flatten() {
            fill_in(contrasts.get_mut("pairs"), "cells", &json!([]));
        }
        Ok(body)
    }
}

/// Gives every object of a list the field that it lacks.
fn fill_in(list: Option<&mut Value>, field: &str, value: &Value) {
    for object in list.and_then(Value::as_array_mut).into_iter().flatten().filter_map(Value::as_object_mut) {
        object.entry(field).or_insert_with(|| value.clone());
    }
}
