use crate::{Context, Ending, Failure, print, print_json};
use furrow_catalog::Catalog;
use std::path::PathBuf;

/// Make a store in a folder. A store that is there already stays as it is.
#[derive(Debug, clap::Args)]
pub struct Init {
    /// The folder; made where it is not there.
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
