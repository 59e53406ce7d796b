//! `furrow export`: trajectories, images and runs for other programs. Writing images and a run as MCAP belongs to
//! `furrow_runner::export`.

mod images;
mod run;
mod trajectory;

use crate::context::Context;
use crate::ending::{Ending, Failure};
use clap::Subcommand;

/// Write a trajectory, images or a run in a form that other programs read.
#[derive(Debug, Subcommand)]
#[command(after_help = "Examples:\n  furrow export trajectory 3fa8 --format tum -o morning.tum\n  \
furrow export images 3fa8 --form vpr -o vpr/database\n  \
furrow export run latest --live 08:00 --experience 10:00 -o morning.mcap")]
pub enum Export {
    Trajectory(trajectory::ExportTrajectory),
    Images(images::ExportImages),
    Run(run::ExportRun),
}

impl Export {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        match self {
            Export::Trajectory(command) => command.run(context),
            Export::Images(command) => command.run(context),
            Export::Run(command) => command.run(context),
        }
    }
}
