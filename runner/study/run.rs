//! The story of a run: codebook → threshold → generated experiences → words → matches → verification → decision → evaluation → outcome.

use crate::RunError;
use crate::plan::{LiveIx, Plan, PlannedCell};
use crate::progress::Progress;
use crate::stages::Stages;
use crate::stages::faults::Faults;
use furrow_catalog::Catalog;
use furrow_catalog::records::{BlockedCell, RunCell, RunRecord};
use furrow_model::Outcome;

/// What a cell gave.
#[derive(Debug, Clone, PartialEq)]
pub struct CellResult {
    /// The outcome.
    pub outcome: Outcome,
    /// Whether it was finished before this run.
    pub cached: bool,
}

/// A plan's cells, `None` where one has no outcome; and what the quality gate doubts.
pub(crate) type Cells = (Vec<Option<CellResult>>, Vec<String>);

/// Computes every cell of a plan that is due, within so many bytes of memory.
pub(crate) fn cells_of(
    catalog: &Catalog,
    plan: &Plan,
    memory: Option<u64>,
    faults: &mut Faults,
    progress: Progress<'_>,
) -> Result<Cells, RunError> {
    let mut fresh: Vec<Option<Outcome>> = vec![None; plan.cells.len()];
    let mut doubts = Vec::new();
    if plan.cells.iter().any(PlannedCell::is_due)
        && let Some(mut stages) = Stages::prepare(catalog, plan, faults, progress)?
    {
        stages.memory = memory.unwrap_or(stages.memory);
        doubts.clone_from(&stages.doubts);
        for live in LiveIx::all(plan.lives.len()) {
            stages.run_live(live, &mut fresh, faults)?;
        }
    }
    let cell = |(cell, fresh): (&PlannedCell, Option<Outcome>)| match (&cell.outcome, fresh) {
        (_, Some(outcome)) => Some(CellResult { outcome, cached: false }),
        (Some(outcome), None) => Some(CellResult { outcome: outcome.clone(), cached: true }),
        (None, None) => None,
    };
    Ok((plan.cells.iter().zip(fresh).map(cell).collect(), doubts))
}

/// The run's record: what was asked, cell by cell.
pub fn record(plan: &Plan) -> RunRecord {
    let cell = |cell: &PlannedCell| RunCell {
        key: cell.key,
        live: plan.live(cell.live).record.slot,
        experience: cell.label.clone(),
        setting: plan.setting.clone(),
    };
    let blocked = |blocked: &crate::Blocked| BlockedCell {
        live: blocked.live,
        experience: blocked.experience.clone(),
        reason: blocked.reason.clone(),
        setting: plan.setting.clone(),
    };
    RunRecord {
        name: plan.matrix.name.clone(),
        site: plan.matrix.site.clone(),
        source: plan.source.clone(),
        figures: plan.matrix.report.figures.iter().map(|figure| figure.name().to_owned()).collect(),
        cells: plan.cells.iter().map(cell).collect(),
        blocked: plan.blocked.iter().map(blocked).collect(),
        traversals: Vec::new(),
        generators: Vec::new(),
        contrasts: plan.contrasts.iter().cloned().collect(),
    }
}
