use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::options::{Threads, WhichRun};
use crate::output::{print, print_json};
use crate::progress::with_bar;
use furrow_catalog::Catalog;
use furrow_runner::study::reproduce::{Reproduction, reproduce};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// Compute a run again from the recordings' bytes, in a fresh store, and compare the ids of its outcomes.
///
/// Every traversal is ingested, every generator trained and every cell computed again. Exit code 0 if all ids are
/// equal; else the first difference is shown, with exit code 3. Generators of other programs are copied as they are.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow reproduce latest\n  furrow reproduce 3fa8 --into elsewhere -j 2")]
pub struct Reproduce {
    #[command(flatten)]
    which: WhichRun,
    /// The fresh store: an empty folder, or one to create. It is kept. [default: a temporary folder]
    #[arg(long, value_name = "DIR")]
    into: Option<PathBuf>,
    #[command(flatten)]
    threads: Threads,
}

impl Reproduce {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        self.threads.apply()?;
        let catalog = context.catalog()?;
        let id = self.which.run.find(&catalog)?;
        let work = self.make_work_folder()?;
        let root = self.into.clone().unwrap_or_else(|| work.path().join("store"));
        let used = root.read_dir().is_ok_and(|mut entries| entries.next().is_some());
        if used {
            return Err(Failure::usage(format!(
                "--into {}: expected a folder that is empty or does not exist",
                root.display()
            )));
        }
        let fresh = Catalog::init(&root)?;
        let recordings = work.path().join("recordings");
        let done = with_bar(|progress| reproduce(&catalog, id, &fresh, &recordings, progress))?;
        if context.json {
            print_json(&done)?;
        } else {
            print(&reproduction_text(&done))?;
        }
        Ok(Ending::with_faults_if(done.difference.is_some()))
    }

    /// A folder beside the fresh store, so that recordings can be linked and take no space of their own.
    fn make_work_folder(&self) -> Result<TempDir, Failure> {
        let beside = self.into.as_deref().map(|into| into.parent().filter(|parent| !parent.as_os_str().is_empty()));
        let parent = match beside {
            Some(parent) => parent.unwrap_or(Path::new(".")).to_owned(),
            None => std::env::temp_dir(),
        };
        let work = tempfile::Builder::new().prefix("furrow-reproduce-").tempdir_in(parent);
        work.map_err(|error| Failure::new(format!("cannot make a temporary folder: {error}")))
    }
}

fn reproduction_text(done: &Reproduction) -> String {
    let mut text = format!(
        "run {}: {} traversals, {} generators and {} cells have the same ids\n",
        done.run.short(),
        done.traversals,
        done.generators,
        done.cells
    );
    if done.unfinished > 0 {
        text += &format!("{} cells have no outcome in this store: not compared\n", done.unfinished);
    }
    if let Some(difference) = &done.difference {
        text += &format!(
            "first difference: {}\n  {}\n  this store:  {}\n  fresh store: {}\n",
            difference.subject, difference.place, difference.expected, difference.found
        );
    }
    text
}
