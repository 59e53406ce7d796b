//! Why a recording was not ingested.

use crate::folder::FolderError;
use crate::import::ImportError;
use crate::message::MessageError;
use crate::recording::ReadError;
use crate::topics::TopicError;
use furrow_catalog::images::{CalibrationError, CalibrationFileError, ImageError, Side};
use furrow_catalog::{CatalogError, ViewError};
use std::path::{Path, PathBuf};

/// A recording that was not ingested.
#[derive(Debug, thiserror::Error)]
pub enum IngestError {
    /// The container cannot be read.
    #[error(transparent)]
    Read(Box<ReadError>),
    /// The image folder cannot be read.
    #[error(transparent)]
    Folder(Box<FolderError>),
    /// The dataset does not fit its profile.
    #[error(transparent)]
    Import(Box<ImportError>),
    /// The stereo pair's topics are missing or ambiguous.
    #[error("{path}: {source}", path = path.display())]
    Topics {
        /// The recording.
        path: PathBuf,
        /// Why.
        source: Box<TopicError>,
    },
    /// A message that cannot be decoded.
    #[error("{path}: topic {topic}, message received at {receive_ns} ns: {source}", path = path.display())]
    Message {
        /// The recording.
        path: PathBuf,
        /// Its topic.
        topic: String,
        /// When it was received.
        receive_ns: i64,
        /// Why.
        source: Box<MessageError>,
    },
    /// An image that cannot be stored or decoded.
    #[error(
        "{path}: {side} image stamped {stamp_ns} ns: {source}; leave it out with --frames A..B, or repair the \
         recording", path = path.display()
    )]
    Image {
        /// The recording.
        path: PathBuf,
        /// Which camera.
        side: Side,
        /// Its header stamp.
        stamp_ns: i64,
        /// Why.
        source: Box<ImageError>,
    },
    /// Too many images that cannot be stored or decoded.
    #[error(
        "{path}: {lost} of {frames} frames have an image that cannot be read or is of another size; the first: \
         {first}; repair the recording, or take its good part with --frames A..B", path = path.display()
    )]
    Unreadable {
        /// The recording.
        path: PathBuf,
        /// Frames that it costs.
        lost: u32,
        /// All frames.
        frames: u32,
        /// The first of the images, and what is wrong with it.
        first: String,
    },
    /// A camera without an image.
    #[error(
        "{path}: the {side} topic is empty: {topic} has no messages, {other} has {images}; was the camera connected? \
         name the topics that have the images with --left TOPIC --right TOPIC", path = path.display()
    )]
    EmptyTopic {
        /// The recording.
        path: PathBuf,
        /// Which camera.
        side: Side,
        /// Its topic.
        topic: String,
        /// The other camera's topic.
        other: String,
        /// How many images that has.
        images: u64,
    },
    /// No calibration.
    #[error(
        "{path}: no CameraInfo for {topics}; CameraInfo topics: {found}; name them with --left-info TOPIC --right-info TOPIC, or \
         give a file with --calibration", path = path.display()
    )]
    Uncalibrated {
        /// The recording.
        path: PathBuf,
        /// The image topics.
        topics: String,
        /// The CameraInfo topics.
        found: String,
    },
    /// The cameras give no rectified pair.
    #[error(transparent)]
    Calibration(Box<CalibrationError>),
    /// The calibration file.
    #[error(transparent)]
    CalibrationFile(Box<CalibrationFileError>),
    /// A single camera without given motion.
    #[error(
        "{path}: a single camera's images have no depth, so odometry cannot estimate distances: give the distance \
         between images with --spacing-m or their poses with --poses, or add right images", path = path.display()
    )]
    NoOdometry {
        /// The folder.
        path: PathBuf,
    },
    /// Nothing to ingest.
    #[error(
        "{path}: no stereo pair: {left} left and {right} right images, none within half a period of each other by \
         header stamp", path = path.display()
    )]
    NoPairs {
        /// The recording.
        path: PathBuf,
        /// Left images.
        left: u64,
        /// Right images.
        right: u64,
    },
    /// The selection leaves nothing.
    #[error("{path}: --frames {selection} selects none of its {pairs} pairs", path = path.display())]
    NothingSelected {
        /// The recording.
        path: PathBuf,
        /// What was asked.
        selection: String,
        /// Pairs there are.
        pairs: u32,
    },
    /// A recording that could enter, and most likely should not: what speaks against it, and how to insist.
    #[error("{path}: {doubt}; nothing was entered. {insist}", path = path.display())]
    Doubtful {
        /// The recording.
        path: PathBuf,
        /// What was found and its likely cause.
        doubt: String,
        /// What to mend, or the option that enters it all the same.
        insist: String,
    },
    /// A request that cannot be met.
    #[error("{0}")]
    Request(String),
    /// The operating system refused.
    #[error("cannot read {path}: {source}", path = path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The store failed.
    #[error(transparent)]
    Catalog(#[from] CatalogError),
    /// A stored image gives no view.
    #[error(transparent)]
    View(Box<ViewError>),
}

impl IngestError {
    /// The operating system's refusal to read or write `path`.
    pub(crate) fn file(path: &Path) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::File { path, source }
    }
}

macro_rules! boxed {
    ($($variant:ident($error:ty)),* $(,)?) => {
        $(impl From<$error> for IngestError {
            fn from(error: $error) -> Self {
                Self::$variant(Box::new(error))
            }
        })*
    };
}

// Boxed, so that a `Result` stays as small as its success value.
boxed!(
    Read(ReadError),
    Folder(FolderError),
    Import(ImportError),
    Calibration(CalibrationError),
    CalibrationFile(CalibrationFileError),
    View(ViewError),
);
