//! What of the store is written in a form that other programs read.

mod run;
mod trajectory;

use crate::{Context, Ending, Failure};
use clap::Subcommand;

/// Write something of the store in a form that other programs read.
#[derive(Debug, Subcommand)]
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
