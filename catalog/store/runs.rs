//! Runs, the outcomes of their cells, and what the work took.

use super::catalog::Catalog;
use crate::CatalogError;
use crate::index::{FailureRow, RunRow, TimingRow};
use crate::records::{self, RunRecord, encode};
use furrow_model::{CellKey, ObjectId, Outcome, RunId};
use std::collections::BTreeSet;

impl Catalog {
    /// Enters a run.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_run(&self, record: &RunRecord) -> Result<RunId, CatalogError> {
        let object = self.objects().write(&encode(record)?)?;
        let id = RunId(object.0);
        self.index().enter_run(id, &record.name, object)?;
        Ok(id)
    }

    /// A run's record.
    ///
    /// # Errors
    /// As [`records::read`].
    pub fn run(&self, id: RunId) -> Result<RunRecord, CatalogError> {
        records::read(self.objects(), ObjectId(id.0))
    }

    /// All runs, the latest last.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn runs(&self) -> Result<Vec<RunRow>, CatalogError> {
        self.index().runs()
    }

    /// A run's row; `None` where there is no such run.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn run_row(&self, id: RunId) -> Result<Option<RunRow>, CatalogError> {
        self.index().run_row(id)
    }

    /// Enters the outcome of a cell. It is remembered among the derivations too: so the submitting process finds what
    /// workers finished.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_outcome(&self, outcome: &Outcome) -> Result<ObjectId, CatalogError> {
        let object = self.objects().write(&encode(outcome)?)?;
        self.objects().remember(ObjectId(outcome.key.0), object)?;
        self.index().enter_outcomes(&[(outcome.key, object)])?;
        Ok(object)
    }

    /// Enters the outcomes that workers finished of these cells; how many that are.
    ///
    /// # Errors
    /// Where a pointer cannot be read, or the index refuses.
    pub fn collect_outcomes(&self, cells: &[CellKey]) -> Result<usize, CatalogError> {
        let found = cells.iter().map(|cell| Ok((*cell, self.objects().derived(ObjectId(cell.0))?)));
        let found = found.collect::<Result<Vec<_>, CatalogError>>()?;
        let found: Vec<(CellKey, ObjectId)> =
            found.into_iter().filter_map(|(cell, object)| Some((cell, object?))).collect();
        self.index().enter_outcomes(&found)?;
        Ok(found.len())
    }

    /// The outcome of a cell, if it was ever finished and is whole.
    ///
    /// # Errors
    /// Where the index or the record cannot be read.
    pub fn outcome(&self, cell: CellKey) -> Result<Option<Outcome>, CatalogError> {
        match self.index().outcome(cell)? {
            Some(object) if self.objects().contains(object) => records::read(self.objects(), object).map(Some),
            _ => Ok(None),
        }
    }

    /// Which of some cells are finished, as far as the index knows.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn finished(&self, cells: &[CellKey]) -> Result<BTreeSet<CellKey>, CatalogError> {
        self.index().finished(cells)
    }

    /// Enters what the stages of a run took.
    ///
    /// # Errors
    /// Where the index refuses.
    pub fn enter_timings(&self, timings: &[TimingRow]) -> Result<(), CatalogError> {
        self.index().enter_timings(timings)
    }

    /// What a stage took lately, the latest first.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn timings(&self, stage: &str, most: u32) -> Result<Vec<TimingRow>, CatalogError> {
        self.index().timings(stage, most)
    }

    /// Enters which of the cells that were tried failed; the others did not, as far as is known.
    ///
    /// # Errors
    /// Where the index refuses.
    pub fn enter_failures(&self, tried: &[CellKey], failed: &[FailureRow]) -> Result<(), CatalogError> {
        self.index().enter_failures(tried, failed)
    }

    /// All cells that failed when they were last tried.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn failures(&self) -> Result<Vec<FailureRow>, CatalogError> {
        self.index().failures()
    }
}
