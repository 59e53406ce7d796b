//! The steps of a trajectory: a second try for doubtful steps, and stretches of several steps compared from end to end.
//! It may use all folders but `verification`, and it is the only one that uses several threads.

mod builder;
mod recent;
mod reconcile;
mod stretches;

pub use builder::ChainBuilder;
