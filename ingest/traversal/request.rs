//! What is asked of an ingest.

use crate::import::{ImportedTruth, Layout};
use crate::recording::folder_of_metadata;
use crate::traversal::motion::MotionSource;
use crate::traversal::selection::FrameSelection;
use furrow_model::{Purpose, TimeSlot};
use std::path::PathBuf;
use std::sync::Arc;

/// A traversal to ingest.
#[derive(Debug, Clone)]
pub struct IngestRequest {
    /// The recording: one file or folder, or the files of a split one.
    pub files: Vec<PathBuf>,
    /// The site.
    pub site: String,
    /// The route along which the recording was made.
    pub route: String,
    /// At what time of day.
    pub slot: TimeSlot,
    /// What for.
    pub purpose: Purpose,
    /// Which of its frames.
    pub selection: FrameSelection,
    /// The left images' topic, where the names of the topics do not tell.
    pub left: Option<String>,
    /// The right images' topic, where the names of the topics do not tell.
    pub right: Option<String>,
    /// The topic of the left camera's CameraInfo, where the names of the topics do not tell.
    pub left_info: Option<String>,
    /// The topic of the right camera's CameraInfo, where the names of the topics do not tell.
    pub right_info: Option<String>,
    /// Where the chain's steps come from.
    pub motion: MotionSource,
    /// The horizontal field of view to assume of a single camera without calibration, degrees.
    pub field_of_view_deg: Option<f64>,
    /// Calibration files that replace the recording's own.
    pub calibration: Vec<PathBuf>,
    /// A file of true poses in TUM form. Default: `STEM.groundtruth.tum` beside the recording, or `groundtruth.tum` in
    /// the folder.
    pub ground_truth: Option<PathBuf>,
    /// Whether the store keeps the recording's own bytes beside the images taken from it. No id depends on it.
    pub keep_recording: bool,
    /// Whether one unreadable image refuses the recording; else it costs its frame. No id depends on it.
    pub strict: bool,
    /// Whether files that do not follow each other, or are of different rigs, are one recording all the same.
    pub insist_on_parts: bool,
    /// Whether a chain enters on which odometry failed, or all speaks for exchanged cameras.
    pub accept_failed_odometry: bool,
    /// What a dataset's profile tells beside all this; nothing without a profile.
    pub imported: Imported,
}

/// What a dataset's profile tells that no other part of a request can say.
#[derive(Debug, Clone, Default)]
pub struct Imported {
    /// Where loose images lie and what they are, in place of what their folder says.
    pub layout: Option<Arc<Layout>>,
    /// True poses, where the user names no file of them.
    pub truth: Option<ImportedTruth>,
}

impl IngestRequest {
    /// The same request with a folder in the place of its `metadata.yaml`.
    pub(crate) fn naming_folders(&self) -> Self {
        let folder = |file: &PathBuf| folder_of_metadata(file).unwrap_or_else(|| file.clone());
        Self { files: self.files.iter().map(folder).collect(), ..self.clone() }
    }

    /// The file of true poses: the one named, or the one found beside the recording where no profile tells others.
    pub fn ground_truth_file(&self) -> Option<PathBuf> {
        let beside = || {
            let file = self.files.first()?;
            let path =
                if file.is_dir() { file.join("groundtruth.tum") } else { file.with_extension("groundtruth.tum") };
            path.is_file().then_some(path)
        };
        match (&self.ground_truth, &self.imported.truth) {
            (Some(file), _) => Some(file.clone()),
            (None, Some(_)) => None,
            (None, None) => beside(),
        }
    }
}
