//! The second executor: a run's stages as job arrays of a Slurm cluster, for those who outgrow one machine. A tour, in
//! the order of the work:
//! - `job`: the plan's unfinished work as stages of units, and these as tasks of many units;
//! - `queue`: `sbatch` and `squeue`;
//! - `worker`: one task, on a node: reads objects, writes objects, never opens the store's index;
//! - `report`: what a task leaves beside its log;
//! - `round`: a folder of jobs with logs and reports;
//! - `submit`: the submitting process: submit, wait, collect; it may be killed or leave at any moment, and the same
//!   command goes on.
//!
//! Workers resolve the same matrix against the same traversals by the same code as a local run, so that their cells
//! have the same keys and their outcomes the same ids.

mod job;
mod queue;
mod report;
mod round;
mod run;
mod submit;
mod worker;

pub use job::StageName;
pub use queue::Queue;
pub use round::{Tasks, tasks};
pub use submit::{Following, collect, run_on_slurm};
pub use worker::{Assignment, work};
