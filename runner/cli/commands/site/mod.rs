//! The commands about sites.

mod ls;
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

/// Minutes ahead of UTC as people write them, `+12:00`.
fn offset_text(minutes: i32) -> String {
    let sign = if minutes < 0 { '-' } else { '+' };
    format!("{sign}{:02}:{:02}", minutes.abs() / 60, minutes.abs() % 60)
}
