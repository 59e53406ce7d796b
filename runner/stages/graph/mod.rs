//! The stage graph: what the cells that are due need, as data. The plans of a study alone make it; the local executor,
//! Slurm's jobs and the estimate walk it. It reads the store's index of results to tell what is finished, and computes
//! nothing.

mod build;
mod state;
mod step;

pub(crate) use build::{Graph, Part};
pub(crate) use state::State;
pub(crate) use step::{NodeIx, Step};

#[cfg(test)]
pub(crate) mod example;
#[cfg(test)]
mod tests;
