//! What kind of recording a folder is.

use crate::folder::{holds_pairs, images_in};
use crate::recording::is_recording_folder;
use crate::traversal::error::IngestError;
use std::fs;
use std::path::{Path, PathBuf};

/// Whether a folder is a rosbag2 recording rather than loose images. One without `metadata.yaml` may be either: images
/// count more.
pub(crate) fn holds_recording(folder: &Path) -> bool {
    folder.join("metadata.yaml").is_file() || (is_recording_folder(folder) && !holds_images(folder))
}

/// Whether a folder holds images, in itself or in folders of a left and a right camera.
fn holds_images(folder: &Path) -> bool {
    holds_pairs(folder).unwrap_or(false) || images_in(folder).is_ok_and(|images| !images.is_empty())
}

/// What to say of a folder of ROS1 bags, which is neither: its recordings lie inside.
pub(crate) fn bags_inside(folder: &Path) -> Option<IngestError> {
    let bags = bags_in(folder);
    let first = bags.first().filter(|_| !holds_images(folder))?;
    let inside = match bags.len() {
        1 => format!("the recording is inside: ingest {}", first.display()),
        count => format!(
            "{count} bags are inside: ingest each, as {}, or name together those that are parts of one drive",
            first.display()
        ),
    };
    Some(IngestError::Request(format!("{} is a folder that holds no images; {inside}", folder.display())))
}

/// The ROS1 bags in a folder, in the order of their names; none where it cannot be read.
fn bags_in(folder: &Path) -> Vec<PathBuf> {
    let is_bag = |path: &PathBuf| {
        let is_hidden = path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
        !is_hidden && path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("bag")) && path.is_file()
    };
    let entries = fs::read_dir(folder).map(|entries| entries.flatten().map(|entry| entry.path()).filter(is_bag));
    let mut bags: Vec<PathBuf> = entries.map(Iterator::collect).unwrap_or_default();
    bags.sort();
    bags
}
