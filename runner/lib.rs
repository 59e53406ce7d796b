//! From a declared matrix to outcomes. A tour, in the order of the work; each room uses only those before it:
//! - [`matrix`]: the file a user writes;
//! - [`inputs`]: the traversals, contenders, codebook and descriptor files that it names, and their keys;
//! - [`evaluate`]: where frames really were, and the numbers of a cell, each defined once;
//! - [`generation`]: generators, the experiences that they make, and the gate that measures them;
//! - [`plan`](mod@plan): the matrix resolved against the store: cells, what is finished, what is blocked and why;
//! - [`stages`]: codebook, words, matches, verification, threshold, decision: each result is remembered under a key of
//!   all its inputs;
//! - [`study`](mod@study): all settings of a matrix file, planned, estimated, run, compared and reproduced;
//! - [`slurm`]: the same stages as job arrays of a cluster;
//! - [`live`]: the same step frame by frame, and the hub on the robot's own time;
//! - [`claims`](mod@claims): the thesis' claims held against all that was run;
//! - [`export`]: a cell as a recording that players of robot data show, and its pictures for the report.
//!
//! Stages read immutable objects and write immutable objects; rows are entered by the submitting process alone, never
//! by a worker of a cluster. Killed anywhere, the same command takes up after the last finished stage.

pub mod claims;
mod error;
pub mod evaluate;
pub mod export;
pub mod generation;
pub mod inputs;
pub mod live;
pub mod matrix;
pub mod plan;
mod progress;
pub mod slurm;
pub mod stages;
pub mod study;
pub mod suggest;

pub use error::RunError;
pub use evaluate::contrast::{Contrasts, MissingContrast, contrasts};
pub use matrix::Matrix;
pub use plan::{Blocked, Plan, PlannedCell};
pub use progress::{Progress, Stage, StageProgress, Subject};
pub use stages::conduct::Conduct;
pub use stages::matching::read_matrix;
pub use study::run::CellResult;
pub use study::{Failed, Study, StudyResult, run, study};

pub use furrow_generator as generator;
pub use furrow_localiser as localiser;
