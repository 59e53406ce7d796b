//! A dataset of loose images as its profile lays it out: all that an ingest needs, found and checked.

use super::calibration::{Given, image_size, pair, single};
use super::error::ImportError;
use super::images::{SideImages, side_images};
use super::paths::{file_of, files_of, missing};
use super::profile::{ImagesPart, Profile, SidePart};
use super::sensors::{SensorSeries, read_sensor};
use super::truth::{ImportedTruth, read_truth};
use super::vpr::truth_of_places;
use crate::folder::{ImageFile, PairFiles, UnpairedFile, pair_by_stamp};
use furrow_catalog::images::{BayerPattern, LookupTable};
use furrow_catalog::records::Cameras;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A dataset of loose images.
#[derive(Debug, Clone)]
pub struct Layout {
    /// The profile's name.
    pub profile: String,
    /// The folder in which the layout begins.
    pub root: PathBuf,
    /// The images.
    pub images: LayoutImages,
    /// How the left images' files become pictures.
    pub left: LayoutSide,
    /// How the right images' files become pictures.
    pub right: LayoutSide,
    /// The cameras.
    pub cameras: Cameras,
    /// Tables of other sensors.
    pub sensors: Vec<SensorSeries>,
    /// True poses.
    pub truth: Option<ImportedTruth>,
    /// What was unusual, a sentence each.
    pub notes: Vec<String>,
    /// Every file that was or will be read, but for those of `--calibration` and the true poses.
    pub files: Vec<PathBuf>,
}

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

impl Layout {
    /// The stamps of the left images that make frames, nanoseconds, ascending.
    pub fn stamps_ns(&self) -> Vec<i64> {
        match &self.images {
            LayoutImages::Pairs(pairs, _) => pairs.iter().map(|pair| pair.stamp_ns).collect(),
            LayoutImages::Single(images) => images.iter().map(|image| image.stamp_ns).collect(),
        }
    }
}

/// Finds what a profile of loose images names below `path`. `calibration` and `field_of_view_deg` are the user's, in
/// place of the profile's.
///
/// # Errors
/// [`ImportError`] names what was looked for, the file and the line.
pub fn resolve_layout(
    name: &str,
    profile: &Profile,
    path: &Path,
    calibration: &[PathBuf],
    field_of_view_deg: Option<f64>,
) -> Result<Layout, ImportError> {
    let Some(images) = &profile.images else {
        return Err(ImportError::file(path, format!("profile {name} is for bags, not for loose images")));
    };
    let root = root_of(path, profile, images)?;
    let left = side_images(&root, &images.left)?;
    let right = images.right.as_ref().map(|right| side_images(&root, right)).transpose()?;
    let given = Given { files: calibration, field_of_view_deg };
    let (cameras, calibration_files) = match &right {
        Some(right) => pair(&root, profile.calibration.as_ref(), given, [first_size(&left)?, first_size(right)?])?,
        None => single(&root, profile.calibration.as_ref(), given, first_size(&left)?)?,
    };
    let mut files: Vec<PathBuf> = left.images.values().chain(&left.lists).cloned().collect();
    files.extend(right.iter().flat_map(|right| right.images.values().chain(&right.lists)).cloned());
    files.extend(calibration_files.into_iter().filter(|file| !calibration.contains(file)));
    let left_side = layout_side(&root, &images.left, &left, &mut files)?;
    let right_side = match (&images.right, &right) {
        (Some(part), Some(images)) => layout_side(&root, part, images, &mut files)?,
        _ => LayoutSide::default(),
    };
    let mut sensors = Vec::new();
    for part in &profile.sensors {
        if let Some((series, read)) = read_sensor(&root, part)? {
            sensors.push(series);
            files.extend(read);
        }
    }
    let truth = match &profile.truth {
        Some(part) if part.place_names => Some(truth_of_places(&root, &left.images)?),
        Some(part) => read_truth(&root, part, &left.numbers)?,
        None => None,
    };
    files.sort();
    files.dedup();
    let notes = left.notes.iter().chain(right.iter().flat_map(|right| &right.notes)).cloned().collect();
    let images = paired(&root, left, right)?;
    let profile = name.to_owned();
    Ok(Layout { profile, root, images, left: left_side, right: right_side, cameras, sensors, truth, notes, files })
}

/// Where the layout begins.
fn root_of(path: &Path, profile: &Profile, images: &ImagesPart) -> Result<PathBuf, ImportError> {
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

fn first_size(side: &SideImages) -> Result<[u32; 2], ImportError> {
    // No side is without images.
    side.images.values().next().map_or(Ok([0, 0]), |path| image_size(path))
}

fn layout_side(
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

fn paired(root: &Path, left: SideImages, right: Option<SideImages>) -> Result<LayoutImages, ImportError> {
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
