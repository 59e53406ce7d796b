//! What pages ask of the crates that compute. Reports know neither the runner nor the localiser: the command passes an
//! implementation.

use super::error::BrowseError;
use crate::input::ContrastInput;
use furrow_catalog::records::{RunRecord, TraversalRecord};
use furrow_catalog::tables::Frame;
use furrow_catalog::{Catalog, Objects};
use furrow_model::{ObjectId, Outcome, RunId};

/// A frame that something is matched to: its traversal and its images.
#[derive(Debug, Clone, Copy)]
pub struct ViewPoint<'a> {
    /// The traversal.
    pub traversal: &'a TraversalRecord,
    /// The frame.
    pub frame: &'a Frame,
}

/// What a frame and a node have in common, according to verification.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Agreement {
    /// Matches that entered the motion fit.
    pub matches: u32,
    /// Inliers: a point of the frame and its partner in the node's image, as fractions (0 to 1) of width and height.
    pub lines: Vec<([f32; 2], [f32; 2])>,
}

/// Where frames really were.
#[derive(Debug, Clone, PartialEq)]
pub struct TrueTrack {
    /// Where that is known from.
    pub source: String,
    /// East and north of each frame, metres; `None` where it is not known.
    pub positions: Vec<Option<[f64; 2]>>,
    /// Whether the positions are relative to the first fix of the traversal; else those of all traversals share one
    /// frame.
    pub relative: bool,
}

/// What a quality gate's record says.
#[derive(Debug, Clone, PartialEq)]
pub struct GateReading {
    /// Why the generator is doubtful; empty where it passes.
    pub doubts: Vec<String>,
    /// What was measured: a name and its value, as people read them.
    pub figures: Vec<(String, String)>,
}

/// Answers that need more than the catalogue. Every method only reads.
pub trait Insight: Send + Sync {
    /// The day of a stamp in a traversal by the site's clocks, `2026-05-31`.
    ///
    /// # Errors
    /// Where the store cannot be read.
    fn day(&self, catalog: &Catalog, traversal: &TraversalRecord, stamp_ns: i64) -> Result<String, BrowseError>;

    /// The keypoints of a frame's rectified left view: x, y and radius, as fractions of its width, height and width.
    ///
    /// # Errors
    /// Where the image cannot be read.
    fn keypoints(&self, objects: &Objects, at: ViewPoint<'_>) -> Result<Vec<[f32; 3]>, BrowseError>;

    /// What a frame and a node's left image have in common; the image was taken with the cameras of `calibration`.
    ///
    /// # Errors
    /// Where an image cannot be read.
    fn agreement(
        &self,
        objects: &Objects,
        at: ViewPoint<'_>,
        node: ObjectId,
        calibration: ObjectId,
    ) -> Result<Agreement, BrowseError>;

    /// True positions of a traversal at some stamps; relative ones in the frame of another traversal where one is
    /// given. `None` without a ground truth.
    ///
    /// # Errors
    /// Where the ground truth cannot be read.
    fn true_track(
        &self,
        objects: &Objects,
        traversal: &TraversalRecord,
        frame_of: Option<&TraversalRecord>,
        stamps_ns: &[i64],
    ) -> Result<Option<TrueTrack>, BrowseError>;

    /// Reads a quality gate's record.
    ///
    /// # Errors
    /// Where it cannot be read.
    fn gate(&self, objects: &Objects, record: ObjectId) -> Result<GateReading, BrowseError>;

    /// The contrasts of a run from its finished cells.
    ///
    /// # Errors
    /// Where a table of events cannot be read.
    fn contrasts(
        &self,
        objects: &Objects,
        run: &RunRecord,
        outcomes: &[&Outcome],
    ) -> Result<ContrastInput, BrowseError>;

    /// A run's report, as `furrow report` writes it.
    ///
    /// # Errors
    /// Where an outcome, an image or a table cannot be read.
    fn report(&self, catalog: &Catalog, run: RunId) -> Result<String, BrowseError>;
}
