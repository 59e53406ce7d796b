//! What can go wrong with a store.

use std::path::{Path, PathBuf};

/// An error of the store, naming what was done to what, what was expected and what to do next.
#[derive(Debug, thiserror::Error)]
pub enum CatalogError {
    /// The operating system refused a file operation.
    #[error("cannot {action} {path}: {source}{}", advice_on(action, source))]
    File {
        /// The verb, as in "read".
        action: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// The system's reason.
        source: std::io::Error,
    },
    /// A store that was opened where it cannot be written.
    #[error(
        "the store {path} is read-only: it can be looked at, but nothing can be entered; work on a copy of it, or ask \
         for the right to write there"
    )]
    ReadOnly {
        /// The store's folder.
        path: PathBuf,
    },
    /// No store where one was expected.
    #[error("{path} holds no store (no catalogue.db): make one with `furrow init {path}`, or name one with --store")]
    NoStore {
        /// The folder.
        path: PathBuf,
    },
    /// No store here or above.
    #[error(
        "no store in {start} or any folder above it: make one with `furrow init DIR`, then use --store DIR or FURROW_STORE"
    )]
    NoneAbove {
        /// Where the search began.
        start: PathBuf,
    },
    /// An object that a record speaks of is not there.
    #[error("object {id} is missing from the store: run `furrow fsck`, and restore it from a copy of the store")]
    MissingObject {
        /// Its digest.
        id: furrow_model::ObjectId,
    },
    /// An object whose bytes have changed.
    #[error(
        "object {id} is damaged: its bytes have another digest: run `furrow fsck`, and restore it from a copy of the store"
    )]
    DamagedObject {
        /// Its digest.
        id: furrow_model::ObjectId,
    },
    /// A record of another kind or a later format.
    #[error("object {id} is not what it should be: expected a record of kind '{expected}', found {found}")]
    WrongRecord {
        /// Its digest.
        id: furrow_model::ObjectId,
        /// The kind and version that this program reads.
        expected: String,
        /// What is there.
        found: String,
    },
    /// A record, or what a key is made of, that JSON cannot hold.
    #[error("cannot write JSON: {0}")]
    Json(serde_json::Error),
    /// A table that cannot be read or written.
    #[error("table {what}: {reason}")]
    Table {
        /// Which table.
        what: String,
        /// The reader's words.
        reason: String,
    },
    /// The index refused.
    #[error("catalogue index: {0}")]
    Index(#[from] sqlx::Error),
    /// The index could not be brought to this program's format.
    #[error("catalogue index cannot be migrated: {0}; was the store written by a newer furrow?")]
    Migration(#[from] sqlx::migrate::MigrateError),
    /// An index of another format, opened to be read only.
    #[error(
        "{path} is of format {found}, expected {expected}: `furrow ls` brings an older one to this program's format; a newer one needs a newer furrow"
    )]
    OtherFormat {
        /// The index.
        path: PathBuf,
        /// Its format.
        found: i64,
        /// This program's.
        expected: i64,
    },
    /// A name that matches nothing, or several things.
    #[error("{0}")]
    NotFound(String),
}

/// What to do where a disk does not take a file.
fn advice_on(action: &str, source: &std::io::Error) -> &'static str {
    use std::io::ErrorKind::{PermissionDenied, QuotaExceeded, ReadOnlyFilesystem, StorageFull};
    match source.kind() {
        StorageFull | QuotaExceeded => ": the disk is full; free some space on it and run the same command again",
        ReadOnlyFilesystem => ": it is read-only; a store there can be looked at, but not written",
        PermissionDenied if !matches!(action, "read" | "list" | "open") => {
            ": you have no right to write there; if it is a store, it can be looked at"
        }
        _ => "",
    }
}

impl CatalogError {
    /// Wraps an I/O error with the verb and the path.
    pub fn file(action: &'static str, path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        move |source| Self::File { action, path: path.to_owned(), source }
    }

    /// Wraps any table error.
    pub fn table(what: impl Into<String>) -> impl FnOnce(polars::error::PolarsError) -> Self {
        let what = what.into();
        move |error| Self::Table { what, reason: error.to_string() }
    }
}
