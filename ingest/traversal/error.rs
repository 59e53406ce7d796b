//! What can keep an outing out of the store.

use crate::folder::FolderError;
use crate::message::MessageError;
use crate::recording::ReadError;
use crate::topics::TopicError;
use furrow_catalog::images::{CalibrationError, CalibrationFileError, ImageError, Side};
use furrow_catalog::{CatalogError, ViewError};
use std::path::PathBuf;

/// A recording that was not ingested.
#[derive(Debug, thiserror::Error)]
pub enum IngestError {
    /// The container cannot be read.
    #[error(transparent)]
    Read(Box<ReadError>),
    /// The image folder cannot be read.
    #[error(transparent)]
    Folder(Box<FolderError>),
    /// The stereo pair's topics are not plain.
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
    #[error("{path}: {side} image stamped {stamp_ns} ns: {source}; leave it out with --frames A..B, or repair the recording", path = path.display())]
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
    /// No calibration.
    #[error("{path}: no CameraInfo for {topics}: record it, or give a file with --calibration", path = path.display())]
    Uncalibrated {
        /// The recording.
        path: PathBuf,
        /// The image topics.
        topics: String,
    },
    /// The cameras give no rectified pair.
    #[error(transparent)]
    Calibration(Box<CalibrationError>),
    /// The calibration file.
    #[error(transparent)]
    CalibrationFile(Box<CalibrationFileError>),
    /// A single camera, and nothing said about how it moved.
    #[error(
        "{path}: a single camera's images tell no distances, so odometry cannot tell the way: say how far apart they are with --spacing-m, or \
         give their poses with --poses; or keep right images beside them", path = path.display()
    )]
    NoOdometry {
        /// The folder.
        path: PathBuf,
    },
    /// Nothing to ingest.
    #[error("{path}: no stereo pair: {left} left and {right} right images, none within half a period of each other by header stamp", path = path.display())]
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
    /// What was asked makes no sense.
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

macro_rules! boxed {
    ($($variant:ident($error:ty)),* $(,)?) => {
        $(impl From<$error> for IngestError {
            fn from(error: $error) -> Self {
                Self::$variant(Box::new(error))
            }
        })*
    };
}

// Boxed, so that the good case does not carry the bad one's size about.
boxed!(
    Read(ReadError),
    Folder(FolderError),
    Calibration(CalibrationError),
    CalibrationFile(CalibrationFileError),
    View(ViewError),
);
