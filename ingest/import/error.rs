//! Why a dataset cannot be imported.

use crate::folder::FolderError;
use furrow_catalog::images::CalibrationFileError;
use std::io;
use std::path::{Path, PathBuf};

/// A dataset that does not fit its profile, or a profile that is none.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// No built-in profile of this name.
    #[error("no profile '{name}'{advice}; built in are {known}; a file of your own is named with its .toml")]
    Unknown {
        /// As it was given.
        name: String,
        /// A name that is near, or nothing.
        advice: String,
        /// All names.
        known: String,
    },
    /// A profile that cannot be read.
    #[error("profile {name}: {fault}; `furrow import --show euroc` prints one that is right")]
    Profile {
        /// Its name or file.
        name: String,
        /// What was expected, what was found.
        fault: String,
    },
    /// Something that the profile names is not there.
    #[error("{folder}: looked for {wanted}, found {found}; {advice}")]
    Missing {
        /// The dataset's folder.
        folder: PathBuf,
        /// What was looked for.
        wanted: String,
        /// What is there.
        found: String,
        /// What to do.
        advice: String,
    },
    /// A line that does not say what the profile expects of it.
    #[error("{path}, line {line}: expected {expected}, found {found}; mend the line, or the profile that says so")]
    Line {
        /// The file.
        path: PathBuf,
        /// From 1.
        line: usize,
        /// What the profile says.
        expected: String,
        /// What stands there.
        found: String,
    },
    /// A file whose whole does not fit.
    #[error("{path}: {fault}")]
    File {
        /// The file.
        path: PathBuf,
        /// What is wrong and what to do.
        fault: String,
    },
    /// A file or folder that the operating system does not give.
    #[error("cannot read {path}: {source}")]
    Unreadable {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The names of images.
    #[error(transparent)]
    Folder(#[from] FolderError),
    /// The calibration.
    #[error(transparent)]
    Calibration(#[from] CalibrationFileError),
}

impl ImportError {
    /// The operating system's refusal to read `path`.
    pub(super) fn unreadable(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Unreadable { path, source }
    }

    /// A file that does not fit.
    pub(super) fn file(path: &Path, fault: impl Into<String>) -> Self {
        Self::File { path: path.to_owned(), fault: fault.into() }
    }
}
