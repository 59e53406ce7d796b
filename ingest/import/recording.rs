//! Bags that a profile puts together as one recording: the blocks of the cameras, and those of other sensors beside
//! them.

use super::calibration::calibration_files;
use super::error::ImportError;
use super::paths::{files_of, files_of_pattern, missing};
use super::profile::{Profile, RecordingPart};
use super::truth::{ImportedTruth, read_truth};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The bags of a dataset, and what the profile says of them.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordingFiles {
    /// The bags.
    pub files: Vec<PathBuf>,
    /// The topics that the profile names.
    pub topics: RecordingPart,
    /// Calibration files.
    pub calibration: Vec<PathBuf>,
    /// The calibration as the profile itself tells it.
    pub calibration_text: Option<String>,
    /// True poses.
    pub truth: Option<ImportedTruth>,
}

/// Finds the bags that a profile names below `path`; a `path` that is a bag stands for itself.
///
/// # Errors
/// [`ImportError`] where there are none, or the profile is of loose images.
pub fn resolve_recording(name: &str, profile: &Profile, path: &Path) -> Result<RecordingFiles, ImportError> {
    let Some(topics) = &profile.recording else {
        return Err(ImportError::file(path, format!("profile {name} is for loose images, not for bags")));
    };
    let root = if path.is_dir() { path } else { path.parent().unwrap_or(path) };
    let mut files = if path.is_file() { vec![path.to_owned()] } else { files_of(root, &topics.files) };
    if files.is_empty() {
        return Err(missing(root, &topics.files, "name the folder that holds the bags, or one bag"));
    }
    if path.is_dir() {
        for pattern in &topics.beside {
            files.extend(
                files_of_pattern(root, pattern).into_iter().filter(|file| !files.contains(file)).collect::<Vec<_>>(),
            );
        }
    }
    let calibration = profile.calibration.as_ref().map(|part| calibration_files(root, part)).transpose()?;
    let truth = match &profile.truth {
        Some(part) => read_truth(root, part, &BTreeMap::new())?,
        None => None,
    };
    Ok(RecordingFiles {
        files,
        topics: topics.clone(),
        calibration: calibration.unwrap_or_default(),
        calibration_text: profile.calibration.as_ref().and_then(|part| part.text.clone()),
        truth,
    })
}
