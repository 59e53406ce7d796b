//! The store's objects, and the pointers from a derivation's key to its result.

use super::files::write_through;
use super::names::digest;
use crate::CatalogError;
use furrow_model::ObjectId;
use std::fs;
use std::path::{Path, PathBuf};

/// The store's objects. Cheap to clone; many threads and processes may add at once, since equal names mean equal bytes.
#[derive(Debug, Clone)]
pub struct Objects {
    root: PathBuf,
}

impl Objects {
    pub(crate) fn new(root: &Path) -> Self {
        Self { root: root.to_owned() }
    }

    /// Where the object's bytes lie.
    pub fn path(&self, id: ObjectId) -> PathBuf {
        let name = id.to_string();
        self.root.join("objects").join(&name[..2]).join(name)
    }

    /// Whether the object is there.
    pub fn contains(&self, id: ObjectId) -> bool {
        self.path(id).exists()
    }

    /// The object's bytes.
    ///
    /// # Errors
    /// [`CatalogError::MissingObject`] where it is not there, [`CatalogError::DamagedObject`] where its bytes are not
    /// those of its name, [`CatalogError::File`] where it cannot be read.
    pub fn read(&self, id: ObjectId) -> Result<Vec<u8>, CatalogError> {
        let path = self.path(id);
        match fs::read(&path) {
            Ok(bytes) if digest(&bytes) == id => Ok(bytes),
            Ok(_) => Err(CatalogError::DamagedObject { id }),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Err(CatalogError::MissingObject { id }),
            Err(error) => Err(CatalogError::file("read", &path)(error)),
        }
    }

    /// Adds an object; adding the same bytes again changes nothing.
    ///
    /// # Errors
    /// [`CatalogError::File`] where the disk refuses; nothing half-written is ever visible.
    pub fn write(&self, bytes: &[u8]) -> Result<ObjectId, CatalogError> {
        let id = digest(bytes);
        let path = self.path(id);
        if !path.exists() {
            self.publish(&path, bytes)?;
        }
        Ok(id)
    }

    /// What a derivation with this key gave, if it was ever finished.
    ///
    /// # Errors
    /// [`CatalogError::File`] where the pointer is there and cannot be read.
    pub fn derived(&self, key: ObjectId) -> Result<Option<ObjectId>, CatalogError> {
        let path = self.pointer(key);
        match fs::read_to_string(&path) {
            Ok(text) => Ok(text.trim().parse().ok().filter(|id| self.contains(*id))),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(CatalogError::file("read", &path)(error)),
        }
    }

    /// Remembers that the derivation with this key gave `result`.
    ///
    /// # Errors
    /// [`CatalogError::File`] where the disk refuses.
    pub fn remember(&self, key: ObjectId, result: ObjectId) -> Result<(), CatalogError> {
        self.publish(&self.pointer(key), format!("{result}\n").as_bytes())
    }

    fn pointer(&self, key: ObjectId) -> PathBuf {
        let name = key.to_string();
        self.root.join("derived").join(&name[..2]).join(name)
    }

    fn publish(&self, path: &Path, bytes: &[u8]) -> Result<(), CatalogError> {
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder).map_err(CatalogError::file("make folder", folder))?;
        }
        write_through(&self.root.join("tmp"), path, bytes)
    }
}
