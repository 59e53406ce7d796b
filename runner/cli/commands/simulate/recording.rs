//! One recording of the simulated field.

use crate::context::Context;
use crate::ending::Failure;
use crate::output::print_json;
use crate::progress::Bar;
use furrow_field::Traversal;
use furrow_field::record::{Summary, record};
use serde_json::{Value, json};
use std::path::Path;

/// Records a traversal, with a bar.
pub fn record_with_bar(traversal: &Traversal, output: &Path, stage: &str) -> Result<Summary, Failure> {
    let bar = Bar::units();
    let recorded = record(traversal, output, &mut |done, total| bar.show(stage, done, total));
    bar.finish();
    recorded.map_err(|error| Failure::new(error.to_string()))
}

/// Prints what was recorded.
pub fn print_summary(summary: &Summary, output: &Path, context: &Context) -> Result<(), Failure> {
    if context.json {
        return print_json(&summary_json(summary));
    }
    eprintln!("{}", summary_line(summary, output));
    Ok(())
}

/// What was recorded, as programs read it.
pub fn summary_json(summary: &Summary) -> Value {
    json!({
        "files": summary.files,
        "frames": summary.frames,
        "pairs": summary.pairs,
        "length_m": summary.length_m,
        "bytes": summary.bytes,
        "first_stamp_ns": summary.stamps_ns.0,
        "last_stamp_ns": summary.stamps_ns.1,
    })
}

/// The same in a line.
pub fn summary_line(summary: &Summary, output: &Path) -> String {
    format!("{}: {} stereo pairs over {:.1} m", output.display(), summary.pairs, summary.length_m)
}
