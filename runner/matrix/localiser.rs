//! How places are recognised, as a matrix says it.

use furrow_localiser::external::Metric;
use furrow_localiser::fabmap::MotionModel;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// The place recogniser.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LocaliserSpec {
    /// Which.
    pub method: Method,
    /// Each experience's best so many places are verified.
    pub candidates: u32,
    /// FAB-MAP: how likely the robot goes from place to place; none, and every frame stands alone.
    pub motion: Option<MotionModel>,
    /// SeqSLAM: images in a sequence, as far apart as keyframes.
    pub sequence: usize,
    /// SeqSLAM: farthest that images are shifted sideways to find their least difference, as a share of their width.
    pub shift: f64,
    /// External: the file with a descriptor for every image; relative to the matrix file in the text, to the working folder here.
    pub descriptors: Option<PathBuf>,
    /// External: how descriptors are compared.
    pub metric: Metric,
}

impl Default for LocaliserSpec {
    fn default() -> Self {
        Self {
            method: Method::Fabmap2,
            candidates: 1,
            motion: None,
            sequence: 10,
            shift: 0.0,
            descriptors: None,
            metric: Metric::Cosine,
        }
    }
}

impl LocaliserSpec {
    /// The key that is wrong, and why.
    pub(super) fn check(&self) -> Result<(), (&'static str, String)> {
        let method = self.method.name();
        match (self.method, &self.descriptors) {
            _ if self.candidates == 0 => Err(("candidates", "candidates must be at least 1".to_owned())),
            _ if self.sequence == 0 => Err(("sequence", "a sequence must have at least 1 image".to_owned())),
            (Method::Seqslam | Method::External, _) if self.motion.is_some() => {
                Err(("motion", format!("motion goes with method = \"fabmap2\", not with \"{method}\"")))
            }
            _ if self.motion.is_some_and(|motion| !motion.is_valid()) => {
                Err(("motion", "motion needs chances from 0 to 1, and stay + leave at most 1".to_owned()))
            }
            _ if !(0.0..=0.5).contains(&self.shift) => {
                Err(("shift", format!("a shift of {} of the width: expected 0 to 0.5", self.shift)))
            }
            (Method::External, None) => Err((
                "method",
                "method \"external\" needs descriptors = \"FILE\": Parquet or NPY, a descriptor for every image"
                    .to_owned(),
            )),
            (Method::Fabmap2 | Method::Seqslam, Some(_)) => {
                Err(("descriptors", format!("descriptors go with method = \"external\", not with \"{method}\"")))
            }
            _ => Ok(()),
        }
    }
}

/// A way to recognise places.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// FAB-MAP 2.0 on words of SURF.
    Fabmap2,
    /// Sequences of small images.
    Seqslam,
    /// Descriptors that another program computed.
    External,
}

impl Method {
    /// The name in matrix files and outcomes.
    pub fn name(self) -> &'static str {
        match self {
            Method::Fabmap2 => "fabmap2",
            Method::Seqslam => "seqslam",
            Method::External => "external",
        }
    }
}
