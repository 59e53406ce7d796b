//! Why a recording could not be made.

use crate::traversal::BadTraversal;
use std::io;
use std::path::PathBuf;

/// Why a recording could not be made.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The traversal itself.
    #[error(transparent)]
    Traversal(#[from] BadTraversal),
    /// The output's name.
    #[error("cannot record to {0}: expected a file name that ends in .mcap (ROS 2) or .bag (ROS 1)")]
    Extension(PathBuf),
    /// A file.
    #[error("cannot write {path}: {source}")]
    Write {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A container.
    #[error("cannot write {path} as MCAP: {source}")]
    Mcap {
        /// Which file.
        path: PathBuf,
        /// What the writer said.
        source: ::mcap::McapError,
    },
}
