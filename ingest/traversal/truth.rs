//! A file of true poses that goes with a recording: read by the parser that judges with it, and held against the
//! frames' stamps before odometry runs.

use crate::import::tum_text;
use crate::pairing::Side;
use crate::traversal::error::IngestError;
use crate::traversal::request::IngestRequest;
use crate::traversal::source::{ImageSource, Item};
use crate::traversal::stamps_apart::likely_cause;
use furrow_catalog::digest;
use furrow_model::{ObjectId, TruePoses, TruthError};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// True poses, read and checked.
#[derive(Debug)]
pub(crate) struct GivenTruth {
    path: PathBuf,
    bytes: Vec<u8>,
    poses: TruePoses,
    /// Why no moment can have a pose, where the stamps are of no clock.
    fault: Option<TruthError>,
}

impl GivenTruth {
    /// Reads a file, which must be in TUM form with ascending stamps of seconds.
    pub(crate) fn read(path: &Path) -> Result<Self, IngestError> {
        Self::parse(path, fs::read(path).map_err(IngestError::file(path))?)
    }

    fn parse(path: &Path, bytes: Vec<u8>) -> Result<Self, IngestError> {
        let (poses, fault) = match TruePoses::parse(&bytes) {
            Ok(poses) if poses.stamps_ns.is_empty() => {
                return Err(IngestError::Request(format!("{} holds no true pose", path.display())));
            }
            Ok(poses) => (poses, None),
            // Said once it is known how many frames that leaves without a pose.
            Err(fault @ TruthError::Stamp { .. }) => (TruePoses::default(), Some(fault)),
            Err(error) => return Err(IngestError::Request(format!("true poses of {}: {error}", path.display()))),
        };
        Ok(Self { path: path.to_owned(), bytes, poses, fault })
    }

    /// The poses that a request names or its profile tells; `None` without any.
    pub(crate) fn of_request(request: &IngestRequest) -> Result<Option<Self>, IngestError> {
        match (request.ground_truth_file(), &request.imported.truth) {
            (Some(path), _) => Self::read(&path).map(Some),
            (None, Some(truth)) => Self::parse(&truth.path, tum_text(&truth.poses).into_bytes()).map(Some),
            (None, None) => Ok(None),
        }
    }

    /// The file.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// The file's bytes, as the store keeps them.
    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The name that the store gives the file.
    pub(crate) fn digest(&self) -> ObjectId {
        digest(&self.bytes)
    }

    /// Refuses poses of which no image of a source has one. Reads the source up to the first that has.
    pub(crate) fn check_source(&self, source: &dyn ImageSource) -> Result<(), IngestError> {
        let (mut stamps, mut is_met) = (Vec::new(), false);
        source.stream(&mut |_, _| {}, &mut |item| {
            if let Item::Image { side: Side::Left, stamp_ns, .. } = item {
                stamps.push(stamp_ns);
                is_met = self.poses.has(stamp_ns);
            }
            Ok(if is_met { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        })?;
        if is_met || stamps.is_empty() { Ok(()) } else { Err(self.refusal(&stamps)) }
    }

    /// How many of the frames have a true pose, in words where it is not all of them.
    pub(crate) fn check_frames(&self, stamps_ns: &[i64]) -> Result<Option<String>, IngestError> {
        let Some(first) = stamps_ns.iter().find(|stamp_ns| !self.poses.has(**stamp_ns)) else { return Ok(None) };
        let (known, all) = (self.frames_with_pose(stamps_ns), stamps_ns.len());
        if known == 0 {
            return Err(self.refusal(stamps_ns));
        }
        Ok(Some(format!("{known} of {all} frames{HAVE_POSES}; the first without one is stamped {} s", seconds(*first))))
    }

    /// What is odd about a way that is much longer or shorter by the true poses than by the chain, where nearly all
    /// frames have a pose.
    pub(crate) fn check_way(&self, stamps_ns: &[i64], chain_m: f64) -> Option<String> {
        let there: Vec<[f64; 3]> = stamps_ns.iter().filter_map(|stamp_ns| self.poses.position_m(*stamp_ns)).collect();
        if there.len() * 10 < stamps_ns.len() * 9 {
            return None;
        }
        let step_m = |pair: &[[f64; 3]]| (0..3).map(|i| (pair[1][i] - pair[0][i]).powi(2)).sum::<f64>().sqrt();
        let true_m: f64 = there.windows(2).map(step_m).sum();
        let (shorter_m, longer_m) = (true_m.min(chain_m), true_m.max(chain_m));
        (longer_m > LEAST_WAY_M && longer_m > LONGER_AT_MOST * shorter_m).then(|| {
            format!(
                "{BY_POSES} {true_m:.1} m long, the chain {chain_m:.1} m: are they in metres, and of this recording?"
            )
        })
    }

    /// How many of the frames have a true pose.
    pub(crate) fn frames_with_pose(&self, stamps_ns: &[i64]) -> u32 {
        stamps_ns.iter().filter(|stamp_ns| self.poses.has(**stamp_ns)).count() as u32
    }

    fn refusal(&self, stamps_ns: &[i64]) -> IngestError {
        let (path, all) = (self.path.display(), stamps_ns.len());
        if let Some(fault) = &self.fault {
            return IngestError::Request(format!("{path}: 0 of {all} frames{HAVE_POSES}: {fault}"));
        }
        let frames = [stamps_ns.iter().min(), stamps_ns.iter().max()].map(|end| end.copied().unwrap_or_default());
        let own =
            [self.poses.stamps_ns.first(), self.poses.stamps_ns.last()].map(|end| end.copied().unwrap_or_default());
        IngestError::Request(format!(
            "{path}: 0 of {all} frames{HAVE_POSES}: its stamps go from {} s to {} s, the frames' from {} s to {} s; {}",
            seconds(own[0]),
            seconds(own[1]),
            seconds(frames[0]),
            seconds(frames[1]),
            likely_cause(own, frames)
        ))
    }
}

/// Ways are compared from here on: a robot that stands drifts on the chain, and jitters in its true poses.
const LEAST_WAY_M: f64 = 5.0;
/// One may be so many times as long as the other: more than any odometry errs, less than a wrong unit.
const LONGER_AT_MOST: f64 = 1.5;

/// How a note on their way begins, and no other.
const BY_POSES: &str = "by the true poses the way is";
/// What a note on true poses has, and no other.
const HAVE_POSES: &str = " have a true pose";

/// Whether a note speaks of true poses.
pub(crate) fn is_of_truth(note: &str) -> bool {
    note.contains(HAVE_POSES) || note.starts_with(BY_POSES)
}

/// Nanoseconds as seconds, all digits.
fn seconds(ns: i64) -> String {
    let sign = if ns < 0 { "-" } else { "" };
    let text = format!("{sign}{}.{:09}", ns.unsigned_abs() / 1_000_000_000, ns.unsigned_abs() % 1_000_000_000);
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}
