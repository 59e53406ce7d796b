//! The submitting process: submits what is left as a round of job arrays, waits, collects; what a round lost goes into
//! the next.

use super::job::Job;
use super::queue::{Array, Queue};
use super::report::tail;
use super::round::{Round, Tasks};
use super::run::Run;
use crate::progress::{Progress, Stage, StageProgress, Subject};
use crate::stages::conduct::Conduct;
use crate::stages::matching::read_matrix;
use crate::study::{Study, StudyResult};
use crate::{RunError, study};
use furrow_catalog::Catalog;
use furrow_model::{CellKey, RunId};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::path::Path;
use std::time::{Duration, Instant};

/// What the submitting process does after it has submitted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Following {
    /// Waits until nothing is left to do.
    Wait,
    /// Leaves: `collect` or the same command come back to it.
    Leave,
}

/// Rounds in which no cell was finished, after which what is lost counts as failed.
const FRUITLESS: u32 = 3;
/// How long Slurm may give no answer: a controller is restarted in minutes.
const SILENCE: Duration = Duration::from_secs(600);
/// Between two looks at the queue, the first and the longest.
const LOOKS: [Duration; 2] = [Duration::from_millis(250), Duration::from_secs(10)];

/// Runs every cell that is asked for and not finished on the cluster, and enters the run. `path` is the matrix file.
///
/// Killed or left, the jobs go on; called again, it finds them, waits for them and goes on from what they finished.
///
/// # Errors
/// [`RunError::Slurm`] where the cluster refuses, or a task failed and nobody asked to keep going.
pub fn run_on_slurm(
    catalog: &Catalog,
    study: &Study,
    path: &Path,
    (queue, conduct, following): (&Queue, Conduct, Following),
    progress: Progress<'_>,
) -> Result<StudyResult, RunError> {
    let run = catalog.enter_run(&study.record(catalog)?)?;
    let _alone = alone(catalog, run)?;
    let asked: BTreeSet<CellKey> = study.cells().filter(|(_, cell)| cell.is_due()).map(|(_, cell)| cell.key).collect();
    let of_run = Run { catalog, study, path, run, queue, conduct, progress };
    let failed = of_run.follow(&asked, following)?;
    let result = of_run.settle(&asked, failed)?;
    match result.failed.first() {
        Some(first) if !conduct.keep_going => Err(RunError::Slurm(format!(
            "live {} against {}: {}\nwhat was finished before stays finished; --keep-going computes what does not hang on this",
            first.cell.live, first.cell.experience, first.cell.reason
        ))),
        _ => Ok(result),
    }
}

/// Enters what workers finished of a run; how many of its cells are finished now, and how many of its tasks wait or
/// run.
///
/// # Errors
/// Where the store or the cluster do not answer.
pub fn collect(catalog: &Catalog, run: RunId, progress: Progress<'_>) -> Result<(usize, usize), RunError> {
    let record = catalog.run(run)?;
    let _alone = alone(catalog, run)?;
    let last = Round::last(catalog, run)?;
    let job = last.ok_or_else(|| RunError::Slurm("this run was never given to a cluster".to_owned()))?.job;
    let study = study(catalog, read_matrix(&job.path, &job.source)?, &job.source)?;
    let keys: BTreeSet<CellKey> = record.cells.iter().map(|cell| cell.key).collect();
    let due: BTreeSet<CellKey> = study
        .cells()
        .map(|(_, cell)| cell)
        .filter(|cell| cell.is_due() && keys.contains(&cell.key))
        .map(|cell| cell.key)
        .collect();
    let queue = Queue::default();
    let conduct = Conduct::default();
    let of_run = Run { catalog, study: &study, path: &job.path, run, queue: &queue, conduct, progress };
    of_run.settle(&due, BTreeMap::new())?;
    let finished = keys.iter().map(|key| Ok(usize::from(catalog.outcome(*key)?.is_some())));
    let finished = finished.collect::<Result<Vec<usize>, RunError>>()?.into_iter().sum();
    Ok((finished, Queue::active(&of_run.name())?.len()))
}

/// Held for as long as one process follows a run: two would submit everything twice.
fn alone(catalog: &Catalog, run: RunId) -> Result<File, RunError> {
    let folder = catalog.run_folder(run);
    let wrong = |error: std::io::Error| RunError::Slurm(format!("{}: {error}", folder.display()));
    std::fs::create_dir_all(&folder).map_err(wrong)?;
    let lock = File::create(folder.join("lock")).map_err(wrong)?;
    lock.try_lock().map_err(|_| {
        RunError::Slurm(format!(
            "another furrow follows run {} already; `furrow status` shows how far it is",
            run.short()
        ))
    })?;
    Ok(lock)
}

