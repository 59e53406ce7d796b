//! A round of jobs: what was left when the round before it had ended. Its folder holds the job, the tasks' logs and
//! their reports.

use super::job::{Job, StageName, job_file};
use super::report::Report;
use crate::RunError;
use furrow_catalog::{Catalog, write_file};
use furrow_model::RunId;
use serde::Serialize;
use std::fs;
use std::path::PathBuf;

/// The file that says that a round was looked at after its end.
const ENDED: &str = "ended";

/// A round.
pub(super) struct Round {
    /// From one.
    pub number: u32,
    /// Where it lies.
    pub folder: PathBuf,
    /// What it is to do.
    pub job: Job,
}

impl Round {
    /// The latest round of a run; none where it never went to a cluster.
    pub fn last(catalog: &Catalog, run: RunId) -> Result<Option<Self>, RunError> {
        let Some(number) = last_number(catalog, run) else { return Ok(None) };
        let folder = folder_of(catalog, run, number);
        Ok(Some(Self { number, job: Job::read(&folder)?, folder }))
    }

    /// The latest round, unless it was looked at after its end: one that its submitter was killed in, or left, was not.
    pub fn open(catalog: &Catalog, run: RunId) -> Result<Option<Self>, RunError> {
        match last_number(catalog, run) {
            Some(number) if !folder_of(catalog, run, number).join(ENDED).exists() => Self::last(catalog, run),
            _ => Ok(None),
        }
    }

    /// The round that comes next, with its folder and job written.
    pub fn begin(catalog: &Catalog, run: RunId, job: Job) -> Result<Self, RunError> {
        let number = last_number(catalog, run).unwrap_or(0) + 1;
        let folder = folder_of(catalog, run, number);
        let wrong = |error: std::io::Error| RunError::Slurm(format!("{}: {error}", folder.display()));
        fs::create_dir_all(&folder).map_err(wrong)?;
        let folder = fs::canonicalize(&folder).map_err(wrong)?;
        job.write(&folder)?;
        Ok(Self { number, folder, job })
    }

    /// Whether it was looked at after its end.
    pub fn has_ended(&self) -> bool {
        self.folder.join(ENDED).exists()
    }

    /// Remembers that it was looked at after its end.
    pub fn close(&self) -> Result<(), RunError> {
        Ok(write_file(&self.folder.join(ENDED), b"")?)
    }

    /// Every task with its report, where it left one.
    pub fn reports(&self) -> impl Iterator<Item = (StageName, usize, Option<Report>)> {
        let tasks = self.job.stages.iter().flat_map(|(stage, tasks)| (0..tasks.len()).map(|task| (*stage, task)));
        tasks.map(|(stage, task)| (stage, task, Report::read(&self.folder, stage, task)))
    }

    /// How far its tasks are.
    pub fn tasks(&self) -> Tasks {
        let mut tasks = Tasks { round: self.number, all: 0, done: 0, failed: 0 };
        for (_, _, report) in self.reports() {
            tasks.all += 1;
            tasks.done += usize::from(report.as_ref().is_some_and(Report::is_whole));
            tasks.failed += usize::from(report.is_some_and(|report| !report.is_whole()));
        }
        tasks
    }
}

/// How far the tasks of a run's latest round are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Tasks {
    /// Which round.
    pub round: u32,
    /// Tasks of all its stages.
    pub all: usize,
    /// Those that ended well.
    pub done: usize,
    /// Those that reported a failure.
    pub failed: usize,
}

/// How far the tasks of a run are; none where it never went to a cluster.
pub fn tasks(catalog: &Catalog, run: RunId) -> Option<Tasks> {
    Round::last(catalog, run).ok().flatten().map(|round| round.tasks())
}

fn folder_of(catalog: &Catalog, run: RunId, round: u32) -> PathBuf {
    catalog.run_folder(run).join(format!("slurm-{round}"))
}

/// The latest round that was begun: one whose job was never written, its submitter being killed, was not.
fn last_number(catalog: &Catalog, run: RunId) -> Option<u32> {
    let names = fs::read_dir(catalog.run_folder(run)).into_iter().flatten().flatten();
    let number = |name: std::ffi::OsString| name.to_str()?.strip_prefix("slurm-")?.parse().ok();
    names.filter(|entry| job_file(&entry.path()).exists()).filter_map(|entry| number(entry.file_name())).max()
}
