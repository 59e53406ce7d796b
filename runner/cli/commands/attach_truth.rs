use crate::choosing::choose_traversal;
use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use furrow_ingest::traversal::attach_truth;
use std::path::PathBuf;

/// Attach true poses to a traversal that is in the store, or replace those that it has.
///
/// Images, chain and experience stay as they are. The traversal gets another id, since outcomes that were judged by
/// other poses, or by none, are not comparable: `furrow run` judges anew by these, and what was run before keeps its
/// numbers and poses.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow attach-truth 3fa8 row7.groundtruth.tum\n  \
furrow attach-truth 3fa8 surveyed.tum --json")]
pub struct AttachTruth {
    /// The traversal: the beginning of its id, as `furrow ls` lists it.
    traversal: String,
    /// True poses in TUM form: a line `seconds tx ty tz qx qy qz qw` each, the left camera in a world with x east, y
    /// north, z up.
    file: PathBuf,
}

impl AttachTruth {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let id = choose_traversal(&catalog, &self.traversal)?;
        let summary = attach_truth(&catalog, id, &self.file)?;
        if context.json {
            print_json(&summary)?;
            return Ok(Ending::Done);
        }
        let short = summary.traversal.short();
        let did = match (summary.supersedes, summary.replaced) {
            (None, _) => format!("traversal {short} has these true poses already"),
            (Some(earlier), None) => {
                format!("attached to traversal {}, which is {short} from now on", earlier.short())
            }
            (Some(earlier), Some(_)) => {
                format!("replaced those of traversal {}, which is {short} from now on", earlier.short())
            }
        };
        let notes: String = summary.notes.iter().map(|note| format!("  note: {note}\n")).collect();
        let counted = format!("{} of {} frames have a true pose", summary.frames_with_pose, summary.frames);
        print(&format!("{did}\n  {counted}\n{notes}"))?;
        Ok(Ending::Done)
    }
}
