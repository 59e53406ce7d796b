//! A plan in the making: entries of the axes become traversals and contenders, and these are crossed.

use super::cell::{Blocked, PlannedCell};
use super::index::{ContenderIx, LiveIx};
use crate::RunError;
use crate::inputs::codebook::{CodebookPlan, codebook_plan};
use crate::inputs::contender::Contender;
use crate::inputs::recogniser::Recogniser;
use crate::inputs::traversals::{Found, LiveTraversal, SiteTraversals};
use crate::matrix::{ExperienceEntry, Matrix, Setting, TraversalEntry};
use furrow_catalog::Catalog;
use furrow_catalog::records::RunContrasts;
use furrow_model::{ObjectId, TimeSlot};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A plan in the making.
pub(super) struct Draft<'a> {
    pub(super) catalog: &'a Catalog,
    pub(super) traversals: &'a SiteTraversals<'a>,
    pub(super) matrix: &'a Matrix,
    /// What tells the matrix from its file's other settings.
    pub(super) setting: &'a str,
    /// The matrix file's text.
    pub(super) source: &'a str,
    pub(super) codebook: Option<CodebookPlan>,
    pub(super) vocabulary: Vec<LiveTraversal>,
    pub(super) lives: Vec<LiveTraversal>,
    /// Entries of the live axis without a traversal, with the reason.
    pub(super) no_lives: Vec<(TimeSlot, String)>,
    pub(super) contenders: Vec<Contender>,
    /// How many of them are entries of the experience axis; the others, behind them, only stand beside collectives.
    pub(super) axis: usize,
    /// Entries of the experience axis without an experience, with the reason.
    pub(super) no_contenders: Vec<(String, String)>,
    pub(super) cells: Vec<PlannedCell>,
    pub(super) blocked: Vec<Blocked>,
    pub(super) contrasts: Option<RunContrasts>,
    pub(super) warnings: Vec<String>,
    pub(super) recogniser: Arc<dyn Recogniser>,
    /// Why a generator must not be judged on a live traversal, as far as it was asked.
    pub(super) known_leaks: BTreeMap<(LiveIx, ObjectId), Option<String>>,
    pub(super) rules_met: RefCell<BTreeSet<usize>>,
}

impl<'a> Draft<'a> {
    pub(super) fn new(
        catalog: &'a Catalog,
        traversals: &'a SiteTraversals<'a>,
        (setting, source): (&'a Setting, &'a str),
        vocabulary: Vec<LiveTraversal>,
        recogniser: Arc<dyn Recogniser>,
    ) -> Self {
        let Setting { label: setting, matrix } = setting;
        let codebook = (!vocabulary.is_empty()).then(|| codebook_plan(matrix, &vocabulary));
        Self {
            catalog,
            traversals,
            matrix,
            setting,
            source,
            codebook,
            vocabulary,
            lives: Vec::new(),
            no_lives: Vec::new(),
            contenders: Vec::new(),
            axis: 0,
            no_contenders: Vec::new(),
            cells: Vec::new(),
            blocked: Vec::new(),
            contrasts: None,
            warnings: Vec::new(),
            recogniser,
            known_leaks: BTreeMap::new(),
            rules_met: RefCell::default(),
        }
    }

    /// Traversals that several entries name come once.
    pub(super) fn add_live(&mut self, entry: &TraversalEntry) -> Result<(), RunError> {
        match self.traversals.live(entry)? {
            Found::Items(lives) => {
                for live in lives {
                    if !self.lives.iter().any(|known| known.id == live.id) {
                        self.lives.push(live);
                    }
                }
            }
            Found::Nothing(reason) => match entry.slot {
                Some(slot) => self.no_lives.push((slot, reason)),
                None => return Err(RunError::Plan(reason)),
            },
        }
        Ok(())
    }

    pub(super) fn live(&self, live: LiveIx) -> &LiveTraversal {
        &self.lives[live.0]
    }

    pub(super) fn contender(&self, contender: ContenderIx) -> &Contender {
        &self.contenders[contender.0]
    }

    pub(super) fn add_experience(&mut self, entry: &ExperienceEntry) -> Result<(), RunError> {
        match entry {
            ExperienceEntry::Recorded(entry) => match self.traversals.recorded(entry)? {
                Found::Items(contenders) => {
                    for contender in contenders {
                        if !self.contenders.iter().any(|known| known.id == contender.id) {
                            self.contenders.push(contender);
                        }
                    }
                }
                Found::Nothing(reason) => self.no_contenders.push((entry.to_string(), reason)),
            },
            ExperienceEntry::Generated(entry) => self.add_generated(entry)?,
        }
        Ok(())
    }
}
