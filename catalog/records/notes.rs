//! What an ingest noted about a recording that it accepted.

use super::record::Record;
use serde::{Deserialize, Serialize};

/// Notes for the user, each a sentence: what was unusual, how it was read, what to check. Kept beside a traversal and
/// no part of its id. None is stored where there is nothing to note.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NotesRecord {
    /// In the order of the work: container, topics, calibration, frames, odometry, true poses.
    pub notes: Vec<String>,
}

impl Record for NotesRecord {
    const KIND: &'static str = "notes";
    const VERSION: u32 = 1;
}
