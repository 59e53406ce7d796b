//! What a run gave: cells, failures, contrasts, doubts and the work.

use crate::evaluate::contrast::{Contrasts, contrasts};
use crate::plan::{Plan, PlannedCell};
use crate::study::run::CellResult;
use crate::study::settings::Study;
use crate::study::work::Work;
use crate::{Blocked, RunError};
use furrow_catalog::Catalog;
use furrow_catalog::index::FailureRow;
use furrow_model::{CellKey, Outcome, RunId};
use std::collections::BTreeMap;

/// What a run gave.
#[derive(Debug, Clone)]
pub struct StudyResult {
    /// Its id: equal plans have equal ids.
    pub run: RunId,
    /// Finished cells with their settings, in the matrix' order.
    pub cells: Vec<(String, CellResult)>,
    /// Cells that failed.
    pub failed: Vec<Failed>,
    /// Cells that were not asked for and are not finished.
    pub left: usize,
    /// Which contenders beat which, where the matrix asks.
    pub contrasts: Contrasts,
    /// What the quality gate doubts of the generators that were used.
    pub doubts: Vec<String>,
    /// What was computed, by kind of stage.
    pub work: BTreeMap<String, Work>,
}

impl StudyResult {
    /// Nothing yet.
    pub(crate) fn of(run: RunId) -> Self {
        Self {
            run,
            cells: Vec::new(),
            failed: Vec::new(),
            left: 0,
            contrasts: Contrasts::default(),
            doubts: Vec::new(),
            work: BTreeMap::new(),
        }
    }

    /// Each doubt once.
    pub(crate) fn add_doubts(&mut self, doubts: Vec<String>) {
        for doubt in doubts {
            if !self.doubts.contains(&doubt) {
                self.doubts.push(doubt);
            }
        }
    }

    /// Remembers which of the cells that were tried failed, and that the others did not.
    pub(crate) fn enter_failures(&self, catalog: &Catalog, tried: &[CellKey]) -> Result<(), RunError> {
        let row = |failed: &Failed| FailureRow { cell: failed.key, run: self.run, reason: failed.cell.reason.clone() };
        Ok(catalog.enter_failures(tried, &self.failed.iter().map(row).collect::<Vec<_>>())?)
    }

    /// With the contrasts of its cells that the study asks for.
    pub(crate) fn contrasted(mut self, catalog: &Catalog, study: &Study) -> Result<Self, RunError> {
        let outcomes: Vec<&Outcome> = self.cells.iter().map(|(_, cell)| &cell.outcome).collect();
        self.contrasts = contrasts(catalog.objects(), study.contrasts(), &outcomes)?;
        Ok(self)
    }
}

/// A cell that failed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failed {
    /// Its key.
    pub key: CellKey,
    /// Its setting.
    pub setting: String,
    /// Its live slot, label and why it failed.
    pub cell: Blocked,
}

impl Failed {
    /// A cell of a plan.
    pub(crate) fn of(part: &Plan, cell: &PlannedCell, reason: String) -> Self {
        let blocked = Blocked { live: part.live(cell.live).record.slot, experience: cell.label.clone(), reason };
        Self { key: cell.key, setting: part.setting.clone(), cell: blocked }
    }
}
