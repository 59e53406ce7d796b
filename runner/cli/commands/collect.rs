use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::RunName;
use crate::output::{print, print_json};
use crate::progress::with_bar;
use furrow_runner::slurm::collect;
use serde_json::json;

/// Take in what a Slurm cluster has finished of a run that was submitted with --detach.
///
/// Submits nothing. Lost tasks are submitted again by the same `furrow run` command. Exit code 3 if cells are still
/// not finished.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  furrow run matrix.toml --executor slurm --detach\n  furrow collect")]
pub struct Collect {
    /// The run: its id, the beginning of it, or `latest`.
    #[arg(default_value = "latest")]
    run: RunName,
}

impl Collect {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let run = self.run.find(&catalog)?;
        let (finished, active) = with_bar(|progress| collect(&catalog, run, progress))?;
        let cells = catalog.run(run)?.cells.len();
        if context.json {
            print_json(&json!({ "run": run, "cells": cells, "finished": finished, "tasks_in_queue": active }))?;
        } else {
            print(&format!("{}  {finished} of {cells} cells finished, {active} tasks in the queue\n", run.short()))?;
        }
        Ok(Ending::with_faults_if(finished < cells))
    }
}
