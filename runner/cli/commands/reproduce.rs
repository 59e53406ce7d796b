use super::chosen_run;
use crate::progress::Bar;
use crate::{Context, Ending, Failure, print, print_json};
use furrow_catalog::Catalog;
use furrow_runner::reproduce::{Reproduction, reproduce};
use std::path::PathBuf;

/// Compute a run again from the recordings' bytes, in a fresh store, and compare the ids of its outcomes.
///
/// Every pass is ingested, every generator trained and every cell computed anew. Ends with 0 where all is the same; else shows the first
/// difference and ends with 3. Generators of other programs are brought along as they are.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow reproduce latest\n  furrow reproduce 3fa8 --into elsewhere")]
pub struct Reproduce {
    /// The run: its id, the beginning of it, or `latest`.
    run: String,
    /// The fresh store, made there and kept; one that is thrown away where left out.
    #[arg(long, value_name = "DIR")]
    into: Option<PathBuf>,
    /// Threads; all cores where left out.
    #[arg(short, long, value_name = "N")]
    jobs: Option<usize>,
}

impl Reproduce {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        if let Some(jobs) = self.jobs {
            rayon::ThreadPoolBuilder::new()
                .num_threads(jobs)
                .build_global()
                .map_err(|error| Failure::new(format!("cannot start {jobs} threads: {error}")))?;
        }
        let catalog = context.catalog()?;
        let id = chosen_run(&catalog, &self.run)?;
        let unmade = |error: std::io::Error| Failure::new(format!("cannot make a temporary folder: {error}"));
        // Beside the store, so that recordings can be linked and need no room of their own.
        let work = tempfile::Builder::new().prefix("furrow-reproduce-").tempdir_in(match &self.into {
            Some(into) => {
                into.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(".".as_ref()).to_owned()
            }
            None => std::env::temp_dir(),
        });
        let work = work.map_err(unmade)?;
        let root = self.into.clone().unwrap_or_else(|| work.path().join("store"));
        let used = root.read_dir().is_ok_and(|mut entries| entries.next().is_some());
        if used {
            return Err(Failure::usage(format!(
                "--into {}: expected a folder that is empty or not there",
                root.display()
            )));
        }
        let fresh = Catalog::init(&root)?;
        let bar = Bar::units();
        let done = reproduce(&catalog, id, &fresh, &work.path().join("recordings"), &|progress| {
            bar.show(progress.stage, progress.done, progress.total)
        });
        bar.finish();
        let done = done?;
        if context.json {
            print_json(&done)?;
        } else {
            print(&told(&done))?;
        }
        Ok(if done.difference.is_some() { Ending::WithFaults } else { Ending::Done })
    }
}

fn told(done: &Reproduction) -> String {
    let mut text = format!(
        "run {}: {} passes, {} generators and {} cells came out with the same ids\n",
        done.run.short(),
        done.passes,
        done.generators,
        done.cells
    );
    if done.unfinished > 0 {
        text += &format!("{} cells have no outcome in this store: nothing to compare with\n", done.unfinished);
    }
    if let Some(difference) = &done.difference {
        text += &format!(
            "first difference: {}\n  {}\n  this store:  {}\n  fresh store: {}\n",
            difference.subject, difference.place, difference.expected, difference.found
        );
    }
    text
}
