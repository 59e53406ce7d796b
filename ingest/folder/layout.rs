//! How folders of images are laid out: the names of subfolders and files.

use super::error::FolderError;
use std::fs;
use std::path::{Path, PathBuf};

/// Names of left and right image folders, with the numbers of their cameras in a KITTI `calib.txt`.
pub(super) const FOLDER_PAIRS: [(&str, &str, [u8; 2]); 4] = [
    ("image_0", "image_1", [0, 1]),
    ("image_2", "image_3", [2, 3]),
    ("image_l", "image_r", [0, 1]),
    ("left", "right", [0, 1]),
];

/// The interval of frames without times: KITTI's nominal 10 Hz.
pub const NOMINAL_INTERVAL_NS: i64 = 100_000_000;

/// Names of this many digits are stamps in nanoseconds; shorter ones are frame numbers.
pub(super) const STAMP_DIGITS: usize = 16;

/// Whether a folder holds left and right images, as far as its names tell.
///
/// # Errors
/// Where it cannot be read.
pub fn holds_pairs(folder: &Path) -> Result<bool, FolderError> {
    let names = names_in(folder)?;
    Ok(pair_among(&names).is_some())
}

/// The subfolders of the left and right images among `names`, and the numbers of their cameras.
pub(super) fn pair_among(names: &[String]) -> Option<(&'static str, &'static str, [u8; 2])> {
    let has = |name: &str| names.iter().any(|other| other == name);
    FOLDER_PAIRS.into_iter().find(|(left, right, _)| has(left) && has(right))
}

/// The names in a folder, sorted.
pub(super) fn names_in(folder: &Path) -> Result<Vec<String>, FolderError> {
    let unreadable = FolderError::unreadable(folder);
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(&unreadable)? {
        names.push(entry.map_err(&unreadable)?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

/// JPEG and PNG files, in the order of their names.
pub(super) fn images_in(folder: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let is_image = |path: &PathBuf| {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        matches!(extension.as_deref(), Some("jpg" | "jpeg" | "png"))
    };
    Ok(names_in(folder)?.into_iter().map(|name| folder.join(name)).filter(is_image).collect())
}
