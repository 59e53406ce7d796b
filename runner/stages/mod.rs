//! The stages of a plan: each finds or computes what the next one needs. They read objects and write objects; of the
//! catalogue's rows they enter only those of what they made.

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
