//! One task on a node of the cluster.

use super::job::{Job, StageName, Unit, What};
use super::report::Report;
use crate::RunError;
use crate::plan::{CellIx, ContenderIx, LiveIx, Plan};
use crate::progress::Progress;
use crate::stages::conduct::Conduct;
use crate::stages::executor::Executor;
use crate::stages::graph::Step;
use crate::stages::matching::read_matrix;
use crate::study::run::compute_cells;
use crate::study::some_settings;
use crate::study::work::Clock;
use furrow_catalog::Catalog;
use furrow_model::{CellKey, ExperienceId, TraversalId};
use std::collections::BTreeSet;
use std::path::Path;

/// Which task of which job.
#[derive(Debug, Clone, Copy)]
pub struct Assignment<'a> {
    /// The store's folder.
    pub store: &'a Path,
    /// The job's folder.
    pub folder: &'a Path,
    /// The stage.
    pub stage: StageName,
    /// The number of the task in its stage.
    pub task: usize,
}

/// Computes a task and leaves its report; what failed in it, where something did.
///
/// # Errors
/// Where job or report cannot be read or written.
pub fn work(assignment: Assignment<'_>, progress: Progress<'_>) -> Result<Option<String>, RunError> {
    let Assignment { store, folder, stage, task } = assignment;
    if Report::read(folder, stage, task).is_some_and(|report| report.is_whole()) {
        return Ok(None);
    }
    let job = Job::read(folder)?;
    let units = job.stages.get(&stage).and_then(|tasks| tasks.get(task));
    let units = units.ok_or_else(|| {
        RunError::Slurm(format!("{}: the stage '{}' has no task {task}", folder.display(), stage.name()))
    })?;
    let clock = Clock::new(progress);
    let mut report = Report { threads: rayon::current_num_threads() as u32, ..Report::default() };
    let ended = compute(store, &job, units, &mut report, &|progress| clock.hear(progress));
    if let Err(error) = ended {
        report.fault.get_or_insert_with(|| error.to_string());
    }
    report.work = clock.work();
    report.write(folder, stage, task)?;
    Ok(report.fault.or_else(|| report.failed.first().map(|(_, reason)| reason.clone())))
}

fn compute(
    store: &Path,
    job: &Job,
    units: &[Unit],
    report: &mut Report,
    progress: Progress<'_>,
) -> Result<(), RunError> {
    let catalog = Catalog::detached(store, &job.traversals, &job.generators)?;
    let matrix = read_matrix(&job.path, &job.source)?;
    let settings: BTreeSet<usize> = units.iter().map(|unit| unit.setting).collect();
    let mut study = some_settings(&catalog, matrix, &job.source, |setting| settings.contains(&setting))?;
    for (part, setting) in study.parts.iter_mut().zip(&settings) {
        for unit in units.iter().filter(|unit| unit.setting == *setting) {
            if let Err(error) = one(&catalog, part, &unit.what, report, progress) {
                report.fault.get_or_insert_with(|| error.to_string());
            }
        }
    }
    Ok(())
}

/// Computes a unit: its steps of the plan's graph, and what they need that is not there.
fn one(
    catalog: &Catalog,
    part: &mut Plan,
    what: &What,
    report: &mut Report,
    progress: Progress<'_>,
) -> Result<(), RunError> {
    let keep_going = Conduct { keep_going: true, ..Conduct::default() };
    let wanted: Box<dyn Fn(Step) -> bool + '_> = match what {
        What::Cells(keys) => {
            ask(part, keys)?;
            let cells = compute_cells(catalog, part, keep_going, progress);
            report.failed.extend(cells.failed.into_iter().map(|(cell, reason)| (part.cell(cell).key, reason)));
            return cells.ended;
        }
        What::Verify(keys) => {
            // What fails here fails again with its cells, and is reported there.
            let cells = ask(part, keys)?;
            let mut executor = Executor::new((catalog, part, cells), keep_going, progress)?;
            return executor.walk(|step| matches!(step, Step::Verify(..))).map(drop);
        }
        What::Codebook => Box::new(|step| step == Step::Codebook),
        What::Threshold(id) => {
            let rig = part.live(live_of(part, *id)?).record.rig;
            let part = &*part;
            Box::new(move |step| matches!(step, Step::Threshold(live) if part.live(live).record.rig == rig))
        }
        What::LiveWords(id) => {
            let live = live_of(part, *id)?;
            Box::new(move |step| step == Step::LiveWords(live))
        }
        // An axis may name one experience several times: its steps are there once, under any of its names.
        What::Make(id) => {
            let is_named = named(part, *id)?;
            Box::new(move |step| matches!(step, Step::Make(i) if is_named(i)))
        }
        What::ExperienceWords(id) => {
            let is_named = named(part, *id)?;
            Box::new(move |step| matches!(step, Step::ContenderWords(i) if is_named(i)))
        }
    };
    Executor::new((catalog, part, part.due_cells()), Conduct::default(), progress)?.walk(wanted).map(drop)
}

/// Leaves these cells asked for, and no other; their places in the plan.
fn ask(part: &mut Plan, keys: &[CellKey]) -> Result<Vec<CellIx>, RunError> {
    part.cells.iter_mut().for_each(|cell| cell.asked = keys.contains(&cell.key));
    let cells: Vec<CellIx> = CellIx::all(part.cells.len()).filter(|cell| part.cell(*cell).asked).collect();
    let known: BTreeSet<CellKey> = cells.iter().map(|cell| part.cell(*cell).key).collect();
    match keys.iter().find(|key| !known.contains(key)) {
        Some(_) => Err(other_plan()),
        None => Ok(cells),
    }
}

fn live_of(part: &Plan, id: TraversalId) -> Result<LiveIx, RunError> {
    part.lives.iter().position(|live| live.id == id).map(LiveIx).ok_or_else(other_plan)
}

/// Which contenders are this experience; at least one must be.
fn named(part: &Plan, id: ExperienceId) -> Result<impl Fn(ContenderIx) -> bool + '_, RunError> {
    let is_named = move |i: ContenderIx| part.contender(i).id == id;
    if ContenderIx::all(part.contenders.len()).any(is_named) { Ok(is_named) } else { Err(other_plan()) }
}

fn other_plan() -> RunError {
    RunError::Slurm(
        "this node resolves the matrix to other cells than the submitting machine: furrow there must be the same version, and files that the \
         matrix names must be the same"
            .to_owned(),
    )
}
