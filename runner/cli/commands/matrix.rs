use super::contrast::{contrasts_json, contrasts_text};
use crate::progress::Bar;
use crate::{Context, Ending, Failure, print, print_json};
use furrow_model::{CellKey, CodebookId, Evaluation, ObjectId, Outcome, RunId, TimeSlot};
use furrow_runner::plan::Plan;
use furrow_runner::{CellResult, Contrasts, Matrix, plan, run};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// Show what a matrix comes to: its cells, which are finished, which are blocked and why. Computes nothing.
#[derive(Debug, clap::Args)]
pub struct PlanMatrix {
    /// The matrix file.
    #[arg(value_name = "MATRIX.toml")]
    matrix: PathBuf,
}

/// Run a matrix: every cell that is not finished. Killed at any moment, the same command takes up where it was.
#[derive(Debug, clap::Args)]
pub struct RunMatrix {
    /// The matrix file.
    #[arg(value_name = "MATRIX.toml")]
    matrix: PathBuf,
    /// Threads; all cores where left out. Results do not depend on it.
    #[arg(short, long, value_name = "N")]
    jobs: Option<usize>,
}

impl PlanMatrix {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let plan = read(&catalog, &self.matrix)?;
        let run = RunId(furrow_catalog::records::record_id(&furrow_runner::run::record(&plan)).0);
        let cells = plan.cells.iter().map(|cell| match &cell.outcome {
            Some(outcome) => CellView::of(outcome, true),
            None => CellView::planned(
                cell.key,
                plan.lives[cell.live].record.slot,
                &cell.label,
                plan.matrix.localiser.method.name(),
            ),
        });
        show(context, run, cells.collect(), None, &plan)?;
        Ok(Ending::Done)
    }
}

impl RunMatrix {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        if let Some(jobs) = self.jobs {
            rayon::ThreadPoolBuilder::new()
                .num_threads(jobs)
                .build_global()
                .map_err(|error| Failure::new(format!("cannot start {jobs} threads: {error}")))?;
        }
        let catalog = context.catalog()?;
        let plan = read(&catalog, &self.matrix)?;
        let bar = Bar::units();
        let result = run(&catalog, &plan, &|progress| bar.show(progress.stage, progress.done, progress.total));
        bar.finish();
        let result = result?;
        for doubt in &result.doubts {
            eprintln!("warning: {doubt}");
        }
        let cells = result.cells.iter().map(|CellResult { outcome, cached }| CellView::of(outcome, *cached));
        show(context, result.run, cells.collect(), Some(&result.contrasts), &plan)?;
        Ok(if plan.blocked.is_empty() { Ending::Done } else { Ending::WithFaults })
    }
}

pub(super) fn read(catalog: &furrow_catalog::Catalog, path: &PathBuf) -> Result<Plan, Failure> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| Failure::new(format!("cannot read {}: {error}", path.display())))?;
    Ok(plan(catalog, Matrix::parse(path, &text)?, text)?)
}

/// A cell as programs read it.
#[derive(Debug, Serialize)]
struct CellView {
    key: CellKey,
    live: TimeSlot,
    experience: String,
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
struct BlockedView<'a> {
    live: TimeSlot,
    experience: &'a str,
    reason: &'a str,
}

impl CellView {
    fn planned(key: CellKey, live: TimeSlot, experience: &str, method: &str) -> Self {
        Self {
            key,
            live,
            experience: experience.to_owned(),
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

    fn of(outcome: &Outcome, cached: bool) -> Self {
        let (evaluation, truth) = (&outcome.evaluation, outcome.evaluation.ground_truth.as_ref());
        Self {
            codebook: Some(outcome.codebook),
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

fn show(
    context: &Context,
    run: RunId,
    cells: Vec<CellView>,
    contrasts: Option<&Contrasts>,
    plan: &Plan,
) -> Result<(), Failure> {
    if context.json {
        let blocked: Vec<BlockedView<'_>> = plan
            .blocked
            .iter()
            .map(|b| BlockedView { live: b.live, experience: &b.experience, reason: &b.reason })
            .collect();
        return print_json(
            &serde_json::json!({ "run": run, "cells": cells, "blocked": blocked, "warnings": plan.warnings, "contrasts": contrasts_json(contrasts, plan) }),
        );
    }
    let mut text = format!("run {} of '{}'\n", run.short(), plan.matrix.name);
    let labels =
        cells.iter().map(|cell| &*cell.experience).chain(plan.blocked.iter().map(|blocked| &*blocked.experience));
    let wide = labels.map(|label| label.chars().count()).max().unwrap_or(0).max(22);
    let _ = writeln!(text, "live   {:<wide$} frames  good  % good  lost %  longest lost  correct  wrong", "experience");
    for cell in &cells {
        let or_dash = |value: Option<String>| value.unwrap_or_else(|| "-".to_owned());
        let _ = writeln!(
            text,
            "{:<6} {:<wide$} {:>6} {:>5} {:>7} {:>7} {:>12} {:>8} {:>6}{}",
            cell.live.to_string(),
            cell.experience,
            or_dash(cell.frames.map(|n| n.to_string())),
            or_dash(cell.good.map(|n| n.to_string())),
            or_dash(cell.percent_good.map(|p| format!("{p:.1}"))),
            or_dash(cell.lost_fraction.map(|p| format!("{:.1}", 100.0 * p))),
            or_dash(cell.max_lost_m.map(|m| format!("{m:.1} m"))),
            or_dash(cell.correct.map(|n| n.to_string())),
            or_dash(cell.wrong.map(|n| n.to_string())),
            if cell.cached { "  (finished before)" } else { "" },
        );
    }
    for blocked in &plan.blocked {
        let _ =
            writeln!(text, "{:<6} {:<wide$} blocked: {}", blocked.live.to_string(), blocked.experience, blocked.reason);
    }
    text += &contrasts_text(contrasts, plan);
    for warning in &plan.warnings {
        eprintln!("warning: {warning}");
    }
    print(&text)
}
