//! The reported inputs, written by their generators once, under the target folder.

use crate::support::golden_data::data;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folder with the inputs: `FURROW_FIELD_REPORTS`, else made by `make_cases.sh` in `field_reports`, a folder beside
/// the real recordings. `None`, and a word why, where the generators, Python or the network are not there.
pub fn cases() -> Option<PathBuf> {
    if let Some(folder) = std::env::var_os("FURROW_FIELD_REPORTS") {
        return Some(PathBuf::from(folder));
    }
    let script = data()?.parent()?.join("field_reports/make_cases.sh");
    if !script.is_file() {
        eprintln!("SKIPPED: no {}", script.display());
        return None;
    }
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("field-reports");
    let ready = folder.join("ready");
    if !ready.is_file() {
        let output = Command::new("bash").arg(&script).arg(&folder).output().ok()?;
        if !output.status.success() {
            let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
            let why = stderr.lines().last().unwrap_or("it failed");
            eprintln!("SKIPPED: the reported inputs cannot be made: {why}");
            return None;
        }
        std::fs::write(&ready, "").ok()?;
    }
    Some(folder)
}
