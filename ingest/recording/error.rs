//! Why a recording cannot be read, and what its owner can do about it.

use std::path::{Path, PathBuf};

/// What to do about a file that stops early.
pub(crate) const COPY_OR_SALVAGE: &str = "the recorder did not finish it or the copy is incomplete: copy it again from \
    the robot and compare sizes; if it is the same there, salvage a copy (`rosbag reindex` for .bag, `mcap recover` \
    for .mcap)";

/// What to do about a bag whose recorder was stopped before it wrote the index.
pub(crate) const REINDEX: &str = "the recorder was stopped before it closed the bag, as .bag.active says: run `rosbag \
    reindex` on a copy, which writes the index, and ingest that; its name does not matter";

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
    /// A compression that is not read. The file may well be sound.
    #[error(
        "reading {}: at byte {offset}: not read: compression {name} (read are {readable}); write a copy with one of \
         those, as `mcap compress --compression zstd`, `rosbag compress --lz4` or `ros2 bag convert` do", path.display()
    )]
    Compression {
        /// The file.
        path: PathBuf,
        /// Where in it.
        offset: u64,
        /// As the file names it.
        name: String,
        /// Those that are read.
        readable: &'static str,
    },
    /// A part that the metadata list and that is not there.
    #[error(
        "{} lists {part}, which is not in its folder; recordings there: {found}; copy the whole folder again from the \
         robot, or, if the part is lost, have `ros2 bag reindex` write the metadata of a copy", path.display()
    )]
    MissingPart {
        /// The metadata.
        path: PathBuf,
        /// The part's name.
        part: String,
        /// The names that are there.
        found: String,
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

    /// A compression that is not read.
    pub(crate) fn unknown_compression(path: &Path, offset: u64, name: &[u8], readable: &'static str) -> Self {
        let name = String::from_utf8_lossy(name).into_owned();
        Self::Compression { path: path.to_owned(), offset, name, readable }
    }

    /// The same of a file that another stands for.
    pub(crate) fn renamed(self, to: &Path) -> Self {
        let name = to.to_owned();
        match self {
            Self::Io { doing, source, .. } => Self::Io { path: name, doing, source },
            Self::Unexpected { offset, expected, found, advice, .. } => {
                Self::Unexpected { path: name, offset, expected, found, advice }
            }
            Self::Compression { offset, name: compression, readable, .. } => {
                Self::Compression { path: name, offset, name: compression, readable }
            }
            Self::Database { doing, found, advice, .. } => Self::Database { path: name, doing, found, advice },
            other => other,
        }
    }

    /// The operating system's refusal while `doing`.
    pub(crate) fn io(path: &Path, doing: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| ReadError::Io { path, doing, source }
    }
}
