//! Files that a profile names, below a dataset's folder.

use super::error::ImportError;
use crate::folder::names_of_folder;
use std::path::{Path, PathBuf};

/// The files of the first pattern that has any, in the order in which people count their names; none where none has.
pub(super) fn files_of(root: &Path, patterns: &[String]) -> Vec<PathBuf> {
    patterns.iter().map(|pattern| files_of_pattern(root, pattern)).find(|files| !files.is_empty()).unwrap_or_default()
}

/// The first of the files that is there, below `root` or up to `above` folders above it.
pub(super) fn file_of(root: &Path, above: u8, patterns: &[String]) -> Option<PathBuf> {
    folders(root, above).iter().find_map(|folder| files_of(folder, patterns).into_iter().next())
}

/// A dataset's folder and so many above it.
pub(super) fn folders(root: &Path, above: u8) -> Vec<PathBuf> {
    // The folders above `.` have no name until the path is whole.
    let whole = root.canonicalize().unwrap_or_else(|_| root.to_owned());
    let higher = whole.ancestors().skip(1).take(usize::from(above)).map(Path::to_owned);
    std::iter::once(root.to_owned()).chain(higher).collect()
}

/// What a profile names and is not there.
pub(super) fn missing(root: &Path, wanted: &[String], advice: &str) -> ImportError {
    let found = names_of_folder(root).map(|names| names.join(", ")).unwrap_or_default();
    ImportError::Missing {
        folder: root.to_owned(),
        wanted: wanted.join(" or "),
        found: if found.is_empty() { "nothing".to_owned() } else { found.chars().take(300).collect() },
        advice: advice.to_owned(),
    }
}

/// The files that a pattern names; hidden ones are none.
pub(super) fn files_of_pattern(root: &Path, pattern: &str) -> Vec<PathBuf> {
    let (folder, last) = pattern.rsplit_once('/').unwrap_or(("", pattern));
    let folder = if folder.is_empty() { root.to_owned() } else { root.join(folder) };
    let Some((before, behind)) = last.split_once('*') else {
        let file = folder.join(last);
        return if file.is_file() { vec![file] } else { Vec::new() };
    };
    let behind = behind.to_lowercase();
    let fits = |name: &String| {
        let is_long = name.len() >= before.len() + behind.len();
        is_long && name.starts_with(before) && name.to_lowercase().ends_with(&behind) && !name.starts_with('.')
    };
    let names = names_of_folder(&folder).unwrap_or_default();
    names.into_iter().filter(fits).map(|name| folder.join(name)).filter(|path| path.is_file()).collect()
}
