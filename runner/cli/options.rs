//! Arguments that several commands share.

use crate::choosing::choose_run;
use crate::ending::Failure;
use furrow_catalog::Catalog;
use furrow_model::RunId;
use furrow_runner::matrix::Rule;
use furrow_runner::plan::Plan;
use furrow_runner::{Study, read_matrix, study};
use std::convert::Infallible;
use std::fs;
use std::path::PathBuf;
use std::str::FromStr;

/// A matrix file.
#[derive(Debug, clap::Args)]
pub struct MatrixFile {
    /// The matrix file: an experiment as TOML.
    #[arg(value_name = "MATRIX.toml")]
    pub matrix: PathBuf,
}

impl MatrixFile {
    /// Reads it and resolves it against the store.
    pub fn read(&self, catalog: &Catalog) -> Result<Study, Failure> {
        let text = fs::read_to_string(&self.matrix)
            .map_err(|error| Failure::new(format!("cannot read {}: {error}", self.matrix.display())))?;
        Ok(study(catalog, read_matrix(&self.matrix, &text)?, &text)?)
    }

    /// Reads a matrix that has one setting.
    pub fn read_single(&self, catalog: &Catalog) -> Result<Plan, Failure> {
        let mut parts = self.read(catalog)?.parts;
        match (parts.pop(), parts.len()) {
            (Some(part), 0) => Ok(part),
            (_, more) => Err(Failure::new(format!(
                "{} has {} settings: give the axes words, images, keyframes, method, threshold and seed one value each",
                self.matrix.display(),
                more + 1
            ))),
        }
    }
}

/// Which cells of a matrix are meant.
#[derive(Debug, clap::Args)]
pub struct CellFilter {
    /// Only the cells that match FILTER: KEY=VALUE,... with the keys live, experience, words, images, keyframes,
    /// method, threshold and seed; `*` stands for any text. Given several times, a cell has to match one of them.
    #[arg(long, value_name = "FILTER")]
    only: Vec<Rule>,
}

impl CellFilter {
    /// Leaves only these cells asked for.
    pub fn apply(&self, study: &mut Study) -> Result<(), Failure> {
        if self.only.is_empty() {
            return Ok(());
        }
        study.only(&self.only);
        match study.cells().any(|(_, cell)| cell.asked) {
            true => Ok(()),
            false => {
                Err(Failure::usage("--only leaves no cell: `furrow plan MATRIX.toml` lists their slots and names"))
            }
        }
    }
}

/// How many threads to compute with.
#[derive(Debug, clap::Args)]
pub struct Threads {
    /// Threads to compute with. Results do not depend on it.
    #[arg(short, long, value_name = "N", default_value = "all")]
    jobs: ThreadCount,
}

/// A number of threads, or as many as the machine has cores.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum ThreadCount {
    All,
    Exactly(usize),
}

impl FromStr for ThreadCount {
    type Err = String;
    fn from_str(text: &str) -> Result<Self, String> {
        match text.parse() {
            _ if text == "all" => Ok(Self::All),
            Ok(threads) => Ok(Self::Exactly(threads)),
            Err(_) => Err("expected a number of threads, or all".to_owned()),
        }
    }
}

impl Threads {
    /// The number asked for, if one was.
    pub fn count(&self) -> Option<usize> {
        match self.jobs {
            ThreadCount::All => None,
            ThreadCount::Exactly(threads) => Some(threads),
        }
    }

    /// Has all further work done on so many threads.
    pub fn apply(&self) -> Result<(), Failure> {
        self.count().map_or(Ok(()), use_threads)
    }
}

/// Has all further work done on so many threads.
pub fn use_threads(threads: usize) -> Result<(), Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build_global().map_err(|error| Failure::new(format!("cannot start {threads} threads: {error}")))
}

/// A run of the store, as a user names it.
#[derive(Debug, Clone)]
pub struct RunName(String);

impl FromStr for RunName {
    type Err = Infallible;
    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(Self(text.to_owned()))
    }
}

impl RunName {
    /// Finds the run.
    pub fn find(&self, catalog: &Catalog) -> Result<RunId, Failure> {
        choose_run(catalog, &self.0)
    }
}

/// The run that a command is about.
#[derive(Debug, clap::Args)]
pub struct WhichRun {
    /// The run: its id, the beginning of it, or `latest`.
    pub run: RunName,
}
