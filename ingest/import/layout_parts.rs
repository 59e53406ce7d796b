//! The parts of a layout of loose images: where it begins, what becomes of its files, which images are pairs.

use super::calibration::image_size;
use super::error::ImportError;
use super::images::SideImages;
use super::paths::{file_of, files_of, missing};
use super::profile::{ImagesPart, Profile, SidePart};
use crate::folder::{ImageFile, PairFiles, UnpairedFile, pair_by_stamp};
use furrow_catalog::images::{BayerPattern, LookupTable};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The images of a dataset, in order of their stamps.
#[derive(Debug, Clone, PartialEq)]
pub enum LayoutImages {
    /// Of a pair of cameras: pairs, and images without a partner.
    Pairs(Vec<PairFiles>, Vec<UnpairedFile>),
    /// Of a single camera.
    Single(Vec<ImageFile>),
}

/// How a side's image files become pictures.
#[derive(Debug, Clone, Default)]
pub struct LayoutSide {
    /// The mosaic that they hold.
    pub bayer: Option<BayerPattern>,
    /// Where undistorted pixels come from.
    pub table: Option<Arc<LookupTable>>,
}

/// Where the layout begins.
pub(super) fn root_of(path: &Path, profile: &Profile, images: &ImagesPart) -> Result<PathBuf, ImportError> {
    if !path.is_dir() {
        let fault = "expected the dataset's folder: there is none, or it is a file";
        return Err(ImportError::file(path, fault));
    }
    let here = vec![".".to_owned()];
    let within = if profile.within.is_empty() { &here } else { &profile.within };
    let folder = |name: &String| if name == "." { path.to_owned() } else { path.join(name) };
    let mut roots = within.iter().map(folder);
    let found = roots.find(|root| !files_of(root, &images.left.files).is_empty());
    found.ok_or_else(|| {
        let wanted: Vec<String> = within
            .iter()
            .flat_map(|within| images.left.files.iter().map(move |file| (within, file)))
            .map(|(within, file)| if within == "." { file.clone() } else { format!("{within}/{file}") })
            .collect();
        missing(path, &wanted, "name the folder that holds them; `furrow import --list` tells the other layouts")
    })
}

/// Columns and rows of a side's first image.
pub(super) fn first_size(side: &SideImages) -> Result<[u32; 2], ImportError> {
    // No side is without images.
    side.images.values().next().map_or(Ok([0, 0]), |path| image_size(path))
}

/// How a side's files become pictures; the table's file is added to those that were read.
pub(super) fn layout_side(
    root: &Path,
    part: &SidePart,
    images: &SideImages,
    files: &mut Vec<PathBuf>,
) -> Result<LayoutSide, ImportError> {
    let table = match part.lookup_table.as_slice() {
        [] => None,
        names => {
            let advice = "the lens is told there: download the camera models of the dataset's tools into its folder";
            let file = file_of(root, 1, names).ok_or_else(|| missing(root, names, advice))?;
            let table = LookupTable::read(&file, first_size(images)?)
                .map_err(|fault| ImportError::File { path: file.clone(), fault })?;
            files.push(file);
            Some(Arc::new(table))
        }
    };
    Ok(LayoutSide { bayer: part.bayer, table })
}

/// The images of both sides in pairs, or those of the only one.
pub(super) fn paired(root: &Path, left: SideImages, right: Option<SideImages>) -> Result<LayoutImages, ImportError> {
    let Some(right) = right else {
        let image = |(stamp, path): (u64, PathBuf)| ImageFile { stamp_ns: stamp.cast_signed(), path };
        return Ok(LayoutImages::Single(left.images.into_iter().map(image).collect()));
    };
    let (pairs, unpaired) = pair_by_stamp(left.images, right.images);
    if pairs.is_empty() {
        let fault =
            format!("{} images, no left and right one within half a period of each other by stamp", unpaired.len());
        return Err(ImportError::file(root, fault));
    }
    Ok(LayoutImages::Pairs(pairs, unpaired))
}
