//! A cell of a matrix, as programs and people read it.

use crate::ending::Failure;
use furrow_catalog::Catalog;
use furrow_model::{CellKey, CodebookId, Evaluation, ObjectId, Outcome, RunId, TimeSlot};
use serde::Serialize;
use std::collections::BTreeMap;

/// A name with its setting in brackets, if the matrix has several settings.
pub fn in_setting(name: &str, setting: &str) -> String {
    match setting {
        "" => name.to_owned(),
        setting => format!("{name} [{setting}]"),
    }
}

/// A cell as programs read it.
#[derive(Debug, Serialize)]
pub struct CellView {
    pub key: CellKey,
    pub live: TimeSlot,
    pub experience: String,
    /// What tells its setting from the others of the matrix.
    pub setting: String,
    /// The other run that it was finished in.
    pub from: Option<String>,
    codebook: Option<CodebookId>,
    method: String,
    pub frames: Option<u32>,
    pub good: Option<u32>,
    pub percent_good: Option<f64>,
    pub lost_fraction: Option<f64>,
    pub max_lost_m: Option<f64>,
    pub correct: Option<u32>,
    pub wrong: Option<u32>,
    pub cached: bool,
    new_place: Option<u32>,
    rejected: Option<u32>,
    threshold_inliers: Option<u32>,
    max_error_m: Option<f64>,
    recall_at_1: Option<f64>,
    ground_truth: Option<String>,
    policy: Option<String>,
    /// The object with the table of events.
    events: Option<ObjectId>,
    /// Every number of the report's page.
    evaluation: Option<Evaluation>,
}

/// A cell without an outcome, and why.
#[derive(Debug, Serialize)]
pub struct CellWithout<'a> {
    pub live: TimeSlot,
    pub experience: &'a str,
    pub setting: &'a str,
    pub reason: &'a str,
}

impl CellView {
    /// Names its setting.
    pub fn with_setting(self, setting: &str) -> Self {
        Self { setting: setting.to_owned(), ..self }
    }

    /// Names the other run that finished it.
    pub fn with_origin(self, origins: &BTreeMap<CellKey, String>) -> Self {
        let from = origins.get(&self.key).filter(|_| self.cached).cloned();
        Self { from, ..self }
    }

    /// A cell that is not finished.
    pub fn planned(key: CellKey, live: TimeSlot, experience: &str, method: &str) -> Self {
        Self {
            key,
            live,
            experience: experience.to_owned(),
            setting: String::new(),
            from: None,
            codebook: None,
            method: method.to_owned(),
            frames: None,
            good: None,
            percent_good: None,
            lost_fraction: None,
            max_lost_m: None,
            correct: None,
            wrong: None,
            cached: false,
            new_place: None,
            rejected: None,
            threshold_inliers: None,
            max_error_m: None,
            recall_at_1: None,
            ground_truth: None,
            policy: None,
            events: None,
            evaluation: None,
        }
    }

    /// A finished cell.
    pub fn of(outcome: &Outcome, cached: bool) -> Self {
        let (evaluation, truth) = (&outcome.evaluation, outcome.evaluation.ground_truth.as_ref());
        Self {
            codebook: outcome.codebook,
            frames: Some(evaluation.frames),
            good: Some(evaluation.good),
            percent_good: evaluation.percent_good,
            lost_fraction: Some(evaluation.lost.lost_fraction),
            max_lost_m: Some(evaluation.lost.max_lost_m),
            correct: truth.map(|truth| truth.correct),
            wrong: truth.map(|truth| truth.wrong),
            cached,
            new_place: Some(evaluation.new_place),
            rejected: Some(evaluation.rejected),
            threshold_inliers: Some(outcome.threshold_inliers),
            max_error_m: truth.and_then(|truth| truth.position_max_m),
            recall_at_1: truth.and_then(|truth| truth.recall_at_1),
            ground_truth: truth.map(|truth| truth.source.clone()),
            policy: Some(outcome.policy.clone()),
            events: Some(outcome.events),
            evaluation: Some(evaluation.clone()),
            ..Self::planned(outcome.key, outcome.live, &outcome.experience, &outcome.method)
        }
    }
}

/// For every cell of other runs than `this`, the run that first lists it.
pub fn find_origins(catalog: &Catalog, this: RunId) -> Result<BTreeMap<CellKey, String>, Failure> {
    let mut origins = BTreeMap::new();
    for row in catalog.runs()? {
        if row.id != this {
            for cell in catalog.run(row.id)?.cells {
                origins.entry(cell.key).or_insert_with(|| format!("run {} of '{}'", row.id.short(), row.matrix));
            }
        }
    }
    Ok(origins)
}
