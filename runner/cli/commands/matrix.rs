use super::contrast::{asked_json, asked_text, found_json, found_text};
use crate::progress::Bar;
use crate::{Context, Ending, Failure, print, print_json};
use furrow_catalog::Catalog;
use furrow_model::{CellKey, CodebookId, Evaluation, ObjectId, Outcome, RunId, TimeSlot};
use furrow_runner::estimate::{StageCost, estimate};
use furrow_runner::matrix::Rule;
use furrow_runner::plan::Plan;
use furrow_runner::{Conduct, Matrix, Study, run, study};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::PathBuf;

/// Show what a matrix comes to: its cells, which are finished and in what run, which are blocked and why, and what the rest will cost.
///
/// Computes nothing. The cost is estimated from what stages took in past runs of this store.
#[derive(Debug, clap::Args)]
pub struct PlanMatrix {
    /// The matrix file.
    #[arg(value_name = "MATRIX.toml")]
    matrix: PathBuf,
    /// Only cells that this applies to: KEY=VALUE,... with live, experience, words, images, keyframes, method, threshold or seed; `*` stands
    /// for anything. Several add up.
    #[arg(long, value_name = "FILTER")]
    only: Vec<Rule>,
}

/// Run a matrix: every cell that is not finished. Killed at any moment, the same command takes up where it was.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  furrow run matrix.toml\n  furrow run matrix.toml --keep-going         # what hangs on a fault fails, the rest is computed\n  \
furrow run matrix.toml --failed             # again, only what failed\n  furrow run matrix.toml --only 'live=08:00,experience=10:00*'"
)]
pub struct RunMatrix {
    /// The matrix file.
    #[arg(value_name = "MATRIX.toml")]
    matrix: PathBuf,
    /// Threads; all cores where left out. Results do not depend on it.
    #[arg(short, long, value_name = "N")]
    jobs: Option<usize>,
    /// A cell that fails does not stop the others.
    #[arg(long)]
    keep_going: bool,
    /// Only cells that failed when they were last tried.
    #[arg(long)]
    failed: bool,
    /// Only cells that this applies to: KEY=VALUE,... with live, experience, words, images, keyframes, method, threshold or seed; `*` stands
    /// for anything. Several add up.
    #[arg(long, value_name = "FILTER")]
    only: Vec<Rule>,
}

impl PlanMatrix {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let mut study = read(&catalog, &self.matrix)?;
        only(&mut study, &self.only)?;
        let run = RunId(furrow_catalog::records::record_id(&study.record(&catalog)?).0);
        let origins = origins(&catalog, run)?;
        let cells = study.cells().filter(|(_, cell)| cell.asked).map(|(part, cell)| {
            let view = match &cell.outcome {
                Some(outcome) => CellView::of(outcome, true),
                None => CellView::planned(
                    cell.key,
                    part.lives[cell.live].record.slot,
                    &cell.label,
                    part.matrix.localiser.method.name(),
                ),
            };
            view.of_setting(&part.setting).found_in(&origins)
        });
        let cells: Vec<CellView> = cells.collect();
        let costs = estimate(&catalog, &study)?;
        let more = vec![("estimate", json!(costs)), ("contrasts", asked_json(&study))];
        show(context, run, &cells, &study, &[], more)?;
        if !context.json {
            print(&(asked_text(&study) + &cost_text(&costs)))?;
        }
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
        let mut study = read(&catalog, &self.matrix)?;
        only(&mut study, &self.only)?;
        if self.failed && study.only_failed(&catalog)? == 0 {
            eprintln!("no cell of this matrix failed when it was last tried");
        }
        let bar = Bar::units();
        let conduct = Conduct { keep_going: self.keep_going };
        let result =
            run(&catalog, &study, conduct, &|progress| bar.show(progress.stage, progress.done, progress.total));
        bar.finish();
        let result = result?;
        for doubt in &result.doubts {
            eprintln!("warning: {doubt}");
        }
        let origins = origins(&catalog, result.run)?;
        let cells = result.cells.iter().map(|(setting, cell)| {
            let view = CellView::of(&cell.outcome, cell.cached).of_setting(setting);
            if cell.cached { view.found_in(&origins) } else { view }
        });
        let cells: Vec<CellView> = cells.collect();
        let failed: Vec<BlockedView<'_>> = (result.failed.iter())
            .map(|failed| BlockedView {
                live: failed.cell.live,
                experience: &failed.cell.experience,
                setting: &failed.setting,
                reason: &failed.cell.reason,
            })
            .collect();
        let more = vec![
            ("failed", json!(failed)),
            ("left", json!(result.left)),
            ("work", json!(result.work)),
            ("contrasts", found_json(&result.contrasts)),
        ];
        show(context, result.run, &cells, &study, &failed, more)?;
        if !context.json {
            print(&found_text(&result.contrasts))?;
        }
        if result.left > 0 && !context.json {
            eprintln!("{} cells were not asked for and are not finished", result.left);
        }
        let blocked = study.parts.iter().any(|part| !part.blocked.is_empty());
        Ok(if blocked || !result.failed.is_empty() { Ending::WithFaults } else { Ending::Done })
    }
}

