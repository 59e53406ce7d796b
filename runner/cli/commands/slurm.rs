use super::{chosen_run, use_threads};
use crate::progress::Bar;
use crate::{Context, Ending, Failure, print, print_json};
use furrow_model::RunId;
use furrow_runner::StageProgress;
use furrow_runner::slurm::{Assignment, Following, Queue, StageName, collect, work};
use serde_json::json;
use std::path::PathBuf;

/// Where cells are computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Executor {
    /// On this machine.
    #[default]
    Local,
    /// As job arrays of a Slurm cluster.
    Slurm,
}

/// How jobs are submitted to Slurm.
#[derive(Debug, clap::Args)]
#[command(next_help_heading = "With --executor slurm")]
pub struct SlurmOptions {
    /// The partition.
    #[arg(long, value_name = "NAME")]
    partition: Option<String>,
    /// The longest that a task may take, as Slurm writes it; one that is cut off is submitted again.
    #[arg(long, value_name = "TIME")]
    time: Option<String>,
    /// So many tasks of a stage run at once, at the most.
    #[arg(long, value_name = "N")]
    array_limit: Option<u32>,
    /// A further option of sbatch, as in `--sbatch=--account=robots`.
    #[arg(long, value_name = "OPTION", allow_hyphen_values = true)]
    sbatch: Vec<String>,
    /// Leave once the jobs are submitted: `furrow collect` or the same command come back to them.
    #[arg(long)]
    detach: bool,
}

impl SlurmOptions {
    /// How to submit; a task has so many threads.
    pub fn queue(&self, threads: Option<usize>) -> Queue {
        Queue {
            partition: self.partition.clone(),
            time: self.time.clone(),
            array_limit: self.array_limit,
            threads,
            more: self.sbatch.clone(),
        }
    }

    /// What to do after submitting.
    pub fn following(&self) -> Following {
        if self.detach { Following::Leave } else { Following::Wait }
    }

    /// What to say of cells that are not finished.
    pub fn left(&self, cells: usize, run: RunId) -> String {
        match self.detach {
            true => format!(
                "{cells} cells are not finished: `furrow status` tells how far they are, `furrow collect {}` takes in what is",
                run.short()
            ),
            false => format!("{cells} cells were not asked for and are not finished"),
        }
    }
}

/// Take in what a cluster has finished of a run that was submitted and left.
///
/// Submits nothing: the same `furrow run` command does that, where something was lost.
#[derive(Debug, clap::Args)]
pub struct Collect {
    /// The run: its id, the beginning of it, or `latest`.
    #[arg(default_value = "latest")]
    run: String,
}

impl Collect {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let run = chosen_run(&catalog, &self.run)?;
        let bar = Bar::units();
        let told = |progress: StageProgress<'_>| bar.show(progress.stage, progress.done, progress.total);
        let collected = collect(&catalog, run, &told);
        bar.finish();
        let (finished, active) = collected?;
        let cells = catalog.run(run)?.cells.len();
        if context.json {
            print_json(&json!({ "run": run, "cells": cells, "finished": finished, "tasks_in_queue": active }))?;
        } else {
            print(&format!("{}  {finished} of {cells} cells finished, {active} tasks in the queue\n", run.short()))?;
        }
        Ok(if finished < cells { Ending::WithFaults } else { Ending::Done })
    }
}

/// Compute one task of a job array: what `furrow run --executor slurm` has nodes run.
#[derive(Debug, clap::Args)]
#[command(hide = true)]
pub struct Worker {
    /// The job's folder.
    #[arg(long)]
    job: PathBuf,
    /// The stage.
    #[arg(long)]
    stage: String,
    /// The number of the task.
    #[arg(long)]
    task: usize,
}

impl Worker {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let store = context.store.as_deref().ok_or_else(|| Failure::usage("a worker needs --store"))?;
        let stage = StageName::named(&self.stage)
            .ok_or_else(|| Failure::usage(format!("there is no stage '{}'", self.stage)))?;
        let threads = std::env::var("SLURM_CPUS_PER_TASK").ok().and_then(|threads| threads.parse().ok()).unwrap_or(1);
        use_threads(threads)?;
        let bar = Bar::units();
        let told = |progress: StageProgress<'_>| bar.show(progress.stage, progress.done, progress.total);
        let failed = work(Assignment { store, folder: &self.job, stage, task: self.task }, &told);
        bar.finish();
        match failed? {
            None => Ok(Ending::Done),
            Some(reason) => Err(Failure::new(reason)),
        }
    }
}
