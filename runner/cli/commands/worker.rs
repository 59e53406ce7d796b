use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::use_threads;
use crate::progress::with_bar;
use furrow_runner::slurm::{Assignment, StageName, work};
use std::path::PathBuf;

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
        let assignment = Assignment { store, folder: &self.job, stage, task: self.task };
        match with_bar(|progress| work(assignment, progress))? {
            None => Ok(Ending::Done),
            Some(reason) => Err(Failure::new(reason)),
        }
    }
}
