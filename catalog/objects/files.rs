//! Files written whole or not at all: temp file, fsync, rename, fsync of the folder.

use crate::CatalogError;
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;
use std::sync::LazyLock;

/// Temp file in `folder`, fsync, rename, fsync of the folder it comes to lie in. A killed process' file is known by its
/// number.
pub(super) fn write_through(folder: &Path, path: &Path, bytes: &[u8]) -> Result<(), CatalogError> {
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
