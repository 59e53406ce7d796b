use crate::commands::chosen_run;
use crate::progress::Bar;
use crate::{Context, Ending, Failure, print_json};
use clap::Args;
use furrow_catalog::records::{RunCell, RunRecord};
use furrow_model::{CellKey, TimeSlot, shown};
use furrow_runner::export::{Exporting, export_cell};
use std::path::PathBuf;

/// Write a cell of a run as a recording (MCAP) that Foxglove and Rerun play.
///
/// It holds both images with their inliers, poses and tracks, and what was decided about every live frame, on the live recording's own stamps. Its
/// metadata name run, cell and outcome.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  furrow export run latest --live 08:00 --experience 10:00 -o morning.mcap\n  \
rerun morning.mcap\n\nTopics: /live/left and /match/left with calibration, annotations and pose; /localisation with its log and scene;\n\
/tracks, /live/track, /experience_N/track, /ground_truth/… and /tf.")]
pub struct ExportRun {
    /// The run: its id, the beginning of it, or `latest`.
    run: String,
    /// The slot of the live pass.
    #[arg(long, value_name = "HH:MM")]
    live: Option<TimeSlot>,
    /// The experience or collective, as the run names it.
    #[arg(long, value_name = "NAME")]
    experience: Option<String>,
    /// The cell's key, or the beginning of it.
    #[arg(long, value_name = "KEY")]
    cell: Option<String>,
    /// The file to write; named after run and cell where left out.
    #[arg(short, long, value_name = "FILE.mcap")]
    output: Option<PathBuf>,
}

/// Cells that an error lists; there may be thousands.
const LISTED: usize = 40;

impl ExportRun {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let run = chosen_run(&catalog, &self.run)?;
        let record = catalog.run(run)?;
        let cell = self.chosen(&record)?;
        let unfinished = || {
            Failure::new(format!(
                "{} is not finished: `furrow run` its matrix '{}' again, then export it",
                named(cell),
                shown(&record.name)
            ))
        };
        let outcome = catalog.outcome(cell.key)?.ok_or_else(unfinished)?;
        let output = self.output.unwrap_or_else(|| format!("{}-{}.mcap", run.short(), cell.key.short()).into());
        let exporting =
            Exporting { run, record: &record, cell, outcome: &outcome, furrow_version: env!("CARGO_PKG_VERSION") };
        let bar = Bar::units();
        let exported = export_cell(&catalog, exporting, &output, &|progress| {
            bar.show(progress.stage, progress.done, progress.total);
        });
        bar.finish();
        let exported = exported?;
        if context.json {
            let (key, messages) = (cell.key, exported.messages);
            print_json(
                &serde_json::json!({ "run": run, "cell": key, "outcome": exported.outcome, "file": output, "messages": messages }),
            )?;
        } else {
            let frames = exported.messages.get("/localisation").copied().unwrap_or_default();
            eprintln!("{}: {frames} live frames of {}", output.display(), named(cell));
        }
        Ok(Ending::Done)
    }

    /// The one cell that fits what was typed. A cell that a run lists under several names is one.
    fn chosen<'a>(&self, record: &'a RunRecord) -> Result<&'a RunCell, Failure> {
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
                let there = listed(&record.cells.iter().collect::<Vec<_>>());
                Err(Failure::usage(format!("no cell of the run is {}; there are\n{there}", self.wanted())))
            }
            (several, _) => Err(Failure::usage(format!(
                "{} cells of the run fit: name one with --live, --experience or --cell\n{}",
                several.len(),
                listed(several)
            ))),
        }
    }

    fn wanted(&self) -> String {
        let live = self.live.map(|slot| format!("live {slot}"));
        let experience = self.experience.as_ref().map(|name| format!("against '{}'", shown(name)));
        let key = self.cell.as_ref().map(|key| format!("of a key that begins with '{}'", shown(key)));
        let said: Vec<String> = [live, experience, key].into_iter().flatten().collect();
        if said.is_empty() { "there".to_owned() } else { said.join(" ") }
    }
}

/// `live 08:00 against 10:00 (words=6000)`.
fn named(cell: &RunCell) -> String {
    let setting = if cell.setting.is_empty() { String::new() } else { format!(" ({})", shown(&cell.setting)) };
    format!("live {} against {}{setting}", cell.live, shown(&cell.experience))
}

fn listed(cells: &[&RunCell]) -> String {
    let lines = cells.iter().take(LISTED).map(|cell| format!("  {}  {}", cell.key.short(), named(cell)));
    let beyond = cells.len().checked_sub(LISTED).filter(|rest| *rest > 0).map(|rest| format!("  and {rest} more"));
    lines.chain(beyond).collect::<Vec<_>>().join("\n")
}
