//! Image folders: rectified stereo pairs, or the images of a single camera ([`SingleFolder`]), as loose files.
//!
//! Two layouts of pairs are known, told apart by their calibration file:
//! - KITTI odometry: `calib.txt`, images named by frame number, `times.txt` with one time in seconds per frame; without it, frames are
//!   taken to be 0.1 s apart, from 0;
//! - `calibration.json` (width, height, fx, fy, cx, cy, baseline_m), images named by their stamp in nanoseconds.

mod calibration;
mod single;
mod times;

pub use single::{ASSUMED_FIELD_OF_VIEW_DEG, ImageFile, SingleFolder};

use furrow_catalog::images::{CalibrationError, CalibrationFileError, ImageError, Side, StereoCalibration};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Names of left and right image folders, with the numbers of their cameras in a KITTI `calib.txt`.
const FOLDER_PAIRS: [(&str, &str, [u8; 2]); 4] = [
    ("image_0", "image_1", [0, 1]),
    ("image_2", "image_3", [2, 3]),
    ("image_l", "image_r", [0, 1]),
    ("left", "right", [0, 1]),
];

/// The interval of frames whose times are unknown: KITTI's nominal 10 Hz.
pub const NOMINAL_INTERVAL_NS: i64 = 100_000_000;

/// Names of this many digits are stamps in nanoseconds; shorter ones are frame numbers.
const STAMP_DIGITS: usize = 16;

/// A folder of stereo images that was opened; no pixel has been read yet.
#[derive(Debug, Clone, PartialEq)]
pub struct StereoFolder {
    /// The calibration of its images, which are rectified.
    pub calibration: StereoCalibration,
    /// The pairs, in order of their stamps.
    pub pairs: Vec<PairFiles>,
    /// Images without a partner, in order of their stamps.
    pub unpaired: Vec<UnpairedFile>,
    /// False where stamps are nominal ([`NOMINAL_INTERVAL_NS`]) because the folder has no times.
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

/// A folder that holds no images in a known layout.
#[derive(Debug, thiserror::Error)]
pub enum FolderError {
    /// A folder or file that cannot be read.
    #[error("cannot read {path}: {source}")]
    Unreadable {
        /// Which.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// Something that a layout needs is missing.
    #[error("{folder} holds no images in a known layout: looked for {wanted}, found {found}")]
    Missing {
        /// The folder.
        folder: PathBuf,
        /// What was looked for.
        wanted: String,
        /// The names that are there.
        found: String,
    },
    /// An image whose name is neither a frame number nor a stamp.
    #[error("{path}: expected a file named by a frame number (000000) or by a stamp in nanoseconds")]
    Name {
        /// The file.
        path: PathBuf,
    },
    /// Two files for one frame.
    #[error("{first} and {second} are the same frame; keep one of them")]
    Twice {
        /// One file.
        first: PathBuf,
        /// The other.
        second: PathBuf,
    },
    /// A `times.txt` that does not fit.
    #[error("{path}: {fault}")]
    Times {
        /// The file.
        path: PathBuf,
        /// What is wrong, what was expected.
        fault: String,
    },
    /// A calibration that cannot be read.
    #[error(transparent)]
    Calibration(#[from] CalibrationFileError),
    /// A `calibration.json` of another shape.
    #[error("{path} is no calibration: {source}")]
    Json {
        /// The file.
        path: PathBuf,
        /// The parser's words.
        source: serde_json::Error,
    },
    /// Images of several sizes, which no one camera took.
    #[error(
        "{path} is {}x{} px, but {first} is {}x{}: expected images of one camera, all of one size", .found[0], .found[1], .expected[0], .expected[1]
    )]
    Size {
        /// The image that differs.
        path: PathBuf,
        /// Its columns and rows.
        found: [u32; 2],
        /// The first image.
        first: PathBuf,
        /// Its columns and rows.
        expected: [u32; 2],
    },
    /// A field of view was to be assumed of a camera that is known.
    #[error("{folder} has a calibration file: assume no field of view beside it")]
    CalibratedAlready {
        /// The folder.
        folder: PathBuf,
    },
    /// A single camera that cannot be.
    #[error("{folder}: {source}")]
    Camera {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: Box<CalibrationError>,
    },
    /// An image whose header cannot be read.
    #[error("{path}: {source}")]
    Image {
        /// The file.
        path: PathBuf,
        /// Why.
        source: ImageError,
    },
}

impl StereoFolder {
    /// Reads a folder's calibration, file names and times.
    ///
    /// # Errors
    /// Where a layout's part is missing or unreadable; the error names what was looked for and what is there.
    pub fn open(folder: &Path) -> Result<Self, FolderError> {
        let names = names_in(folder)?;
        let (left_name, right_name, cameras) = image_folders(folder, &names)?;
        let mut left = images_by_number(&folder.join(left_name))?;
        let mut right = images_by_number(&folder.join(right_name))?;
        let calibration = calibration::read(folder, &names, cameras, &left, &right)?;
        let clock = times::Clock::of(folder, &names, left.keys().chain(right.keys()))?;

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

/// Whether a folder holds left and right images, as far as its names tell.
///
/// # Errors
/// Where it cannot be read.
pub fn holds_pairs(folder: &Path) -> Result<bool, FolderError> {
    let names = names_in(folder)?;
    Ok(pair_among(&names).is_some())
}

fn pair_among(names: &[String]) -> Option<(&'static str, &'static str, [u8; 2])> {
    let has = |name: &str| names.iter().any(|other| other == name);
    FOLDER_PAIRS.into_iter().find(|(left, right, _)| has(left) && has(right))
}

/// The names in a folder, sorted.
fn names_in(folder: &Path) -> Result<Vec<String>, FolderError> {
    let unreadable = |source| FolderError::Unreadable { path: folder.to_owned(), source };
    let mut names = Vec::new();
    for entry in fs::read_dir(folder).map_err(unreadable)? {
        names.push(entry.map_err(unreadable)?.file_name().to_string_lossy().into_owned());
    }
    names.sort();
    Ok(names)
}

/// The error of a part that is not among `names`.
fn missing(folder: &Path, wanted: String, names: &[String]) -> FolderError {
    let found = if names.is_empty() { "nothing".to_owned() } else { names.join(", ") };
    FolderError::Missing { folder: folder.to_owned(), wanted, found }
}

fn image_folders(folder: &Path, names: &[String]) -> Result<(&'static str, &'static str, [u8; 2]), FolderError> {
    pair_among(names).ok_or_else(|| {
        let pairs = FOLDER_PAIRS.map(|(left, right, _)| format!("{left} and {right}"));
        missing(folder, format!("folders {}", pairs.join(", or ")), names)
    })
}

/// JPEG and PNG files, in the order of their names.
fn images_in(folder: &Path) -> Result<Vec<PathBuf>, FolderError> {
    let is_image = |path: &PathBuf| {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        matches!(extension.as_deref(), Some("jpg" | "jpeg" | "png"))
    };
    Ok(names_in(folder)?.into_iter().map(|name| folder.join(name)).filter(is_image).collect())
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
        return Err(missing(folder, "JPEG or PNG images".to_owned(), &names_in(folder)?));
    }
    Ok(images)
}

#[cfg(test)]
mod tests;
