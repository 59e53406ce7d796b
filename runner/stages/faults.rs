//! What failed, and what still can be computed.

use crate::RunError;
use crate::plan::CellIx;
use std::collections::BTreeMap;

/// Cells that failed, and whether the others go on.
pub(crate) struct Faults {
    pub keep_going: bool,
    /// The first failure of each cell.
    reasons: BTreeMap<CellIx, String>,
}

impl Faults {
    pub fn new(keep_going: bool) -> Self {
        Self { keep_going, reasons: BTreeMap::new() }
    }

    /// Cells by their place in the plan, with the reason.
    pub fn reasons(&self) -> impl Iterator<Item = (CellIx, String)> + '_ {
        self.reasons.iter().map(|(cell, reason)| (*cell, reason.clone()))
    }

    /// What was computed for some cells; where it failed and the others go on, nothing.
    pub fn take<T>(
        &mut self,
        computed: Result<T, RunError>,
        cells: impl IntoIterator<Item = CellIx>,
    ) -> Result<Option<T>, RunError> {
        match computed {
            Ok(value) => Ok(Some(value)),
            Err(error) => {
                let reason = error.to_string();
                cells.into_iter().for_each(|cell| _ = self.reasons.entry(cell).or_insert_with(|| reason.clone()));
                if self.keep_going { Ok(None) } else { Err(error) }
            }
        }
    }

    pub fn spares(&self, cell: CellIx) -> bool {
        !self.reasons.contains_key(&cell)
    }
}
