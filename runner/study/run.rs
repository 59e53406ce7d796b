//! The story of a run: codebook → threshold → generated experiences → words → matches → verification → decision →
//! evaluation → outcome.

use crate::RunError;
use crate::plan::{CellIx, Plan, PlannedCell};
use crate::progress::Progress;
use crate::stages::conduct::Conduct;
use crate::stages::executor::Executor;
use furrow_catalog::Catalog;
use furrow_catalog::records::{BlockedCell, RunCell, RunRecord};
use furrow_model::Outcome;
use std::collections::BTreeMap;

/// What a cell gave.
#[derive(Debug, Clone, PartialEq)]
pub struct CellResult {
    /// The outcome.
    pub outcome: Outcome,
    /// Whether it was finished before this run.
    pub cached: bool,
}

/// What a plan's cells came to.
pub(crate) struct Cells {
    /// Each cell, `None` where one has no outcome.
    pub results: Vec<Option<CellResult>>,
    /// Those that failed, with the reason.
    pub failed: Vec<(CellIx, String)>,
    /// What the quality gate doubts.
    pub doubts: Vec<String>,
    /// Why the others were not computed either, where the first failure ended it.
    pub ended: Result<(), RunError>,
}

/// Computes every cell of a plan that is due, by walking its graph.
pub(crate) fn compute_cells(catalog: &Catalog, plan: &Plan, conduct: Conduct, progress: Progress<'_>) -> Cells {
    let mut cells = Cells { results: Vec::new(), failed: Vec::new(), doubts: Vec::new(), ended: Ok(()) };
    let mut fresh: BTreeMap<CellIx, Outcome> = BTreeMap::new();
    let due = plan.due_cells();
    if !due.is_empty() {
        match Executor::new((catalog, plan, due), conduct, progress) {
            Ok(mut executor) => {
                cells.ended = executor.walk(|_| true).map(|outcomes| fresh.extend(outcomes));
                cells.failed = executor.failed_cells();
                cells.doubts.clone_from(&executor.shared().doubts);
            }
            Err(error) => cells.ended = Err(error),
        }
    }
    let result = |(i, cell): (CellIx, &PlannedCell)| match (&cell.outcome, fresh.remove(&i)) {
        (_, Some(outcome)) => Some(CellResult { outcome, cached: false }),
        (Some(outcome), None) => Some(CellResult { outcome: outcome.clone(), cached: true }),
        (None, None) => None,
    };
    cells.results = CellIx::all(plan.cells.len()).zip(&plan.cells).map(result).collect();
    cells
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
