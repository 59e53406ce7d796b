//! How folders of images are laid out: the names of subfolders and files.

use super::error::FolderError;
use super::natural::natural_order;
use std::fs;
use std::path::{Path, PathBuf};

/// Names of left and right image folders, with the numbers of their cameras in a KITTI `calib.txt`.
pub(super) const FOLDER_PAIRS: [(&str, &str, [u8; 2]); 4] = [
    ("image_0", "image_1", [0, 1]),
    ("image_2", "image_3", [2, 3]),
    ("image_l", "image_r", [0, 1]),
    ("left", "right", [0, 1]),
];

/// The extensions of image files that are read, in any case of their letters.
const EXTENSIONS: [&str; 6] = ["jpg", "jpeg", "png", "pgm", "ppm", "pnm"];
/// What errors call them.
pub(super) const IMAGES: &str = "JPEG, PNG, PGM or PPM images";

/// The interval of frames without times: KITTI's nominal 10 Hz.
pub const NOMINAL_INTERVAL_NS: i64 = 100_000_000;

/// Whether a folder holds left and right images, as far as its names tell.
///
/// # Errors
/// Where it cannot be read.
pub fn holds_pairs(folder: &Path) -> Result<bool, FolderError> {
    let names = names_in(folder)?;
    Ok(pair_among(&names).is_some())
}

/// The subfolders of the left and right images among `names`, and the numbers of their cameras. `Left` and `Right` are
/// as good as `left` and `right`, where there is no choice.
pub(super) fn pair_among(names: &[String]) -> Option<(&str, &str, [u8; 2])> {
    let pair = |(left, right, cameras)| Some((find_folder(names, left)?, find_folder(names, right)?, cameras));
    FOLDER_PAIRS.into_iter().find_map(pair)
}

/// A name among `names`, in any case of its letters; spelt as it is wanted where there are several.
pub(super) fn find_folder<'a>(names: &'a [String], wanted: &str) -> Option<&'a str> {
    let alike = || names.iter().find(|name| name.eq_ignore_ascii_case(wanted));
    names.iter().find(|name| *name == wanted).or_else(alike).map(String::as_str)
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

/// Image files that are read, in the order in which people count their names. Hidden files are none: other systems
/// leave `._NAME.jpg` beside every image.
pub(crate) fn images_in(folder: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let is_image = |path: &PathBuf| {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        extension.is_some_and(|extension| EXTENSIONS.contains(&extension.as_str()))
    };
    let mut names = names_in(folder)?;
    names.retain(|name| !name.starts_with('.'));
    names.sort_by(|a, b| natural_order(a, b));
    Ok(names.into_iter().map(|name| folder.join(name)).filter(is_image).collect())
}
