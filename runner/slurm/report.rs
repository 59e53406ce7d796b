//! What a task leaves beside its log, and what of it is of use to those who wait.

use super::job::StageName;
use crate::RunError;
use crate::study::work::Work;
use furrow_catalog::write_file;
use furrow_model::CellKey;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// What came of a task.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Report {
    /// Cells that failed, each with the reason.
    pub failed: Vec<(CellKey, String)>,
    /// Why the task as a whole failed.
    pub fault: Option<String>,
    /// What was computed, by kind of stage.
    pub work: BTreeMap<String, Work>,
    /// Threads it ran on.
    pub threads: u32,
}

impl Report {
    /// Whether nothing is left to do.
    pub fn is_whole(&self) -> bool {
        self.failed.is_empty() && self.fault.is_none()
    }

    /// Reads the report of a task; none where there is none yet, or only a torn one.
    pub fn read(folder: &Path, stage: StageName, task: usize) -> Option<Self> {
        let text = fs::read(folder.join(report_name(stage, task))).ok()?;
        serde_json::from_slice(&text).ok()
    }

    /// Writes the report of a task.
    pub fn write(&self, folder: &Path, stage: StageName, task: usize) -> Result<(), RunError> {
        let text = serde_json::to_vec_pretty(self).map_err(|error| RunError::Slurm(error.to_string()))?;
        Ok(write_file(&folder.join(report_name(stage, task)), &text)?)
    }
}

fn report_name(stage: StageName, task: usize) -> String {
    format!("{}-{task}.json", stage.name())
}

/// Where a task's output goes.
pub(super) fn log_of(folder: &Path, stage: StageName, task: usize) -> PathBuf {
    folder.join(format!("{}-{task}.log", stage.name()))
}

/// The last lines of a task's log, each indented and on a new line.
pub(super) fn tail(folder: &Path, stage: StageName, task: usize) -> String {
    const LINES: usize = 8;
    let text = fs::read(log_of(folder, stage, task)).unwrap_or_default();
    let text = String::from_utf8_lossy(&text);
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim().is_empty()).collect();
    lines[lines.len().saturating_sub(LINES)..].iter().map(|line| format!("\n  {line}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_torn_report_is_none_and_a_log_shows_its_end() {
        let folder = tempfile::tempdir().unwrap();
        let failed = Report { fault: Some("no space left".to_owned()), ..Report::default() };
        failed.write(folder.path(), StageName::Words, 3).unwrap();
        assert_eq!(Report::read(folder.path(), StageName::Words, 3), Some(failed));
        assert_eq!(Report::read(folder.path(), StageName::Words, 4), None);
        fs::write(folder.path().join("words-4.json"), b"{\"failed\":[").unwrap();
        assert_eq!(Report::read(folder.path(), StageName::Words, 4), None);
        let lines: Vec<String> = (0..20).map(|i| format!("line {i}\n\n")).collect();
        fs::write(log_of(folder.path(), StageName::Cells, 0), lines.concat()).unwrap();
        assert!(tail(folder.path(), StageName::Cells, 0).starts_with("\n  line 12\n"));
        assert!(tail(folder.path(), StageName::Cells, 0).ends_with("\n  line 19"));
        assert_eq!(tail(folder.path(), StageName::Cells, 1), "");
    }
}
