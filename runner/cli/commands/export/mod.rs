//! `furrow export`: trajectories and runs for other programs. Writing a run as MCAP belongs to
//! `furrow_runner::export`.

mod run;
mod trajectory;

use crate::context::Context;
use crate::ending::{Ending, Failure};
use clap::Subcommand;

/// Write a trajectory or a run in a form that other programs read.
#[derive(Debug, Subcommand)]
#[command(after_help = "Examples:\n  furrow export trajectory 3fa8 --format tum -o morning.tum\n  \
furrow export run latest --live 08:00 --experience 10:00 -o morning.mcap")]
pub enum Export {
    Trajectory(trajectory::ExportTrajectory),
    Run(run::ExportRun),
}

impl Export {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        match self {
            Export::Trajectory(command) => command.run(context),
            Export::Run(command) => command.run(context),
        }
    }
}
