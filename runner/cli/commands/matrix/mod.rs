mod cells;

use super::contrast::{asked_json, asked_text, found_json, found_text};
use super::slurm::{Executor, SlurmOptions};
use super::use_threads;
use crate::progress::Bar;
use crate::{Context, Ending, Failure, print};
use cells::{BlockedView, CellView, show};
use furrow_catalog::Catalog;
use furrow_model::{CellKey, RunId};
use furrow_runner::estimate::{StageCost, estimate};
use furrow_runner::matrix::Rule;
use furrow_runner::plan::Plan;
use furrow_runner::slurm::run_on_slurm;
use furrow_runner::{Conduct, Matrix, StageProgress, Study, run, study};
use serde_json::json;
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
furrow run matrix.toml --failed             # again, only what failed\n  furrow run matrix.toml --only 'live=08:00,experience=10:00*'\n  \
furrow run matrix.toml --executor slurm --partition long --time 2:00:00 --array-limit 64"
)]
pub struct RunMatrix {
    /// The matrix file.
    #[arg(value_name = "MATRIX.toml")]
    matrix: PathBuf,
    /// Threads; all cores where left out. Results do not depend on it.
    #[arg(short, long, value_name = "N")]
    jobs: Option<usize>,
    /// Memory that the verification of live passes stays within, as in 4GB; half of the machine's where left out. Results do not depend on it. Tasks of a
    /// cluster take half of their node's.
    #[arg(long, value_name = "SIZE", value_parser = furrow_runner::memory::size)]
    memory: Option<u64>,
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
    /// Where cells are computed: on this machine, or as job arrays of a Slurm cluster that sees the store.
    #[arg(long, value_enum, default_value_t, value_name = "WHERE")]
    executor: Executor,
    #[command(flatten)]
    slurm: SlurmOptions,
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
        if let Some(jobs) = self.jobs.filter(|_| self.executor == Executor::Local) {
            use_threads(jobs)?;
        }
        let catalog = context.catalog()?;
        let mut study = read(&catalog, &self.matrix)?;
        only(&mut study, &self.only)?;
        if self.failed && study.only_failed(&catalog)? == 0 {
            eprintln!("no cell of this matrix failed when it was last tried");
        }
        let bar = Bar::units();
        let conduct = Conduct { keep_going: self.keep_going, memory: self.memory };
        let told = |progress: StageProgress<'_>| bar.show(progress.stage, progress.done, progress.total);
        let result = match self.executor {
            Executor::Local => run(&catalog, &study, conduct, &told),
            Executor::Slurm => {
                let how = (&self.slurm.queue(self.jobs), conduct, self.slurm.following());
                run_on_slurm(&catalog, &study, &self.matrix, how, &told)
            }
        };
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
            eprintln!("{}", self.slurm.left(result.left, result.run));
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
