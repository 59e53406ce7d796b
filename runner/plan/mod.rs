//! A matrix resolved against the store: exact cells, what is finished, what is blocked and why. Nothing is computed or written here.

mod beside;
mod contrasts;
mod draft;
mod generated;
mod passes;
pub mod suggest;

pub use generated::Making;
pub use passes::{Contender, LivePass, local_date};

use crate::RunError;
use crate::descriptors::DescriptorFile;
use crate::matching::FabMapRules;
use crate::matrix::{Facts, Matrix, Setting, Trainer};
use draft::Draft;
use furrow_catalog::Catalog;
use furrow_catalog::records::{FeatureParameters, RunContrasts};
use furrow_localiser::hub::Policy;
use furrow_model::{CellKey, ObjectId, Outcome, Purpose, TimeSlot};
pub(crate) use passes::Known;
use passes::Passes;
use std::collections::{BTreeMap, BTreeSet};

/// A matrix with everything it needs, or the reasons why not.
pub struct Plan {
    /// The matrix, of one setting.
    pub matrix: Matrix,
    /// What tells it from the other settings of its matrix file; empty where there is one only.
    pub setting: String,
    /// The matrix file's text.
    pub source: String,
    /// The codebook to train or find; `None` where no vocabulary pass exists.
    pub codebook: Option<CodebookPlan>,
    /// The passes behind the codebook.
    pub vocabulary: Vec<LivePass>,
    /// The descriptors that the matrix names, as its cells' keys know them.
    pub(crate) descriptors: Option<DescriptorFile>,
    /// Live passes, in the axis' order.
    pub lives: Vec<LivePass>,
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

/// The images that a codebook is trained on, and how.
#[derive(Debug, Clone)]
pub struct CodebookPlan {
    /// The site.
    pub site: String,
    /// The vocabulary route.
    pub route: String,
    /// Words; 0 where the trainer finds out.
    pub words: u32,
    /// How words are found.
    pub trainer: Trainer,
    /// Sequential: descriptors farther than this from every word become a word.
    pub radius: f64,
    /// Seed of the training.
    pub seed: u64,
    /// SURF's parameters.
    pub features: FeatureParameters,
    /// The images, in order.
    pub images: Vec<VocabularyImage>,
}

/// An image that a codebook is trained on.
#[derive(Debug, Clone, Copy)]
pub struct VocabularyImage {
    /// The left image.
    pub left: ObjectId,
    /// Its calibration record.
    pub calibration: ObjectId,
}

/// A cell that can be run.
#[derive(Debug, Clone)]
pub struct PlannedCell {
    /// Its key.
    pub key: CellKey,
    /// Which of the plan's live passes.
    pub live: usize,
    /// What it is called on the experience axis.
    pub label: String,
    /// Which of the plan's contenders; several in a collective.
    pub members: Vec<usize>,
    /// How a collective chooses among them.
    pub policy: Policy,
    /// Its outcome, where it is finished.
    pub outcome: Option<Outcome>,
    /// Whether the user asks for it now.
    pub asked: bool,
}

impl PlannedCell {
    /// Whether it is to be computed.
    pub fn is_due(&self) -> bool {
        self.asked && self.outcome.is_none()
    }
}

/// A cell that cannot be run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Blocked {
    /// The live slot.
    pub live: TimeSlot,
    /// What it is called on the experience axis.
    pub experience: String,
    /// Why, and what to do.
    pub reason: String,
}

impl Plan {
    /// How FAB-MAP answers a live pass that had travelled so far at each frame.
    pub(crate) fn fabmap_rules<'a>(&self, travelled_m: &'a [f64]) -> FabMapRules<'a> {
        let spacing_m = self.matrix.keyframes.distance_m;
        let motion = self.matrix.localiser.motion.map(|motion| (motion, spacing_m, travelled_m));
        FabMapRules { verified: self.matrix.localiser.candidates, motion }
    }

    /// What rules can ask about a cell.
    pub fn facts(&self, cell: &PlannedCell) -> Facts {
        Facts::of(&self.matrix, &self.lives[cell.live].record.slot.to_string(), &cell.label)
    }
}

/// Something by its label on the experience axis.
type Labelled<T> = (String, T);

/// What a cell localises against.
#[derive(Debug, Clone)]
struct Against {
    label: String,
    members: Vec<usize>,
    policy: Policy,
}

/// What cells localise against, and what they cannot, with the reason.
type Collectives = (Vec<Against>, Vec<Labelled<String>>);

/// What an entry of an axis came to.
enum Found<T> {
    Items(Vec<T>),
    Nothing(String),
}

/// Resolves a matrix of one setting.
///
/// # Errors
/// [`RunError::Plan`] where the matrix makes no sense for this store at all; what only stops single cells is in [`Plan::blocked`].
pub(crate) fn plan(catalog: &Catalog, known: &Known, setting: Setting, source: String) -> Result<Plan, RunError> {
    let matrix = &setting.matrix;
    let passes = Passes::of(catalog, known, matrix)?;
    let vocabulary = passes.load(Purpose::Vocabulary, |row| row.route == matrix.codebook.route)?;
    let mut draft = Draft::new(catalog, &passes, (&setting, &source), vocabulary)?;
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
        descriptors: draft.descriptors,
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

/// Labels that occur once stay; others are numbered in order.
fn number_repeats(labels: &mut [String]) {
    let mut counts: BTreeMap<String, usize> = BTreeMap::new();
    labels.iter().for_each(|label| *counts.entry(label.clone()).or_default() += 1);
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for label in labels {
        if counts[label.as_str()] > 1 {
            let number = seen.entry(label.clone()).or_default();
            *number += 1;
            *label = format!("{label} #{number}");
        }
    }
}
