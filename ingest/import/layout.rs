//! A dataset of loose images as its profile lays it out: all that an ingest needs, found and checked.

use super::calibration::{Given, pair, single};
use super::error::ImportError;
use super::images::side_images;
pub use super::layout_parts::{LayoutImages, LayoutSide};
use super::layout_parts::{first_size, layout_side, paired, root_of};
use super::profile::Profile;
use super::sensors::{SensorSeries, read_sensor};
use super::truth::{ImportedTruth, read_truth};
use super::vpr::truth_of_places;
use furrow_catalog::records::Cameras;
use std::path::{Path, PathBuf};

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
