//! The cells of a matrix, as programs and people read them.

use super::in_setting;
use crate::{Context, Failure, print, print_json};
use furrow_model::{CellKey, CodebookId, Evaluation, ObjectId, Outcome, RunId, TimeSlot};
use furrow_runner::Study;
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;

/// A cell as programs read it.
#[derive(Debug, Serialize)]
pub struct CellView {
    pub key: CellKey,
    live: TimeSlot,
    experience: String,
    /// What tells its setting from the matrix' others.
    setting: String,
    /// The other run that it was finished in.
    from: Option<String>,
    codebook: Option<CodebookId>,
    method: String,
    frames: Option<u32>,
    good: Option<u32>,
    percent_good: Option<f64>,
    lost_fraction: Option<f64>,
    max_lost_m: Option<f64>,
    correct: Option<u32>,
    wrong: Option<u32>,
    cached: bool,
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

#[derive(Debug, Serialize)]
pub struct BlockedView<'a> {
    pub live: TimeSlot,
    pub experience: &'a str,
    pub setting: &'a str,
    pub reason: &'a str,
}

impl CellView {
    pub fn of_setting(self, setting: &str) -> Self {
        Self { setting: setting.to_owned(), ..self }
    }

    pub fn found_in(self, origins: &BTreeMap<CellKey, String>) -> Self {
        let from = origins.get(&self.key).filter(|_| self.cached).cloned();
        Self { from, ..self }
    }

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

/// Prints cells, what is blocked and what failed.
pub fn show(
    context: &Context,
    run: RunId,
    cells: &[CellView],
    study: &Study,
    failed: &[BlockedView<'_>],
    more: Vec<(&str, Value)>,
) -> Result<(), Failure> {
    let blocked: Vec<BlockedView<'_>> = (study.parts.iter())
        .flat_map(|part| part.blocked.iter().map(move |blocked| (part, blocked)))
        .map(|(part, b)| BlockedView {
            live: b.live,
            experience: &b.experience,
            setting: &part.setting,
            reason: &b.reason,
        })
        .collect();
    let warnings = study.warnings();
    if context.json {
        let mut all = json!({ "run": run, "cells": cells, "blocked": blocked, "warnings": warnings });
        more.into_iter().for_each(|(key, value)| all[key] = value);
        return print_json(&all);
    }
    let mut text = format!("run {} of '{}'\n", run.short(), study.matrix.name);
    let labels = cells.iter().map(|cell| in_setting(&cell.experience, &cell.setting));
    let without = blocked.iter().chain(failed).map(|cell| in_setting(cell.experience, cell.setting));
    let wide = labels.chain(without).map(|label| label.chars().count()).max().unwrap_or(0).max(22);
    let _ = writeln!(text, "live   {:<wide$} frames  good  % good  lost %  longest lost  correct  wrong", "experience");
    for cell in cells {
        let or_dash = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
        let cached = match (&cell.from, cell.cached) {
            (Some(from), true) => format!("  (finished in {from})"),
            (None, true) => "  (finished before)".to_owned(),
            (_, false) => String::new(),
        };
        let _ = writeln!(
            text,
            "{:<6} {:<wide$} {:>6} {:>5} {:>7} {:>7} {:>12} {:>8} {:>6}{cached}",
            cell.live.to_string(),
            in_setting(&cell.experience, &cell.setting),
            or_dash(cell.frames.map(|n| n.to_string())),
            or_dash(cell.good.map(|n| n.to_string())),
            or_dash(cell.percent_good.map(|p| format!("{p:.1}"))),
            or_dash(cell.lost_fraction.map(|p| format!("{:.1}", 100.0 * p))),
            or_dash(cell.max_lost_m.map(|m| format!("{m:.1} m"))),
            or_dash(cell.correct.map(|n| n.to_string())),
            or_dash(cell.wrong.map(|n| n.to_string())),
        );
    }
    for (cells, what) in [(blocked.as_slice(), "blocked"), (failed, "failed")] {
        for cell in cells {
            let name = in_setting(cell.experience, cell.setting);
            let _ = writeln!(text, "{:<6} {name:<wide$} {what}: {}", cell.live.to_string(), cell.reason);
        }
    }
    for warning in &warnings {
        eprintln!("warning: {warning}");
    }
    print(&text)
}
