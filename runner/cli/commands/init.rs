use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use furrow_catalog::Catalog;
use std::path::PathBuf;

/// Make a store in a folder. A store that exists is not changed.
#[derive(Debug, clap::Args)]
#[command(after_help = "Example:\n  furrow init field\n  export FURROW_STORE=$PWD/field")]
pub struct Init {
    /// The folder; created if it does not exist.
    dir: PathBuf,
}

impl Init {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        Catalog::init(&self.dir)?;
        if context.json {
            print_json(&serde_json::json!({ "store": self.dir }))?;
        } else {
            print(&format!(
                "{} is a store: ingest recordings with `furrow ingest FILE --store {0}`\n",
                self.dir.display()
            ))?;
        }
        Ok(Ending::Done)
    }
}
