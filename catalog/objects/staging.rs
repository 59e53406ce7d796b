//! One ingest is one transaction: its objects gather in a folder of their own under `tmp/` and move into the store
//! together, just before the rows that speak of them. Killed before that, the folder is swept away by the next that
//! comes.

use super::files::{MACHINE, OWNER, move_into_place, sync_folder};
use super::names::digest;
use super::object_store::Objects;
use super::syncing::Syncing;
use crate::CatalogError;
use furrow_model::ObjectId;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Objects on their way into the store.
#[derive(Debug)]
pub struct Staging {
    objects: Objects,
    folder: PathBuf,
    /// Held for as long as the staging lives: another process can tell a live one from a killed one.
    _lock: File,
    staged: Mutex<BTreeSet<ObjectId>>,
    /// Makes what is staged durable meanwhile; none once it is published.
    syncing: Mutex<Option<Syncing>>,
}

/// The file whose lock says that the staging's process lives.
const LOCK: &str = "lock";
/// What another machine left alone for so long, its process no longer writes.
const ABANDONED: Duration = Duration::from_secs(24 * 3600);

impl Staging {
    pub(crate) fn begin(root: &Path, objects: &Objects) -> Result<Self, CatalogError> {
        let tmp = root.join("tmp");
        sweep(&tmp)?;
        let folder = (0..)
            .map(|n: u64| tmp.join(format!("staging-{}-{n}", *OWNER)))
            .find(|folder| !folder.exists())
            .unwrap_or_else(|| tmp.join("staging"));
        fs::create_dir_all(&folder).map_err(CatalogError::file("make folder", &folder))?;
        let path = folder.join(LOCK);
        let lock = File::create(&path).map_err(CatalogError::file("write", &path))?;
        lock.lock().map_err(CatalogError::file("lock", &path))?;
        Ok(Self {
            objects: objects.clone(),
            folder,
            _lock: lock,
            staged: Mutex::default(),
            syncing: Mutex::new(Some(Syncing::begin())),
        })
    }

    /// Adds an object to the transaction. Not durable until the traversal is entered.
    ///
    /// # Errors
    /// [`CatalogError::File`] where the disk refuses.
    pub fn write(&self, bytes: &[u8]) -> Result<ObjectId, CatalogError> {
        let id = digest(bytes);
        let stage = || self.staged.lock().unwrap_or_else(PoisonError::into_inner).insert(id);
        let fresh = !self.objects.contains(id) && stage();
        if fresh {
            let path = self.path(id);
            fs::write(&path, bytes).map_err(CatalogError::file("write", &path))?;
            if let Some(syncing) = &*self.syncing.lock().unwrap_or_else(PoisonError::into_inner) {
                syncing.push(path);
            }
        }
        Ok(id)
    }

    /// A file name of its own inside the transaction's folder, for what is not an object.
    pub fn file(&self, name: &str) -> PathBuf {
        self.folder.join(name)
    }

    fn path(&self, id: ObjectId) -> PathBuf {
        self.folder.join(id.to_string())
    }

    /// Makes every staged object durable and moves it into the store: fsync each, rename each, fsync each folder.
    pub(crate) fn publish(&self) -> Result<(), CatalogError> {
        let staged = self.staged.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if let Some(syncing) = self.syncing.lock().unwrap_or_else(PoisonError::into_inner).take() {
            syncing.finish()?;
        }
        let mut folders = BTreeSet::new();
        for id in staged {
            let to = self.objects.path(id);
            move_into_place(&self.path(id), &to)?;
            folders.extend(to.parent().map(Path::to_owned));
        }
        folders.par_iter().try_for_each(|folder| sync_folder(folder))
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        // What is left here is of no use to anyone, and a next staging sweeps it too if this fails.
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// Removes what killed processes left in `tmp/`.
fn sweep(tmp: &Path) -> Result<(), CatalogError> {
    for entry in fs::read_dir(tmp).map_err(CatalogError::file("list", tmp))?.flatten() {
        let path = entry.path();
        let abandoned = match File::open(path.join(LOCK)) {
            Ok(lock) => lock.try_lock().is_ok() && !process_lives(&path),
            Err(_) => !process_lives(&path),
        };
        if path.is_dir() && abandoned {
            remove(fs::remove_dir_all(&path), &path)?;
        }
        if path.is_file() && !process_lives(&path) {
            remove(fs::remove_file(&path), &path)?;
        }
    }
    Ok(())
}

/// What another sweep has removed already is no error.
fn remove(result: std::io::Result<()>, path: &Path) -> Result<(), CatalogError> {
    match result {
        Err(error) if error.kind() != std::io::ErrorKind::NotFound => Err(CatalogError::file("remove", path)(error)),
        _ => Ok(()),
    }
}

/// Whether the process that a temporary name tells of (`object-PID-MACHINE-…`, `staging-PID-MACHINE-…`) may still write
/// there. One of another machine is given a day.
fn process_lives(path: &Path) -> bool {
    let name = path.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    let mut parts = name.split('-').skip(1);
    let Some(pid) = parts.next() else { return false };
    if parts.next().is_none_or(|there| there == *MACHINE) {
        return Path::new("/proc").join(pid).exists();
    }
    let age = fs::metadata(path).and_then(|data| data.modified()).ok().and_then(|changed| changed.elapsed().ok());
    age.is_some_and(|age| age < ABANDONED)
}
