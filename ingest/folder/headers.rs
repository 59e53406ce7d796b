//! What the images of a folder say of themselves: their size, and how much of 16-bit pixels they use.

use super::error::FolderError;
use super::layout::IMAGES;
use furrow_catalog::images::{Depth, LoosePixels, SeenPixels};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Columns and rows of the first image whose header can be read. One that cannot costs its frame later.
///
/// # Errors
/// Where no header can be read: what is wrong with the first image.
pub(super) fn first_size(folder: &Path, images: &BTreeMap<u64, PathBuf>) -> Result<[u32; 2], FolderError> {
    let mut fault = None;
    for path in images.values() {
        match size_of(path) {
            Ok(size) => return Ok(size),
            Err(error) => fault = fault.or(Some(error)),
        }
    }
    Err(fault.unwrap_or_else(|| FolderError::missing(folder, IMAGES.to_owned(), &[])))
}

/// Columns and rows that all images have whose headers can be read.
///
/// # Errors
/// As [`first_size`]; where two images have unlike sizes.
pub(super) fn common_size(folder: &Path, images: &BTreeMap<u64, PathBuf>) -> Result<[u32; 2], FolderError> {
    let expected = first_size(folder, images)?;
    let mut first = None;
    for path in images.values() {
        let Ok(found) = size_of(path) else { continue };
        let first = *first.get_or_insert(path);
        if found != expected {
            return Err(FolderError::Size { path: path.clone(), found, first: first.clone(), expected });
        }
    }
    Ok(expected)
}

/// How many bits of 16-bit pixels these images use: every one is looked at, until one needs all of them. Images of 8
/// bits are told by the first one of a side.
///
/// # Errors
/// Where a file cannot be read.
pub(super) fn depth_of(sides: &[&BTreeMap<u64, PathBuf>]) -> Result<Depth, FolderError> {
    let mut seen = SeenPixels::default();
    for images in sides {
        for (i, path) in images.values().enumerate() {
            let bytes = fs::read(path).map_err(FolderError::unreadable(path))?;
            match LoosePixels::of_file(&bytes) {
                Ok(Some(pixels)) if pixels.is_deep() => seen.add_image(&pixels.as_raw()),
                Ok(_) if i == 0 => break,
                _ => {}
            }
            if seen.is_decided() {
                return Ok(seen.depth());
            }
        }
    }
    Ok(seen.depth())
}

fn size_of(path: &Path) -> Result<[u32; 2], FolderError> {
    let bytes = fs::read(path).map_err(FolderError::unreadable(path))?;
    let size = LoosePixels::size_of_file(&bytes);
    size.map(<[u32; 2]>::from).map_err(|source| FolderError::Image { path: path.to_owned(), source })
}
