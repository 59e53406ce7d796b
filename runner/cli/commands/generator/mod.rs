//! `furrow generator`: train, add, list and show. Training and the quality gate belong to
//! `furrow_runner::generation`.

mod add;
mod ls;
mod show;
mod train;

use crate::context::Context;
use crate::ending::{Ending, Failure};
use clap::Subcommand;

/// Train, add, list and show generators: what moves images to another time of day.
#[derive(Debug, Subcommand)]
#[command(after_help = "Examples:\n  furrow generator train --site old-zoo --from 10:00 --to 16:00\n  \
furrow generator add translator.json\n  furrow generator ls\n  furrow generator show 'otf:10:00>16:00'")]
pub enum Generator {
    Train(train::TrainGenerator),
    Add(add::AddGenerator),
    Ls(ls::ListGenerators),
    Show(show::ShowGenerator),
}

impl Generator {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        match self {
            Self::Train(command) => command.run(context),
            Self::Add(command) => command.run(context),
            Self::Ls(command) => command.run(context),
            Self::Show(command) => command.run(context),
        }
    }
}