impl Run<'_> {
    /// Submits and waits until every cell is finished or has failed; those that failed.
    fn follow(&self, asked: &BTreeSet<CellKey>, following: Following) -> Result<BTreeMap<CellKey, String>, RunError> {
        let mut failed: BTreeMap<CellKey, String> = BTreeMap::new();
        if asked.is_empty() {
            return Ok(failed);
        }
        let mut submitted = Round::open(self.catalog, self.run)?;
        let (mut fruitless, mut left_before) = (0, usize::MAX);
        loop {
            if !self.wait(submitted.as_ref(), following)? {
                return Ok(failed);
            }
            if let Some(round) = &submitted {
                failed.extend(self.end(round)?);
            }
            let mut due = self.unfinished(asked)?;
            due.retain(|key| !failed.contains_key(key));
            if due.is_empty() || (!failed.is_empty() && !self.conduct.keep_going) {
                return Ok(failed);
            }
            fruitless = if due.len() < left_before { 0 } else { fruitless + 1 };
            if let Some(round) = submitted.filter(|_| fruitless == FRUITLESS) {
                let reason = lost(&round);
                return Ok(failed.into_iter().chain(due.into_iter().map(|key| (key, reason.clone()))).collect());
            }
            left_before = due.len();
            submitted = Some(self.submit(&due)?);
        }
    }

    /// Submits a round.
    fn submit(&self, due: &BTreeSet<CellKey>) -> Result<Round, RunError> {
        let wrong = |error: &dyn std::fmt::Display| RunError::Slurm(error.to_string());
        let path = std::fs::canonicalize(self.path).unwrap_or_else(|_| self.path.to_owned());
        let round = Round::begin(self.catalog, self.run, Job::of(self.catalog, self.study, &path, due)?)?;
        let Round { folder, job, .. } = &round;
        let text = |path: &Path| path.to_string_lossy().into_owned();
        let program = std::env::current_exe().map_err(|error| wrong(&error))?;
        let store = std::fs::canonicalize(self.catalog.root()).map_err(|error| wrong(&error))?;
        let mut before: Option<String> = None;
        for (stage, tasks) in &job.stages {
            let command =
                [&text(&program), "worker", "--store", &text(&store), "--job", &text(folder), "--stage", stage.name()];
            let submitted = self.queue.submit(&Array {
                name: &self.name(),
                stage: *stage,
                tasks: tasks.len(),
                after: before.as_deref().map(|job| (job, !self.conduct.keep_going)),
                command: &command.map(str::to_owned),
                folder,
            })?;
            before = Some(submitted);
        }
        Ok(round)
    }

    /// Waits until no job of the run is in the queue; false where the caller asked to leave.
    fn wait(&self, round: Option<&Round>, following: Following) -> Result<bool, RunError> {
        let (mut pause, mut answered) = (LOOKS[0], Instant::now());
        loop {
            let states = match Queue::active(&self.name()) {
                Ok(states) => states,
                Err(error) if answered.elapsed() > SILENCE || round.is_none() => return Err(error),
                Err(_) => {
                    std::thread::sleep(LOOKS[1].min(pause * 2));
                    continue;
                }
            };
            answered = Instant::now();
            if states.is_empty() {
                return Ok(true);
            }
            if following == Following::Leave {
                return Ok(false);
            }
            if let Some(Tasks { all, done, .. }) = round.map(Round::tasks) {
                let running = states.iter().filter(|state| *state == "RUNNING").count();
                let (done, total) = (done as u64, all as u64);
                let of = Subject::Running(running);
                (self.progress)(StageProgress { stage: Stage::ClusterTasks, of, done, total });
            }
            std::thread::sleep(pause);
            pause = LOOKS[1].min(pause.mul_f64(1.3));
        }
    }
}

/// Why cells of a round are not finished that no task reported on.
fn lost(round: &Round) -> String {
    let lost = round.reports().find(|(_, _, report)| report.is_none());
    lost.map_or("the cluster ended all tasks and they left nothing".to_owned(), |(stage, task, _)| {
        let log = match tail(&round.folder, stage, task) {
            log if log.is_empty() => "; it left no log".to_owned(),
            log => format!("; the end of its log in {}:{log}", round.folder.display()),
        };
        format!(
            "{FRUITLESS} times the cluster ended task {} {task} before it was done (out of time or memory?){log}",
            stage.name()
        )
    })
}
