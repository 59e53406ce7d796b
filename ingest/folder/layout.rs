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

/// The names in a folder, in the order in which people count them; `None` where it cannot be read.
pub(crate) fn names_of_folder(folder: &Path) -> Option<Vec<String>> {
    let mut names = names_in(folder).ok()?;
    names.sort_by(|a, b| natural_order(a, b));
    Some(names)
}

/// Image files that are read, in the order in which people count their names. Hidden files are none: other systems
/// leave `._NAME.jpg` beside every image.
pub(crate) fn images_in(folder: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let unreadable = FolderError::unreadable(folder);
    let mut images = Vec::new();
    for entry in fs::read_dir(folder).map_err(&unreadable)? {
        let path = entry.map_err(&unreadable)?.path();
        // A name may have bytes that are no UTF-8: the path keeps them.
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let is_image = extension.is_some_and(|extension| EXTENSIONS.contains(&extension.as_str()));
        if is_image && !name.starts_with('.') {
            images.push((name, path));
        }
    }
    images.sort_by(|(a, one), (b, other)| natural_order(a, b).then_with(|| one.cmp(other)));
    Ok(images.into_iter().map(|(_, path)| path).collect())
}
