//! What is asked of an ingest.

use crate::traversal::{IngestError, MotionSource};
use furrow_model::{Purpose, TimeSlot};
use std::fmt;
use std::fs;
use std::path::PathBuf;
use std::str::FromStr;

/// An outing to ingest.
#[derive(Debug, Clone)]
pub struct IngestRequest {
    /// The recording: one file or folder, or the files of a split one.
    pub files: Vec<PathBuf>,
    /// Where it was driven.
    pub site: String,
    /// Along which route.
    pub route: String,
    /// At what time of day.
    pub slot: TimeSlot,
    /// What for.
    pub purpose: Purpose,
    /// Which of its pairs.
    pub selection: FrameSelection,
    /// The left images' topic, where it is not plain.
    pub left: Option<String>,
    /// The right images' topic, where it is not plain.
    pub right: Option<String>,
    /// Where the chain's steps come from.
    pub motion: MotionSource,
    /// The horizontal field of view to assume of a single camera without calibration, degrees.
    pub field_of_view_deg: Option<f64>,
    /// Calibration files that replace the recording's own.
    pub calibration: Vec<PathBuf>,
    /// A file of true poses in TUM form; else `STEM.groundtruth.tum` beside the recording, or `groundtruth.tum` in the folder.
    pub ground_truth: Option<PathBuf>,
    /// Whether the store keeps the recording's own bytes beside the images taken from it. No id depends on it.
    pub keep_recording: bool,
}

impl IngestRequest {
    /// The file of true poses: the one named, or the one found beside the recording.
    pub fn ground_truth_file(&self) -> Option<PathBuf> {
        let beside = || {
            let file = self.files.first()?;
            let path =
                if file.is_dir() { file.join("groundtruth.tum") } else { file.with_extension("groundtruth.tum") };
            path.is_file().then_some(path)
        };
        self.ground_truth.clone().or_else(beside)
    }

    pub(crate) fn ground_truth_bytes(&self) -> Result<Option<Vec<u8>>, IngestError> {
        let Some(path) = self.ground_truth_file() else { return Ok(None) };
        let bytes = fs::read(&path).map_err(|source| IngestError::File { path: path.clone(), source })?;
        check_poses(&bytes).map_err(|reason| IngestError::Request(format!("{}: {reason}", path.display())))?;
        Ok(Some(bytes))
    }
}

/// Whether a file holds poses in TUM form, rising in time: what is wrong, with its line.
fn check_poses(bytes: &[u8]) -> Result<(), String> {
    let text = std::str::from_utf8(bytes).map_err(|_| "true poses must be text".to_owned())?;
    let mut last_s = f64::NEG_INFINITY;
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.starts_with('#') && !line.trim().is_empty())
    {
        let numbers: Vec<f64> =
            line.split_whitespace().filter_map(|word| word.parse().ok()).filter(|v: &f64| v.is_finite()).collect();
        let turned = numbers.iter().skip(4).any(|v| *v != 0.0);
        if numbers.len() != 8 || line.split_whitespace().count() != 8 || !turned || numbers[0] <= last_s {
            let expected = "expected 't tx ty tz qx qy qz qw' with t rising from line to line";
            return Err(format!("line {}: {expected}, found '{line}'", number + 1));
        }
        last_s = numbers[0];
    }
    Ok(())
}

/// Which of a recording's pairs, counted from 0 in the order driven.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FrameSelection {
    /// Every pair.
    All,
    /// 0, 2, 4 …
    Even,
    /// 1, 3, 5 …
    Odd,
    /// From the first number to before the second.
    Range(u32, u32),
}

impl FrameSelection {
    /// Whether pair number `index` is wanted.
    pub fn contains(self, index: u32) -> bool {
        match self {
            Self::All => true,
            Self::Even => index.is_multiple_of(2),
            Self::Odd => !index.is_multiple_of(2),
            Self::Range(from, to) => (from..to).contains(&index),
        }
    }
}

impl fmt::Display for FrameSelection {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("all"),
            Self::Even => f.write_str("even"),
            Self::Odd => f.write_str("odd"),
            Self::Range(from, to) => write!(f, "{from}..{to}"),
        }
    }
}

impl FromStr for FrameSelection {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        let range = || {
            let (from, to) = text.split_once("..")?;
            let (from, to) = (from.parse().ok()?, to.parse().ok()?);
            (from < to).then_some(Self::Range(from, to))
        };
        match text {
            "all" => Ok(Self::All),
            "even" => Ok(Self::Even),
            "odd" => Ok(Self::Odd),
            _ => {
                range().ok_or_else(|| format!("'{text}' selects no frames: expected all, even, odd or A..B with A < B"))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn selections_read_back_and_choose() {
        for (text, chosen) in
            [("all", vec![0, 1, 2, 3]), ("even", vec![0, 2]), ("odd", vec![1, 3]), ("1..3", vec![1, 2])]
        {
            let selection: FrameSelection = text.parse().unwrap();
            assert_eq!(selection.to_string(), text);
            assert_eq!((0..4).filter(|i| selection.contains(*i)).collect::<Vec<_>>(), chosen);
        }
        for text in ["", "3..1", "2..2", "-1..2", "none"] {
            assert!(text.parse::<FrameSelection>().is_err(), "{text}");
        }
    }
}
