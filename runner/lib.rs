//! From a declared matrix to outcomes. A tour, in the order of the work:
//! - [`matrix`]: the file a user writes;
//! - [`plan`](mod@plan): the matrix resolved against the store: cells, what is finished, what is blocked and why;
//! - [`study`](mod@study): all settings of a matrix file, planned and run as one;
//! - `run` (with `stages`, `faults`): the story of one setting: codebook, words, matches, verification, decision, evaluation, cell by cell;
//! - `codebook` (with `training`), `words`, `matching`, `verifying`, `threshold`: one stage each, its result remembered under a key of all its inputs;
//! - `descriptors`: files that another program computed;
//! - `deciding`: the control hub in lockstep, every candidate logged;
//! - [`truth`], [`evaluate`]: where frames really were, and the numbers; [`tracks`]: odometry laid over the truth;
//! - [`contrast`]: whether one contender beats another on the same live passes;
//! - [`generation`]: generators, the experiences that they make, and the gate that measures them;
//! - [`compare`](mod@compare), [`reproduce`](mod@reproduce): runs beside each other, and one again from its recordings' bytes;
//! - [`memory`]: how much of it a run may take;
//! - [`estimate`](mod@estimate), [`work`]: what a plan will cost, from what runs took;
//! - [`claims`](mod@claims): the thesis' claims held against all that was run;
//! - [`slurm`]: the same stages as job arrays of a cluster;
//! - [`live`]: the same step frame by frame, and the hub on the robot's own time;
//! - [`pictures`]: live and matched views for the report;
//! - [`export`]: a cell as a recording that players of robot data show.
//!
//! Stages read immutable objects and write immutable objects; only `run` and `study` enter rows. Killed anywhere, the same command takes
//! up after the last finished stage.

pub mod claims;
mod codebook;
pub mod compare;
pub mod contrast;
mod deciding;
mod descriptors;
mod error;
pub mod estimate;
pub mod evaluate;
pub mod export;
mod faults;
pub mod gate;
pub mod generation;
mod key;
mod leakage;
pub mod live;
mod matching;
pub mod matrix;
pub mod memory;
pub mod pictures;
pub mod plan;
mod progress;
pub mod reproduce;
mod run;
mod sampling;
pub mod slurm;
mod stages;
pub mod study;
mod table;
mod threshold;
pub mod tracks;
mod training;
pub mod truth;
mod verifying;
mod words;
pub mod work;

pub use contrast::{Contrasts, MissingContrast, contrasts};
pub use error::RunError;
pub use matrix::Matrix;
pub use plan::{Blocked, Plan, PlannedCell};
pub use progress::{Progress, StageProgress};
pub use run::CellResult;
pub use study::{Conduct, Failed, Study, StudyResult, run, study};

pub use furrow_generator as generator;
pub use furrow_localiser as localiser;
