//! One store, opened: its folders, its objects, its index.

use crate::CatalogError;
use crate::index::Index;
use crate::objects::{Objects, sync_folder};
use furrow_model::{ObjectId, RunId};
use std::fs;
use std::path::{Path, PathBuf};

/// An open store.
#[derive(Debug)]
pub struct Catalog {
    root: PathBuf,
    objects: Objects,
    index: Index,
}

/// The file that makes a folder a store.
const DATABASE: &str = "catalogue.db";
/// The store's folders.
const FOLDERS: [&str; 7] = ["objects", "derived", "recordings", "quarantine", "runs", "reports", "tmp"];

/// Whether files can be made in a folder. Asked only where something failed.
pub(super) fn can_be_written(folder: &Path) -> bool {
    tempfile::tempfile_in(folder).is_ok()
}

impl Catalog {
    /// Makes a store in `root`, or opens the one that is there.
    ///
    /// # Errors
    /// [`CatalogError::File`] where the folders cannot be made.
    pub fn init(root: &Path) -> Result<Self, CatalogError> {
        for name in FOLDERS {
            let folder = root.join(name);
            fs::create_dir_all(&folder).map_err(CatalogError::file("make folder", &folder))?;
        }
        for shelves in ["objects", "derived"].map(|name| root.join(name)) {
            for shelf in (0..=u8::MAX).map(|number| shelves.join(format!("{number:02x}"))) {
                fs::create_dir_all(&shelf).map_err(CatalogError::file("make folder", &shelf))?;
            }
            sync_folder(&shelves)?;
        }
        let catalog = Self::with_index(root, Index::open(&root.join(DATABASE), true)?);
        sync_folder(root)?;
        Ok(catalog)
    }

    /// Opens the store in `root`; one that cannot be written, to look at it.
    ///
    /// # Errors
    /// [`CatalogError::NoStore`] where there is none.
    pub fn open(root: &Path) -> Result<Self, CatalogError> {
        let database = root.join(DATABASE);
        if !database.is_file() {
            return Err(CatalogError::NoStore { path: root.to_owned() });
        }
        let index = match Index::open(&database, false) {
            Err(_) if !can_be_written(root) => Index::open_unwritable(&database)?,
            opened => opened?,
        };
        Ok(Self::with_index(root, index))
    }

    /// Opens the store in `root` to look at it. Its index cannot be written; while no other process writes to it, no
    /// file appears or changes, either.
    ///
    /// # Errors
    /// [`CatalogError::NoStore`] where there is none, [`CatalogError::OtherFormat`] where its index is of another
    /// format.
    pub fn open_to_read(root: &Path) -> Result<Self, CatalogError> {
        if !root.join(DATABASE).is_file() {
            return Err(CatalogError::NoStore { path: root.to_owned() });
        }
        Ok(Self::with_index(root, Index::open_to_read(&root.join(DATABASE))?))
    }

    /// The nearest folder upwards from `start` that holds a store.
    ///
    /// # Errors
    /// [`CatalogError::NoneAbove`] where none does.
    pub fn find(start: &Path) -> Result<PathBuf, CatalogError> {
        start
            .ancestors()
            .find(|folder| folder.join(DATABASE).is_file())
            .map(Path::to_owned)
            .ok_or_else(|| CatalogError::NoneAbove { start: start.to_owned() })
    }

    pub(super) fn with_index(root: &Path, index: Index) -> Self {
        Self { root: root.to_owned(), objects: Objects::new(root), index }
    }

    /// The store's folder.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// Where the state of a job that may be killed lies until it is done. The next ingest clears it away: a job that
    /// finds nothing starts anew.
    pub fn unfinished_file(&self, name: &str) -> PathBuf {
        self.root.join("tmp").join(name)
    }

    /// Where what workers tell of a run lies: logs and reports, for people and for the submitting process. No result
    /// depends on them.
    pub fn run_folder(&self, run: RunId) -> PathBuf {
        self.root.join("runs").join(run.to_string())
    }

    /// The objects, for reading and for workers.
    pub fn objects(&self) -> &Objects {
        &self.objects
    }

    pub(crate) fn index(&self) -> &Index {
        &self.index
    }

    /// Where a recording's file lies, or would lie.
    pub fn recording_path(&self, digest: ObjectId) -> PathBuf {
        self.root.join("recordings").join(digest.to_string())
    }

    /// The folder for pages that a user keeps with the store.
    pub fn reports_folder(&self) -> PathBuf {
        self.root().join("reports")
    }
}
