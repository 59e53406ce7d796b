use crate::context::Context;
use crate::ending::{Ending, Failure};
use crate::output::{print, print_json};
use crate::progress::Bar;
use furrow_catalog::fsck::fsck;

/// Check every object, row and recording of the store.
///
/// Changes nothing. Exit code 3 if something is wrong.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  furrow fsck\n  furrow fsck --json --store field")]
pub struct Fsck {}

impl Fsck {
    pub fn run(self, context: &Context) -> Result<Ending, Failure> {
        let catalog = context.catalog()?;
        let bar = Bar::units();
        let findings = fsck(&catalog, &|done, total| bar.show("checking objects", done, total));
        bar.finish();
        let findings = findings?;
        if context.json {
            print_json(&findings)?;
        } else {
            let faults = findings.faults.len();
            let mut text =
                format!("{} objects and {} rows checked, {faults} faults\n", findings.objects, findings.rows);
            for fault in &findings.faults {
                text += &format!("  {} {}: {}\n", fault.kind, fault.subject, fault.detail);
            }
            print(&text)?;
        }
        Ok(Ending::with_faults_if(!findings.faults.is_empty()))
    }
}
