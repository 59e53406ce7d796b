//! Where golden numbers and real recordings lie. Included by the golden tests of several crates with `#[path]`.

use std::path::{Path, PathBuf};

/// The workspace's root: the nearest folder upwards that holds Cargo.lock.
fn workspace() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().find(|dir| dir.join("Cargo.lock").exists()).unwrap_or(here).to_owned()
}

fn folder(variable: &str, default: &str) -> Option<PathBuf> {
    let path = std::env::var_os(variable).map_or_else(|| workspace().join(default), PathBuf::from);
    if path.is_dir() {
        return Some(path);
    }
    eprintln!("SKIPPED: {} is no folder; set {variable} to one", path.display());
    None
}

/// The folder of golden numbers: `FURROW_GOLDEN`, else `../shared/golden`. Says on stderr when there is none.
#[allow(dead_code, reason = "each including test uses its part")]
pub fn golden() -> Option<PathBuf> {
    folder("FURROW_GOLDEN", "../shared/golden")
}

/// The folder of real recordings: `FURROW_DATA`, else `../shared/data`. Says on stderr when there is none.
#[allow(dead_code, reason = "each including test uses its part")]
pub fn data() -> Option<PathBuf> {
    folder("FURROW_DATA", "../shared/data")
}

/// Every file below `folder`, sorted by path. Sets are recognised by the form of their files, so tests search rather
/// than name them.
#[allow(dead_code, reason = "each including test uses its part")]
pub fn files_below(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(dir) = folders.pop() {
        for entry in std::fs::read_dir(&dir).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() { folders.push(path) } else { files.push(path) }
        }
    }
    files.sort();
    files
}

/// A folder of the real recordings. Says on stderr when it is absent.
#[allow(dead_code, reason = "each including test uses its part")]
pub fn data_folder(name: &str) -> Option<PathBuf> {
    let folder = data()?.join(name);
    if folder.is_dir() {
        return Some(folder);
    }
    eprintln!("SKIPPED: no {name}");
    None
}
