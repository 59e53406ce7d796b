//! Why a folder of images cannot be read.

use furrow_catalog::images::{CalibrationError, CalibrationFileError, ImageError};
use std::io;
use std::path::{Path, PathBuf};

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
    #[error(
        "{path}: {fault}; name the images of a folder alike, by a frame number (000000) or by a stamp (in seconds, \
         milliseconds, microseconds or nanoseconds since 1970, seconds.nanoseconds, or YYYYMMDDhhmmss)"
    )]
    Name {
        /// The file.
        path: PathBuf,
        /// What is wrong with its name.
        fault: String,
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
    /// No calibration.
    #[error(
        "{folder}: looked for calib.txt or calibration.json beside the images, found neither: put one there, or give the \
         calibration with --calibration FILE, or two files, left then right"
    )]
    Uncalibrated {
        /// The folder.
        folder: PathBuf,
    },
    /// Calibrations of two cameras for the images of one.
    #[error("{folder} holds the images of a single camera: give one file of one camera with --calibration")]
    OneCamera {
        /// The folder.
        folder: PathBuf,
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
        "{path} is {}x{} px, but {first} is {}x{}: expected images of one camera, all of one size",
        .found[0], .found[1], .expected[0], .expected[1]
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

impl FolderError {
    /// The operating system's refusal to read `path`.
    pub(super) fn unreadable(path: &Path) -> impl Fn(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Unreadable { path: path.clone(), source }
    }

    /// A part that is not among the folder's `names`.
    pub(super) fn missing(folder: &Path, wanted: String, names: &[String]) -> Self {
        let found = if names.is_empty() { "nothing".to_owned() } else { names.join(", ") };
        Self::Missing { folder: folder.to_owned(), wanted, found }
    }
}