/// A matrix file resolved against the store.
pub(super) fn read(catalog: &Catalog, path: &PathBuf) -> Result<Study, Failure> {
    let text = std::fs::read_to_string(path)
        .map_err(|error| Failure::new(format!("cannot read {}: {error}", path.display())))?;
    Ok(study(catalog, Matrix::parse(path, &text)?, &text)?)
}

/// The plan of a matrix with one setting.
pub(super) fn read_single(catalog: &Catalog, path: &PathBuf) -> Result<Plan, Failure> {
    let mut parts = read(catalog, path)?.parts;
    match (parts.pop(), parts.len()) {
        (Some(part), 0) => Ok(part),
        (_, more) => Err(Failure::new(format!(
            "{} has {} settings: give the axes words, images, keyframes, method, threshold and seed one value each",
            path.display(),
            more + 1
        ))),
    }
}

/// What is called `name`, with its setting where the matrix has several.
pub(super) fn in_setting(name: &str, setting: &str) -> String {
    match setting {
        "" => name.to_owned(),
        setting => format!("{name} [{setting}]"),
    }
}

fn only(study: &mut Study, rules: &[Rule]) -> Result<(), Failure> {
    if rules.is_empty() {
        return Ok(());
    }
    study.only(rules);
    match study.cells().any(|(_, cell)| cell.asked) {
        true => Ok(()),
        false => Err(Failure::usage("--only leaves no cell: `furrow plan MATRIX.toml` lists their slots and names")),
    }
}

/// The run that first lists a cell, where that is another one than `this`.
fn origins(catalog: &Catalog, this: RunId) -> Result<BTreeMap<CellKey, String>, Failure> {
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

fn cost_text(costs: &[StageCost]) -> String {
    if costs.is_empty() {
        return "nothing is left to compute\n".to_owned();
    }
    let mut text = "still to compute:\n".to_owned();
    for cost in costs {
        let took = cost.seconds.map_or("no past run tells".to_owned(), |seconds| format!("about {seconds:.0} s"));
        let _ = writeln!(text, "  {:<36} {:>7}  {took}", cost.stage, cost.units);
    }
    let known: Vec<f64> = costs.iter().filter_map(|cost| cost.seconds).collect();
    if !known.is_empty() {
        let rest = if known.len() < costs.len() { ", and what no past run tells" } else { "" };
        let _ = writeln!(text, "  in all about {:.0} s on this machine{rest}", known.iter().sum::<f64>());
    }
    text
}

/// A cell as programs read it.
#[derive(Debug, Serialize)]
struct CellView {
    key: CellKey,
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
struct BlockedView<'a> {
    live: TimeSlot,
    experience: &'a str,
    setting: &'a str,
    reason: &'a str,
}

impl CellView {
    fn of_setting(self, setting: &str) -> Self {
        Self { setting: setting.to_owned(), ..self }
    }

    fn found_in(self, origins: &BTreeMap<CellKey, String>) -> Self {
        let from = origins.get(&self.key).filter(|_| self.cached).cloned();
        Self { from, ..self }
    }

    fn planned(key: CellKey, live: TimeSlot, experience: &str, method: &str) -> Self {
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
