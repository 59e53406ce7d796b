//! The commands about sites.

mod ls;
mod offset;
mod set;

use crate::context::Context;
use crate::ending::{Ending, Failure};
use clap::Subcommand;

/// Say and list what is known of sites: how far their clocks are ahead of UTC, which tells a traversal's day.
#[derive(Debug, Subcommand)]
#[command(after_help = "Examples:\n  furrow site ls\n  furrow site set row-7 --utc-offset +12:00")]
pub enum Site {
    Ls(ls::ListSites),
    Set(set::SetSite),
}

impl Site {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        match self {
            Self::Ls(command) => command.run(context),
            Self::Set(command) => command.run(context),
        }
    }
}
