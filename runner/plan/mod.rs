//! A matrix resolved against the store: exact cells, what is finished, what is blocked and why. Nothing is computed or
//! written here.

mod beside;
mod cell;
mod contrasts;
mod crossing;
mod draft;
mod generated;
mod index;
mod judging;
mod leakage;

pub use cell::{Blocked, PlannedCell};
pub use index::{CellIx, ContenderIx, LiveIx};

use crate::RunError;
use crate::inputs::codebook::CodebookPlan;
use crate::inputs::contender::Contender;
use crate::inputs::recogniser::Recogniser;
use crate::inputs::traversals::{Known, LiveTraversal, SiteTraversals};
use crate::matrix::{Facts, Matrix, Setting};
use draft::Draft;
use furrow_catalog::Catalog;
use furrow_catalog::records::RunContrasts;
use furrow_model::Purpose;
use std::collections::BTreeSet;
use std::sync::Arc;

/// A matrix with everything it needs, or the reasons why not.
pub struct Plan {
    /// The matrix, of one setting.
    pub matrix: Matrix,
    /// What tells it from the other settings of its matrix file; empty where there is one only.
    pub setting: String,
    /// The matrix file's text.
    pub source: String,
    /// The codebook to train or find; `None` where no vocabulary traversal exists.
    pub codebook: Option<CodebookPlan>,
    /// The traversals behind the codebook.
    pub vocabulary: Vec<LiveTraversal>,
    /// The place recogniser that the matrix names, as its cells' keys know it.
    pub(crate) recogniser: Arc<dyn Recogniser>,
    /// Live traversals, in the axis' order.
    pub lives: Vec<LiveTraversal>,
    /// Experiences, in the axis' order.
    pub contenders: Vec<Contender>,
    /// The cells that can be run.
    pub cells: Vec<PlannedCell>,
    /// The cells that cannot.
    pub blocked: Vec<Blocked>,
    /// Which cells are set against which; none where the matrix asks for no contrast.
    pub contrasts: Option<RunContrasts>,
    /// What a careful reader should know about the cells that can.
    pub warnings: Vec<String>,
    /// The include and exclude rules, counted in this order, that apply to some cell.
    pub(crate) rules_met: BTreeSet<usize>,
}

impl Plan {
    /// What rules can ask about a cell.
    pub fn facts(&self, cell: &PlannedCell) -> Facts {
        Facts::of(&self.matrix, &self.live(cell.live).record.slot.to_string(), &cell.label)
    }

    /// A live traversal by its place.
    pub fn live(&self, live: LiveIx) -> &LiveTraversal {
        &self.lives[live.0]
    }

    /// A contender by its place.
    pub fn contender(&self, contender: ContenderIx) -> &Contender {
        &self.contenders[contender.0]
    }

    /// A cell by its place.
    pub fn cell(&self, cell: CellIx) -> &PlannedCell {
        &self.cells[cell.0]
    }

    /// The places of the cells that are to be computed.
    pub fn due_cells(&self) -> Vec<CellIx> {
        CellIx::all(self.cells.len()).filter(|cell| self.cell(*cell).is_due()).collect()
    }

    /// The contenders that some cells come to, in order.
    pub(crate) fn members(&self, cells: &[CellIx]) -> BTreeSet<ContenderIx> {
        cells.iter().flat_map(|cell| self.cell(*cell).members.iter().copied()).collect()
    }
}

/// Resolves a matrix of one setting.
///
/// # Errors
/// [`RunError::Plan`] where the matrix makes no sense for this store at all; what only stops single cells is in
/// [`Plan::blocked`].
pub(crate) fn plan(
    catalog: &Catalog,
    known: &Known,
    setting: Setting,
    source: String,
    recogniser: Arc<dyn Recogniser>,
) -> Result<Plan, RunError> {
    let matrix = &setting.matrix;
    let traversals = SiteTraversals::of(catalog, known, matrix)?;
    let vocabulary = traversals.load(Purpose::Vocabulary, |row| row.route == matrix.codebook.route)?;
    let mut draft = Draft::new(catalog, &traversals, (&setting, &source), vocabulary, recogniser);
    for entry in &matrix.axes.live {
        draft.add_live(entry)?;
    }
    for entry in &matrix.axes.experience {
        draft.add_experience(entry.get_ref())?;
    }
    draft.cross()?;
    Ok(Plan {
        codebook: draft.codebook,
        vocabulary: draft.vocabulary,
        recogniser: draft.recogniser,
        lives: draft.lives,
        contenders: draft.contenders,
        cells: draft.cells,
        blocked: draft.blocked,
        contrasts: draft.contrasts,
        warnings: draft.warnings,
        rules_met: draft.rules_met.into_inner(),
        matrix: setting.matrix,
        setting: setting.label,
        source,
    })
}
