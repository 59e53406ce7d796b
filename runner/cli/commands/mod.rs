//! One file per command; its doc comment is the help text.

pub mod browse;
pub mod claims;
pub mod compare;
pub mod compare_trajectory;
mod contrast;
pub mod export;
pub mod features;
pub mod fsck;
pub mod generate;
pub mod generator;
pub mod ingest;
pub mod init;
pub mod live;
pub mod ls;
pub mod matrix;
pub mod report;
mod report_files;
mod report_input;
pub mod reproduce;
pub mod simulate;
pub mod slurm;
pub mod status;

use crate::{Context, Failure};
use furrow_catalog::Catalog;
use furrow_model::{ObjectId, RunId};
use std::path::PathBuf;

impl Context {
    /// The store: the one named, else the nearest upwards.
    pub fn catalog(&self) -> Result<Catalog, Failure> {
        Ok(Catalog::open(&self.root()?)?)
    }

    /// Its folder.
    pub fn root(&self) -> Result<PathBuf, Failure> {
        if let Some(root) = &self.store {
            return Ok(root.clone());
        }
        let here = std::env::current_dir().map_err(|error| Failure::new(format!("no current folder: {error}")))?;
        Ok(Catalog::find(&here)?)
    }
}

/// All further work is done on so many threads.
pub(crate) fn use_threads(threads: usize) -> Result<(), Failure> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build_global().map_err(|error| Failure::new(format!("cannot start {threads} threads: {error}")))
}

/// The one id among `ids` that begins with what the user typed.
pub(crate) fn chosen<T: Copy + std::fmt::Display>(
    what: &str,
    typed: &str,
    ids: impl Iterator<Item = T>,
) -> Result<T, Failure> {
    let found: Vec<T> = ids.filter(|id| !typed.is_empty() && id.to_string().starts_with(typed)).collect();
    match found.as_slice() {
        [one] => Ok(*one),
        [] => Err(Failure::new(format!(
            "no {what} begins with '{typed}': `furrow ls` and `furrow status` list what there is"
        ))),
        several => Err(Failure::new(format!("{} {what}s begin with '{typed}': type more of the id", several.len()))),
    }
}

/// The run that the user means: an id, its beginning, or `latest`.
pub(crate) fn chosen_run(catalog: &Catalog, typed: &str) -> Result<RunId, Failure> {
    let runs = catalog.runs()?;
    if typed == "latest" {
        let newest = runs.iter().max_by_key(|run| run.number);
        return newest
            .map(|run| run.id)
            .ok_or_else(|| Failure::new("no run in this store yet: `furrow run MATRIX.toml` makes one"));
    }
    chosen("run", typed, runs.iter().map(|run| run.id))
}

/// The first digits of an id, for people.
pub(crate) fn short(id: ObjectId) -> String {
    id.short()
}
