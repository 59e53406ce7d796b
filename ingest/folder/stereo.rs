//! Folders of stereo pairs.

use super::calibration::read_pair;
use super::error::FolderError;
use super::layout::{FOLDER_PAIRS, images_in, names_in, pair_among};
use super::times::Clock;
use furrow_catalog::images::{Side, StereoCalibration};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A folder of stereo images that was opened; no pixel has been read yet.
#[derive(Debug, Clone, PartialEq)]
pub struct StereoFolder {
    /// The calibration of its images, which are rectified.
    pub calibration: StereoCalibration,
    /// The pairs, in order of their stamps.
    pub pairs: Vec<PairFiles>,
    /// Images without a partner, in order of their stamps.
    pub unpaired: Vec<UnpairedFile>,
    /// False where stamps are nominal ([`NOMINAL_INTERVAL_NS`](super::NOMINAL_INTERVAL_NS)) because the folder has no
    /// times.
    pub stamps_are_recorded: bool,
}

/// A left and a right image of one moment.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PairFiles {
    /// When.
    pub stamp_ns: i64,
    /// The left image's file.
    pub left: PathBuf,
    /// The right image's file.
    pub right: PathBuf,
}

/// An image whose partner is missing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnpairedFile {
    /// When.
    pub stamp_ns: i64,
    /// Which side *is* there.
    pub side: Side,
    /// Its file.
    pub path: PathBuf,
}

impl StereoFolder {
    /// Reads a folder's calibration, file names and times. The calibration is that of the files that are given, of
    /// which there are one or two, else that of the folder.
    ///
    /// # Errors
    /// Where a part of the layout is missing or unreadable. The error names what was looked for and what is there.
    pub fn open(folder: &Path, calibration: &[PathBuf]) -> Result<Self, FolderError> {
        let names = names_in(folder)?;
        let (left_name, right_name, cameras) = image_folders(folder, &names)?;
        let mut left = images_by_number(&folder.join(left_name))?;
        let mut right = images_by_number(&folder.join(right_name))?;
        let calibration = read_pair(folder, &names, cameras, &left, &right, calibration)?;
        let clock = Clock::of(folder, &names, left.keys().chain(right.keys()))?;

        let mut pairs = Vec::new();
        let mut unpaired = Vec::new();
        let numbers: Vec<u64> = left.keys().chain(right.keys()).copied().collect();
        for number in numbers {
            let stamp_ns = clock.stamp_ns(number);
            match (left.remove(&number), right.remove(&number)) {
                (Some(left), Some(right)) => pairs.push(PairFiles { stamp_ns, left, right }),
                (Some(path), None) => unpaired.push(UnpairedFile { stamp_ns, side: Side::Left, path }),
                (None, Some(path)) => unpaired.push(UnpairedFile { stamp_ns, side: Side::Right, path }),
                (None, None) => {}
            }
        }
        if pairs.is_empty() {
            return Err(FolderError::Missing {
                folder: folder.to_owned(),
                wanted: format!("images of the same names in {left_name} and {right_name}"),
                found: format!("{} images without a partner", unpaired.len()),
            });
        }
        pairs.sort_by_key(|pair| pair.stamp_ns);
        unpaired.sort_by_key(|image| (image.stamp_ns, image.side));
        Ok(Self { calibration, pairs, unpaired, stamps_are_recorded: clock.is_recorded() })
    }
}

/// The subfolders of the left and right images, and the numbers of their cameras.
fn image_folders(folder: &Path, names: &[String]) -> Result<(&'static str, &'static str, [u8; 2]), FolderError> {
    pair_among(names).ok_or_else(|| {
        let pairs = FOLDER_PAIRS.map(|(left, right, _)| format!("{left} and {right}"));
        FolderError::missing(folder, format!("folders {}", pairs.join(", or ")), names)
    })
}

/// JPEG and PNG files by the number that they are named by.
fn images_by_number(folder: &Path) -> Result<BTreeMap<u64, PathBuf>, FolderError> {
    let mut images = BTreeMap::new();
    for path in images_in(folder)? {
        let number = path.file_stem().and_then(|stem| stem.to_str()?.parse::<u64>().ok());
        let number = number.filter(|&number| i64::try_from(number).is_ok());
        let number = number.ok_or_else(|| FolderError::Name { path: path.clone() })?;
        if let Some(first) = images.insert(number, path.clone()) {
            return Err(FolderError::Twice { first, second: path });
        }
    }
    if images.is_empty() {
        return Err(FolderError::missing(folder, "JPEG or PNG images".to_owned(), &names_in(folder)?));
    }
    Ok(images)
}
