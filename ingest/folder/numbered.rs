//! Images by what their names say.

use super::error::FolderError;
use super::layout::{IMAGES, images_in, names_in};
use super::names::{Named, read_names};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A folder's images by frame number, or by stamp in nanoseconds.
#[derive(Debug)]
pub(super) struct Numbered {
    /// The images.
    pub(super) images: BTreeMap<u64, PathBuf>,
    /// Whether they are named by stamps.
    pub(super) are_stamps: bool,
}

impl Numbered {
    /// The image files in a folder.
    ///
    /// # Errors
    /// Where there are none, or names are not understood, or two say the same.
    pub(super) fn read(folder: &Path) -> Result<Self, FolderError> {
        let files = images_in(folder)?;
        if files.is_empty() {
            return Err(FolderError::missing(folder, IMAGES.to_owned(), &names_in(folder)?));
        }
        Self::of(files)
    }

    /// These files.
    pub(super) fn of(files: Vec<PathBuf>) -> Result<Self, FolderError> {
        let named = read_files(&files)?;
        let (numbers, are_stamps): (Vec<u64>, bool) = match named {
            Named::Frames(numbers) => (numbers, false),
            // No stamp of a name is negative.
            Named::Stamps(stamps) => (stamps.into_iter().map(i64::cast_unsigned).collect(), true),
        };
        let mut images = BTreeMap::new();
        for (number, path) in numbers.into_iter().zip(files) {
            if let Some(first) = images.insert(number, path.clone()) {
                return Err(FolderError::Twice { first, second: path });
            }
        }
        Ok(Self { images, are_stamps })
    }
}

/// The stamps that files are named by, in nanoseconds, in their order.
///
/// # Errors
/// Names that are not understood, or are frame numbers.
pub(crate) fn stamps_of_names(files: &[PathBuf]) -> Result<Vec<i64>, FolderError> {
    let numbers = read_files(files)?;
    match (numbers, files.first()) {
        (Named::Frames(_), Some(path)) => {
            let fault = "its name is a frame number, where the profile expects a stamp".to_owned();
            Err(FolderError::Name { path: path.clone(), fault })
        }
        (Named::Frames(_), None) => Ok(Vec::new()),
        (Named::Stamps(stamps), _) => Ok(stamps),
    }
}

/// The frame numbers that files are named by, in their order.
///
/// # Errors
/// Names that are not understood, or are stamps.
pub(crate) fn numbers_of_names(files: &[PathBuf]) -> Result<Vec<u64>, FolderError> {
    let numbers = read_files(files)?;
    match (numbers, files.first()) {
        (Named::Stamps(_), Some(path)) => {
            let fault = "its name is a stamp, where the profile expects a frame number".to_owned();
            Err(FolderError::Name { path: path.clone(), fault })
        }
        (Named::Stamps(_), None) => Ok(Vec::new()),
        (Named::Frames(numbers), _) => Ok(numbers),
    }
}

/// What the names of files say, read together.
fn read_files(files: &[PathBuf]) -> Result<Named, FolderError> {
    let stems: Vec<String> = files.iter().map(|path| stem(path)).collect();
    let stems: Vec<&str> = stems.iter().map(String::as_str).collect();
    read_names(&stems).map_err(|fault| FolderError::Name { path: files[fault.at].clone(), fault: fault.fault })
}

/// A file's name without its extension.
pub(super) fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}
