//! Immutable objects named by the BLAKE3 digest of their bytes, and the small pointers from a derivation's key to its result. Both are
//! plain files, so that workers on any machine that sees the folder can read and add without the database.

use crate::CatalogError;
use furrow_model::ObjectId;
use serde::Serialize;
use std::fs::{self, File};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

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
    /// [`CatalogError::MissingObject`] where it is not there, [`CatalogError::DamagedObject`] where its bytes are not those of its name,
    /// [`CatalogError::File`] where it cannot be read.
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

/// Temp file in `folder`, fsync, rename, fsync of the folder it comes to lie in. A killed process' file is known by its number.
fn write_through(folder: &Path, path: &Path, bytes: &[u8]) -> Result<(), CatalogError> {
    write_through_by(folder, path, |file| file.write_all(bytes).map_err(CatalogError::file("write", path)))
}

fn write_through_by<T, E: From<CatalogError>>(
    folder: &Path,
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<T, E>,
) -> Result<T, E> {
    let failed = |error| E::from(CatalogError::file("write", path)(error));
    let mut builder = tempfile::Builder::new();
    let prefix = format!("object-{}-", *OWNER);
    // As any other new file's: the umask takes away what the user does not want to share.
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder.prefix(&prefix).tempfile_in(folder).map_err(failed)?;
    let written = write(file.as_file_mut())?;
    file.as_file().sync_all().map_err(failed)?;
    file.persist(path).map_err(|refused| failed(refused.error))?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    folder.map_or(Ok(()), sync_folder)?;
    Ok(written)
}

/// Who writes a temporary file: this process, as `PID-MACHINE`.
pub(crate) static OWNER: LazyLock<String> = LazyLock::new(|| format!("{}-{}", std::process::id(), *MACHINE));

/// This machine since it was started, in a word. Process numbers mean nothing on another one that sees the same folder.
pub(crate) static MACHINE: LazyLock<String> = LazyLock::new(|| {
    let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id").unwrap_or_default();
    boot.chars().filter(char::is_ascii_hexdigit).take(12).collect()
});

/// The name of some bytes.
pub fn digest(bytes: &[u8]) -> ObjectId {
    ObjectId(*blake3::hash(bytes).as_bytes())
}

/// A value's bytes as JSON: keys stand in the order of the fields, so equal values give equal bytes.
///
/// # Errors
/// [`CatalogError::Json`] where JSON cannot hold the value, such as a map whose keys are no texts.
pub fn to_json(value: &impl Serialize) -> Result<Vec<u8>, CatalogError> {
    serde_json::to_vec(value).map_err(CatalogError::Json)
}

/// The name of a value: the digest of its JSON.
///
/// # Errors
/// As [`to_json`].
pub fn digest_of(value: &impl Serialize) -> Result<ObjectId, CatalogError> {
    Ok(digest(&to_json(value)?))
}

/// Writes a user's file whole or not at all: temp file beside it, fsync, rename, fsync folder.
///
/// # Errors
/// [`CatalogError::File`] where the disk refuses.
pub fn write_file(path: &Path, bytes: &[u8]) -> Result<(), CatalogError> {
    write_through(folder_of(path), path, bytes)
}

/// As [`write_file`], for what is too large to hold: `write` is given the temporary file, and gives what it likes.
///
/// # Errors
/// [`CatalogError::File`] where the disk refuses, and what `write` fails with; nothing is left in either case.
pub fn write_file_by<T, E: From<CatalogError>>(
    path: &Path,
    write: impl FnOnce(&mut File) -> Result<T, E>,
) -> Result<T, E> {
    write_through_by(folder_of(path), path, write)
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Renames `from` to `to`, making the folder if need be.
pub(crate) fn move_into_place(from: &Path, to: &Path) -> Result<(), CatalogError> {
    if let Some(folder) = to.parent() {
        fs::create_dir_all(folder).map_err(CatalogError::file("make folder", folder))?;
    }
    fs::rename(from, to).map_err(CatalogError::file("move into place", to))
}

/// Makes the names in a folder durable.
pub(crate) fn sync_folder(folder: &Path) -> Result<(), CatalogError> {
    File::open(folder).and_then(|file| file.sync_all()).map_err(CatalogError::file("fsync", folder))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    #[test]
    fn what_json_cannot_hold_has_no_name() {
        assert_eq!(digest_of(&("cell/2", 1.5)).unwrap(), digest(br#"["cell/2",1.5]"#));
        let unnamed = BTreeMap::from([([1, 2], "keys of JSON are texts")]);
        assert!(matches!(digest_of(&unnamed), Err(CatalogError::Json(_))));
    }
}
