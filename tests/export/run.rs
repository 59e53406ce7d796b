//! The run of which every test exports something, made once.

use crate::support::command::{Quoted, quoted};
use crate::support::events::{Row, accepted, rows_by_frame};
use crate::support::matrix::Matrix;
use crate::support::recordings::ran;
use crate::support::store::Store;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::OnceLock;
use tempfile::TempDir;

/// A collective's name that would like to be markup, to turn the text around and to be long.
const HOSTILE: &str = "</script>\u{202e}<img src=x onerror=alert(1)>";

/// A store with one run of which every test exports something.
pub struct Run {
    pub store: Store,
    pub run: Value,
    pub hostile: String,
}

impl Run {
    pub fn made() -> &'static Self {
        static RUN: OnceLock<Run> = OnceLock::new();
        RUN.get_or_init(|| {
            let store = ran().store.copy();
            let hostile = HOSTILE.to_owned() + &"x".repeat(300);
            let matrix = Matrix::small().experiences(&["08:00", "10:00", "14:00"]);
            let matrix = matrix.collective(&hostile, "recorded", "policy = { slot = 1 }").write(store.path());
            // Nothing was recorded at 14:00: that cell is blocked.
            let run = store.furrow(format!("run {matrix}")).json_with_code(3);
            Self { store, run, hostile }
        })
    }

    /// A cell as `furrow run --json` prints it.
    pub fn cell(&self, experience: &str) -> &Value {
        let mut cells = self.run["cells"].as_array().unwrap().iter();
        cells.find(|cell| cell["experience"] == experience).unwrap()
    }

    /// Exports a cell.
    pub fn export(&self, experience: &str, file: &Path) -> Value {
        let (experience, file) = (quoted(experience), quoted(file));
        self.store.json(format!("export run latest --experience {experience} -o {file}"))
    }
}

/// The exported collective `both`.
pub struct Both {
    pub run: &'static Run,
    pub file: Quoted,
    /// What the command printed.
    pub summary: Value,
    /// The rows that it stands on, by live stamp.
    pub frames: BTreeMap<i64, Vec<Row>>,
    pub folder: TempDir,
}

pub fn both() -> Both {
    let run = Run::made();
    let folder = tempfile::tempdir().unwrap();
    let file = quoted(folder.path().join("both.mcap"));
    let summary = run.export("both", &file);
    Both { run, file, summary, frames: rows_by_frame(run.store.path(), run.cell("both")), folder }
}

/// The row that a frame's images show: the localisation, else the first with most inliers.
pub fn shown(rows: &[Row]) -> Option<&Row> {
    let most = rows.iter().filter_map(|row| row.inliers).max();
    accepted(rows).or_else(|| rows.iter().find(|row| row.inliers.is_some() && row.inliers == most))
}
