//! Why a recording cannot be read, and what its owner can do about it.

use std::path::{Path, PathBuf};

/// What to do about a file that stops early.
pub(crate) const COPY_OR_SALVAGE: &str = "the recorder did not finish it or the copy is incomplete: copy it again from \
    the robot and compare sizes; if it is the same there, salvage a copy (`rosbag reindex` for .bag, `mcap recover` \
    for .mcap)";

/// What to do about bytes that have changed.
pub(crate) const DAMAGED: &str = "its bytes were damaged: copy it again from the robot and compare checksums; if it is \
    the same there, salvage the rest from a copy (`rosbag reindex` for .bag, `mcap recover` for .mcap, `.recover` of \
    sqlite3 for .db3)";

/// A recording that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The operating system refused.
    #[error("{doing} {}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What was tried, as in "opening".
        doing: &'static str,
        /// Its answer.
        source: std::io::Error,
    },
    /// The file is cut short, damaged, or of another kind.
    #[error("reading {}: at byte {offset}: expected {expected}, found {found}; {advice}", path.display())]
    Unexpected {
        /// The file.
        path: PathBuf,
        /// Where in it.
        offset: u64,
        /// What should be there.
        expected: String,
        /// What is there.
        found: String,
        /// What to do.
        advice: &'static str,
    },
    /// SQLite refused a `.db3` file.
    #[error("reading {} as a rosbag2 database: {doing}: {found}; {advice}", path.display())]
    Database {
        /// The file.
        path: PathBuf,
        /// What was tried.
        doing: String,
        /// What came of it.
        found: String,
        /// What to do.
        advice: &'static str,
    },
    /// A topic that was asked for and that the recording does not have, or not in a form that can be decoded.
    #[error("reading topic {wanted} of {}: {found}; topics there: {}", path.display(), known.join(", "))]
    Topic {
        /// The recording.
        path: PathBuf,
        /// The topic asked for.
        wanted: String,
        /// What is wrong with it.
        found: &'static str,
        /// The names of its topics.
        known: Vec<String>,
    },
}

impl ReadError {
    /// A file that is not as it should be at `offset`.
    pub(crate) fn unexpected(
        path: &Path,
        offset: u64,
        expected: impl Into<String>,
        found: impl Into<String>,
        advice: &'static str,
    ) -> Self {
        ReadError::Unexpected { path: path.to_owned(), offset, expected: expected.into(), found: found.into(), advice }
    }

    /// The operating system's refusal while `doing`.
    pub(crate) fn io(path: &Path, doing: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| ReadError::Io { path, doing, source }
    }
}
