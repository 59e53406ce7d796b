//! A step of the graph.

use crate::plan::{CellIx, ContenderIx, LiveIx};
use crate::progress::Stage;
use furrow_model::ObjectId;

/// Something to compute for a plan, by places in it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Step {
    /// The codebook.
    Codebook,
    /// A generated experience, and the measures of its generator.
    Make(ContenderIx),
    /// The words of a live traversal's frames.
    LiveWords(LiveIx),
    /// The words of an experience's nodes.
    ContenderWords(ContenderIx),
    /// What an experience answers a live traversal.
    Match(LiveIx, ContenderIx),
    /// The inliers of these answers. All of one live traversal are verified together, so that each of its frames is
    /// prepared once.
    Verify(LiveIx, ContenderIx),
    /// The inliers that a localisation of a live traversal must reach.
    Threshold(LiveIx),
    /// Decision and evaluation: the outcome.
    Cell(CellIx),
}

/// Which node of a graph.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct NodeIx(pub usize);

/// Units of one kind of work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Work {
    /// Its kind.
    pub stage: Stage,
    /// Images, frames, nodes, rounds or cells.
    pub units: u64,
    /// What these units are of: those of several steps are counted once.
    pub of: ObjectId,
}

/// A step with what it needs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Node {
    /// Which part of the graph.
    pub part: usize,
    /// What.
    pub step: Step,
    /// Equal steps of several parts have equal keys. Where it needs no other step, the result is remembered under it;
    /// else it is a name made of ids, since the step's own key is made of what its needs give.
    pub key: ObjectId,
    /// What it costs.
    pub work: Vec<Work>,
    /// Steps before it.
    pub needs: Vec<NodeIx>,
}
