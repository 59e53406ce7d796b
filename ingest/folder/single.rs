//! Folders with the images of a single camera.

use super::calibration::read_single;
use super::error::FolderError;
use super::headers::{common_size, depth_of};
use super::layout::{FOLDER_PAIRS, IMAGES, find_folder, images_in, names_in};
use super::numbered::{Numbered, stem};
use super::times::Clock;
use furrow_catalog::images::{Depth, SingleCamera};
use std::path::{Path, PathBuf};

/// The horizontal field of view that is assumed of a camera without calibration, degrees: between that of phones and of
/// wide lenses.
pub const ASSUMED_FIELD_OF_VIEW_DEG: f64 = 60.0;

/// A folder of single images that was opened. Their headers were read, no pixel yet.
///
/// Images lie in the folder itself, or in a subfolder named as those of left images are (`left`, `image_0` …). Images
/// named by stamps or by numbers are in their order. Where some have other names, all are numbered from 0 in the order
/// in which people count their names: frame2 before frame10.
#[derive(Debug, Clone, PartialEq)]
pub struct SingleFolder {
    /// The camera: from `calibration.json` or `calib.txt`, else assumed.
    pub camera: SingleCamera,
    /// The images, in order of their stamps.
    pub images: Vec<ImageFile>,
    /// How many bits of 16-bit pixels they use.
    pub depth: Depth,
    /// False where stamps are nominal ([`NOMINAL_INTERVAL_NS`](super::NOMINAL_INTERVAL_NS)) because the folder has no
    /// times.
    pub stamps_are_recorded: bool,
}

/// An image of a single camera.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ImageFile {
    /// When.
    pub stamp_ns: i64,
    /// Its file.
    pub path: PathBuf,
}

impl SingleFolder {
    /// Reads a folder's file names, image headers, calibration and times. The calibration is that of the file that is
    /// given, else that of the folder. `field_of_view_deg` is assumed where there is none, and refused where there is
    /// one.
    ///
    /// # Errors
    /// Where there are no images, or images of several sizes; where a calibration or times cannot be read.
    pub fn open(folder: &Path, field_of_view_deg: Option<f64>, calibration: &[PathBuf]) -> Result<Self, FolderError> {
        let names = names_in(folder)?;
        let (within, cameras) = image_folder(folder, &names)?;
        let numbered = by_number_or_name(images_in(&within)?)?;
        let [width, height] = common_size(&within, &numbered.images)?;
        let depth = depth_of(&[&numbered.images])?;
        let camera = match read_single(folder, &names, cameras, [width, height], calibration)? {
            Some(camera) if field_of_view_deg.is_none() => camera,
            Some(_) => return Err(FolderError::CalibratedAlready { folder: folder.to_owned() }),
            None => {
                let field_of_view_deg = field_of_view_deg.unwrap_or(ASSUMED_FIELD_OF_VIEW_DEG);
                SingleCamera::assumed(width, height, field_of_view_deg)
                    .map_err(|source| FolderError::Camera { folder: folder.to_owned(), source: Box::new(source) })?
            }
        };
        let clock = Clock::of(folder, &names, [&numbered])?;
        let image = |(number, path)| ImageFile { stamp_ns: clock.stamp_ns(number), path };
        let mut images: Vec<ImageFile> = numbered.images.into_iter().map(image).collect();
        images.sort_by_key(|image| image.stamp_ns);
        Ok(Self { camera, images, depth, stamps_are_recorded: clock.is_recorded() })
    }
}

/// The folder with the images, and the number of its camera in a KITTI `calib.txt`.
fn image_folder(folder: &Path, names: &[String]) -> Result<(PathBuf, [u8; 2]), FolderError> {
    if !images_in(folder)?.is_empty() {
        return Ok((folder.to_owned(), [0, 1]));
    }
    let left = FOLDER_PAIRS.iter().find_map(|(left, _, cameras)| Some((find_folder(names, left)?, cameras)));
    let looked_for = || {
        let lefts = FOLDER_PAIRS.map(|(left, _, _)| left).join(", ");
        FolderError::missing(folder, format!("{IMAGES}, or one of the folders {lefts}"), names)
    };
    let (left, cameras) = left.ok_or_else(looked_for)?;
    Ok((folder.join(left), *cameras))
}

/// Images by the stamps or the numbers that they are named by, else counted in the order of their names.
fn by_number_or_name(files: Vec<PathBuf>) -> Result<Numbered, FolderError> {
    let are_numbers = files.iter().all(|path| stem(path).bytes().all(|byte| byte.is_ascii_digit()));
    match Numbered::of(files.clone()) {
        // Two files may have one number (1.png and 01.png): their names tell them apart.
        Ok(numbered) if numbered.are_stamps || are_numbers => Ok(numbered),
        Err(error @ FolderError::Name { .. }) if are_numbers => Err(error),
        _ => Ok(Numbered { images: (0..).zip(files).collect(), are_stamps: false }),
    }
}
