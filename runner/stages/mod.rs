//! The stages of a plan: each finds or computes what the next one needs. They read objects and write objects; of the
//! catalogue's rows they enter only those of what they made. In the order of the work:
//! - `graph`: what the cells that are due need, as data; `executor`, with `shared` and `faults`, walks it;
//! - `codebook` (with `training`), `words`: the vocabulary, and the words of images;
//! - `matching`: the place recognisers and their registry;
//! - `verifying`, `threshold`: inliers of candidates, and how many are needed;
//! - `deciding`, `outcome`: the control hub accepts or rejects, and a cell's outcome is written;
//! - `conduct`, `memory`: what a run does about failures, and how much memory it may take.

pub(crate) mod codebook;
pub mod conduct;
pub(crate) mod deciding;
pub(crate) mod executor;
pub(crate) mod faults;
pub(crate) mod graph;
pub(crate) mod matching;
pub mod memory;
mod outcome;
pub(crate) mod shared;
pub(crate) mod threshold;
mod training;
pub(crate) mod verifying;
pub(crate) mod words;
