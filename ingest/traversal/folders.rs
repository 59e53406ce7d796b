//! What kind of recording a folder is.

use crate::folder::holds_pairs;
use crate::recording::is_recording_folder;
use crate::traversal::error::IngestError;
use std::fs;
use std::path::{Path, PathBuf};

/// Whether a folder is a rosbag2 recording rather than loose images. One without `metadata.yaml` may be either: images
/// count more.
pub(crate) fn holds_recording(folder: &Path) -> bool {
    folder.join("metadata.yaml").is_file()
        || (is_recording_folder(folder)
            && !holds_pairs(folder).unwrap_or(false)
            && files_with(folder, &["jpg", "jpeg", "png", "pgm", "ppm"]).is_empty())
}

/// What to say of a folder of ROS1 bags, which is neither: its recordings lie inside.
pub(crate) fn bags_inside(folder: &Path) -> Option<IngestError> {
    let bags = files_with(folder, &["bag"]);
    let is_other = holds_pairs(folder).unwrap_or(false) || !files_with(folder, &["jpg", "jpeg", "png"]).is_empty();
    let first = bags.first().filter(|_| !is_other)?;
    let inside = match bags.len() {
        1 => format!("the recording is inside: ingest {}", first.display()),
        count => format!(
            "{count} bags are inside: ingest each, as {}, or name together those that are parts of one drive",
            first.display()
        ),
    };
    Some(IngestError::Request(format!("{} is a folder that holds no images; {inside}", folder.display())))
}

/// The files in a folder with one of these suffixes, in the order of their names; none where it cannot be read.
fn files_with(folder: &Path, suffixes: &[&str]) -> Vec<PathBuf> {
    let is_wanted = |path: &PathBuf| {
        let suffix = path.extension().map(|suffix| suffix.to_string_lossy().to_lowercase());
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        !is_hidden && suffix.is_some_and(|suffix| suffixes.contains(&suffix.as_str())) && path.is_file()
    };
    let entries = fs::read_dir(folder).map(|entries| entries.flatten().map(|entry| entry.path()).filter(is_wanted));
    let mut files: Vec<PathBuf> = entries.map(Iterator::collect).unwrap_or_default();
    files.sort();
    files
}
