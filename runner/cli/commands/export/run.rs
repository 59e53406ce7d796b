use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::WhichRun;
use crate::output::print_json;
use crate::progress::with_bar;
use clap::Args;
use furrow_catalog::records::{RunCell, RunRecord};
use furrow_model::{CellKey, TimeSlot, shown};
use furrow_runner::export::{Exporting, export_cell};
use std::path::PathBuf;

/// Write a cell of a run as a recording (MCAP) for Foxglove and Rerun.
///
/// It holds both images with their inliers, poses and trajectories, and the decision on every live frame, on the stamps
/// of the live recording. Its metadata name run, cell and outcome.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  furrow export run latest --live 08:00 --experience 10:00 -o morning.mcap\n  \
rerun morning.mcap\n\nTopics: /live/left and /match/left with calibration, annotations and pose; /localisation with \
its log and scene;\n/tracks, /live/track, /experience_N/track, /ground_truth/… and /tf.")]
pub struct ExportRun {
    #[command(flatten)]
    which: WhichRun,
    /// The slot of the live traversal.
    #[arg(long, value_name = "HH:MM")]
    live: Option<TimeSlot>,
    /// The experience or collective, by its name in the run.
    #[arg(long, value_name = "NAME")]
    experience: Option<String>,
    /// The cell, by the beginning of its key.
    #[arg(long, value_name = "KEY")]
    cell: Option<String>,
    /// The file to write. [default: RUN-CELL.mcap]
    #[arg(short, long, value_name = "FILE.mcap")]
    output: Option<PathBuf>,
}

/// Cells that an error lists; there may be thousands.
const LISTED: usize = 40;

impl ExportRun {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let run = self.which.run.find(&catalog)?;
        let record = catalog.run(run)?;
        let cell = self.choose_cell(&record)?;
        let unfinished = || {
            Failure::new(format!(
                "{} is not finished: run its matrix '{}' again with `furrow run`, then export it",
                describe(cell),
                shown(&record.name)
            ))
        };
        let outcome = catalog.outcome(cell.key)?.ok_or_else(unfinished)?;
        let output = self.output.unwrap_or_else(|| format!("{}-{}.mcap", run.short(), cell.key.short()).into());
        let exporting =
            Exporting { run, record: &record, cell, outcome: &outcome, furrow_version: env!("CARGO_PKG_VERSION") };
        let exported = with_bar(|progress| export_cell(&catalog, exporting, &output, progress))?;
        if context.json {
            let (key, messages) = (cell.key, exported.messages);
            print_json(&serde_json::json!({
                "run": run, "cell": key, "outcome": exported.outcome, "file": output, "messages": messages,
            }))?;
        } else {
            let frames = exported.messages.get("/localisation").copied().unwrap_or_default();
            eprintln!("{}: {frames} live frames of {}", output.display(), describe(cell));
        }
        Ok(Ending::Done)
    }

    /// The one cell that fits the options. A cell that a run lists under several names is one.
    fn choose_cell<'a>(&self, record: &'a RunRecord) -> Result<&'a RunCell, Failure> {
        let names = |live: TimeSlot, experience: &str| {
            self.live.is_none_or(|wanted| wanted == live)
                && self.experience.as_ref().is_none_or(|wanted| wanted == experience)
        };
        let keyed = |key: CellKey| self.cell.as_ref().is_none_or(|wanted| key.to_string().starts_with(wanted));
        let mut found: Vec<&RunCell> = Vec::new();
        for cell in record.cells.iter().filter(|cell| names(cell.live, &cell.experience) && keyed(cell.key)) {
            if found.iter().all(|other| other.key != cell.key) {
                found.push(cell);
            }
        }
        let blocked = || {
            let mut blocked = record.blocked.iter().filter(|_| self.cell.is_none());
            blocked.find(|blocked| names(blocked.live, &blocked.experience))
        };
        match (found.as_slice(), blocked()) {
            ([one], _) => Ok(one),
            ([], Some(blocked)) => {
                let (live, experience, reason) = (blocked.live, shown(&blocked.experience), &blocked.reason);
                Err(Failure::new(format!("live {live} against {experience} could not be run: {reason}")))
            }
            ([], None) => {
                let there = list(&record.cells.iter().collect::<Vec<_>>());
                Err(Failure::usage(format!("no cell of the run is {}; its cells are\n{there}", self.describe_wanted())))
            }
            (several, _) => Err(Failure::usage(format!(
                "{} cells of the run fit: choose one with --live, --experience or --cell\n{}",
                several.len(),
                list(several)
            ))),
        }
    }

    fn describe_wanted(&self) -> String {
        let live = self.live.map(|slot| format!("live {slot}"));
        let experience = self.experience.as_ref().map(|name| format!("against '{}'", shown(name)));
        let key = self.cell.as_ref().map(|key| format!("of a key that begins with '{}'", shown(key)));
        let said: Vec<String> = [live, experience, key].into_iter().flatten().collect();
        if said.is_empty() { "there".to_owned() } else { said.join(" ") }
    }
}

/// `live 08:00 against 10:00 (words=6000)`.
fn describe(cell: &RunCell) -> String {
    let setting = if cell.setting.is_empty() { String::new() } else { format!(" ({})", shown(&cell.setting)) };
    format!("live {} against {}{setting}", cell.live, shown(&cell.experience))
}

fn list(cells: &[&RunCell]) -> String {
    let lines = cells.iter().take(LISTED).map(|cell| format!("  {}  {}", cell.key.short(), describe(cell)));
    let beyond = cells.len().checked_sub(LISTED).filter(|rest| *rest > 0).map(|rest| format!("  and {rest} more"));
    lines.chain(beyond).collect::<Vec<_>>().join("\n")
}
