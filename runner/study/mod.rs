//! A whole matrix file: every setting planned, then run one after the other, as one run; then the contrasts of its
//! cells.

pub mod compare;
pub mod estimate;
mod record;
pub mod reproduce;
mod result;
pub mod run;
mod settings;
pub mod work;

pub use result::{Failed, StudyResult};
pub(crate) use settings::some_settings;
pub use settings::{Study, study};

use crate::RunError;
use crate::plan::Plan;
use crate::progress::{Progress, Stage};
use crate::stages::conduct::Conduct;
use crate::study::run::compute_cells;
use crate::study::work::{Clock, Work, rows};
use furrow_catalog::Catalog;
use furrow_catalog::index::TimingRow;
use furrow_model::CellKey;

/// Runs every cell that is asked for and not finished, and enters the run.
///
/// # Errors
/// [`RunError`], unless asked to keep going: then what failed is in the result. What was finished before stays
/// finished.
pub fn run(
    catalog: &Catalog,
    study: &Study,
    conduct: Conduct,
    progress: Progress<'_>,
) -> Result<StudyResult, RunError> {
    // The run is known from its plan: entered first, it shows in `status` also where it is killed.
    let run = catalog.enter_run(&study.record(catalog)?)?;
    let clock = Clock::new(progress);
    let mut result = StudyResult::of(run);
    let ended = study.parts.iter().try_for_each(|part| run_part(catalog, part, conduct, &clock, &mut result));
    result.work = clock.work();
    catalog.enter_timings(&rows(&result.work))?;
    let tried: Vec<CellKey> = study.cells().filter(|(_, cell)| cell.is_due()).map(|(_, cell)| cell.key).collect();
    result.enter_failures(catalog, &tried)?;
    ended?;
    result.contrasted(catalog, study)
}

fn run_part(
    catalog: &Catalog,
    part: &Plan,
    conduct: Conduct,
    clock: &Clock<'_>,
    result: &mut StudyResult,
) -> Result<(), RunError> {
    let trained_before = clock.work_of(Stage::VocabularyTraining);
    let cells = compute_cells(catalog, part, conduct, &|progress| clock.hear(progress));
    enter_training(catalog, part, clock.work_of(Stage::VocabularyTraining), trained_before)?;
    result.failed.extend(cells.failed.iter().map(|(i, reason)| Failed::of(part, part.cell(*i), reason.clone())));
    cells.ended?;
    let finished = cells.results.iter().flatten().count();
    result.left += cells.results.len() - finished - cells.failed.len();
    result.cells.extend(cells.results.into_iter().flatten().map(|cell| (part.setting.clone(), cell)));
    result.add_doubts(cells.doubts);
    Ok(())
}

/// Remembers what training a codebook took, by its id; where a killed training was taken up, what its rest took.
fn enter_training(catalog: &Catalog, part: &Plan, now: Work, before: Work) -> Result<(), RunError> {
    let Some(spec) = &part.codebook else { return Ok(()) };
    let Some(id) = catalog.objects().derived(crate::inputs::codebook::codebook_key(spec)?)? else { return Ok(()) };
    if now.units == before.units {
        return Ok(());
    }
    let row = TimingRow {
        stage: "codebook".to_owned(),
        subject: id.to_string(),
        units: spec.images.len() as u64,
        seconds: now.seconds - before.seconds,
        threads: rayon::current_num_threads() as u32,
    };
    Ok(catalog.enter_timings(&[row])?)
}
