//! The report of a real run: its page, used as people use it, and the files that it is exported as.

mod files;
mod hostile_names;
mod page;
mod printed;

use crate::support::browser::View;
use crate::support::command::{Quoted, quoted};
use crate::support::recordings::ran;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

const WIDE: View = View { width: 1280, dark: false };

/// The page of the small matrix's run, made once.
fn page() -> Quoted {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let folder = FOLDER.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        ran().store.json(format!("report latest -o {}", quoted(folder.path().join("page.html"))));
        folder
    });
    quoted(folder.path().join("page.html"))
}

/// The address of a file. The space in a store's name is no character of an address.
fn url(file: &Path) -> String {
    format!("file://{}", file.to_str().unwrap().replace(' ', "%20"))
}

/// The files of a folder with an ending, of which there must be some.
fn files_in(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|found| found == ending));
    files.sort();
    assert!(!files.is_empty(), "{} holds no .{ending}", folder.display());
    files
}
