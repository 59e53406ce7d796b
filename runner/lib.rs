//! From a declared matrix to outcomes. A tour, in the order of the work:
//! - [`matrix`]: the file a user writes;
//! - [`plan`](mod@plan): the matrix resolved against the store: cells, what is finished, what is blocked and why;
//! - [`run`](mod@run): the story: codebook, words, matches, verification, decision, evaluation, cell by cell;
//! - `codebook` (with `training`), `words`, `matching`, `verifying`, `threshold`: one stage each, its result remembered under a key of all its inputs;
//! - `descriptors`: files that another program computed;
//! - `deciding`: the control hub in lockstep, every candidate logged;
//! - [`truth`], [`evaluate`]: where frames really were, and the numbers;
//! - [`contrast`]: whether one contender beats another on the same live passes;
//! - [`generation`]: generators, the experiences that they make, and the gate that measures them;
//! - [`live`]: the same step frame by frame, and the hub on the robot's own time;
//! - [`pictures`]: live and matched views for the report.
//!
//! Stages read immutable objects and write immutable objects; only [`run`](mod@run) enters rows. Killed anywhere, the same command takes
//! up after the last finished stage.

mod codebook;
pub mod contrast;
mod deciding;
mod descriptors;
mod error;
pub mod evaluate;
pub mod gate;
pub mod generation;
mod key;
mod leakage;
pub mod live;
mod matching;
pub mod matrix;
pub mod pictures;
pub mod plan;
mod progress;
pub mod run;
mod sampling;
mod table;
mod threshold;
mod training;
pub mod truth;
mod verifying;
mod words;

pub use contrast::{Contrasts, contrasts};
pub use error::RunError;
pub use matrix::Matrix;
pub use plan::{Blocked, Plan, PlannedCell, plan};
pub use progress::{Progress, StageProgress};
pub use run::{CellResult, RunResult, run};

pub use furrow_generator as generator;
pub use furrow_localiser as localiser;
