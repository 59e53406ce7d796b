//! A plan in the making: entries of the axes become traversals and contenders, and these are crossed.

use super::cell::{Against, Blocked, Collectives, PlannedCell, union_of};
use super::index::{ContenderIx, LiveIx};
use crate::RunError;
use crate::inputs::codebook::codebook_key;
use crate::inputs::codebook::{CodebookPlan, VocabularyImage};
use crate::inputs::contender::Contender;
use crate::inputs::key::{CELL, TWO_VIEW, key_of, versions};
use crate::inputs::recogniser::Recogniser;
use crate::inputs::sampling::spread;
use crate::inputs::traversals::{Found, LiveTraversal, SiteTraversals};
use crate::matrix::{ExperienceEntry, Facts, Matrix, Selection, Setting, TraversalEntry, wanted};
use crate::plan::leakage::{Trained, leak};
use furrow_catalog::records::{FeatureParameters, RunContrasts, TraversalRecord};
use furrow_catalog::{Catalog, CatalogError};
use furrow_localiser::hub::Policy;
use furrow_model::{CellKey, ObjectId, TimeSlot};
use serde_json::json;
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

    /// Every live traversal with every experience, then with every collective.
    pub(super) fn cross(&mut self) -> Result<(), RunError> {
        self.number_labels();
        self.axis = self.contenders.len();
        let single = |(i, contender): (usize, &Contender)| Against {
            label: contender.label.clone(),
            members: vec![ContenderIx(i)],
            policy: Policy::All,
        };
        let mut against: Vec<Against> = self.contenders.iter().enumerate().map(single).collect();
        let (collectives, none) = self.collectives()?;
        against.extend(collectives);
        let leaks = self.leaks()?;
        for live in LiveIx::all(self.lives.len()) {
            let refused = self.refusal(live)?;
            for against in &against {
                if !self.is_wanted(self.live(live).record.slot, &against.label) {
                    continue;
                }
                let leak = against.members.iter().find_map(|i| leaks[i.0].clone());
                let reason = match refused.clone().or(leak) {
                    None => self.generators_leak(live, &against.members)?,
                    known => known,
                };
                self.add_cell(live, against, reason.as_deref())?;
            }
            for (label, reason) in self.no_contenders.clone().iter().chain(&none) {
                self.block(self.live(live).record.slot, label, reason);
            }
        }
        for (slot, reason) in self.no_lives.clone() {
            for against in &against {
                self.block(slot, &against.label, &reason);
            }
            for (label, _) in self.no_contenders.clone().iter().chain(&none) {
                self.block(slot, label, &reason);
            }
        }
        self.contrasts = self.resolve_contrasts(&against, &none)?;
        self.warnings.extend(self.contrasts.iter().flat_map(|contrasts| contrasts.warnings.clone()));
        Ok(())
    }

    /// The collectives that have members, and those that have none with the reason.
    fn collectives(&mut self) -> Result<Collectives, RunError> {
        let (mut found, mut none) = (Vec::new(), Vec::new());
        for collective in &self.matrix.collective {
            let of = collective.of.get_ref();
            let members = Selection::parse(of).map(|selection| self.selected(&selection)).unwrap_or_default();
            let (label, policy) = (collective.name.clone(), *collective.policy.get_ref());
            let (placebo, parents) = (format!("{label} (placebo)"), format!("{label} (parents)"));
            let refused = if members.is_empty() {
                Some(format!("\"{of}\" selects no experience of the axis that exists"))
            } else if policy.needed() as usize > members.len() {
                Some(format!("{} experiences cannot agree among {}", policy.needed(), members.len()))
            } else {
                None
            };
            if let Some(reason) = refused {
                none.extend(collective.placebo.then(|| (placebo, reason.clone())));
                none.extend(collective.parents.then(|| (parents, reason.clone())));
                none.push((label, reason));
                continue;
            }
            let placebos = collective.placebo.then(|| self.placebos(collective, &members)).transpose()?;
            let recorded = collective.parents.then(|| self.parents(&members)).transpose()?;
            let first = if collective.union { union_of(&label, &members) } else { Vec::new() };
            found.push(Against { label, members, policy });
            match placebos {
                Some(Ok(members)) => found.push(Against { label: placebo, members, policy }),
                Some(Err(reason)) => none.push((placebo, reason)),
                None => {}
            }
            match recorded {
                // A single parent of the axis has its own cells.
                Some(Ok(members)) if members.len() == 1 && members[0].0 < self.axis => {}
                Some(Ok(members)) => found.push(Against { label: parents, members, policy: Policy::All }),
                Some(Err(reason)) => none.push((parents, reason)),
                None => {}
            }
            found.extend(first);
        }
        Ok((found, none))
    }

    /// Whether the rules of the matrix want a cell.
    pub(super) fn is_wanted(&self, live: TimeSlot, label: &str) -> bool {
        let facts = Facts::of(self.matrix, &live.to_string(), label);
        wanted(&self.matrix.include, &self.matrix.exclude, &facts, &mut self.rules_met.borrow_mut())
    }

    /// Why no cell of a live traversal can be run.
    fn refusal(&self, live: LiveIx) -> Result<Option<String>, RunError> {
        if self.codebook.is_none() {
            return Ok(Some(self.traversals.no_vocabulary()));
        }
        let live = self.live(live);
        leak(self.catalog.objects(), &self.codebook_training(), &live.record, live.images())
    }

    fn codebook_training(&self) -> Trained<'_> {
        Trained { what: "the codebook's vocabulary traversal", traversals: &self.vocabulary }
    }

    /// Why a generator among the members must not be judged on a live traversal; looked up once for each generator.
    fn generators_leak(&mut self, live: LiveIx, members: &[ContenderIx]) -> Result<Option<String>, RunError> {
        for i in members {
            let Some(making) = &self.contender(*i).making else { continue };
            let key = (live, making.generator);
            if !self.known_leaks.contains_key(&key) {
                let traversal = self.live(live);
                let images: Vec<ObjectId> = traversal.images().collect();
                let leak = self.generator_leak(self.contender(*i), &traversal.record, images.into_iter())?;
                self.known_leaks.insert(key, leak);
            }
            if let Some(Some(reason)) = self.known_leaks.get(&key) {
                return Ok(Some(reason.clone()));
            }
        }
        Ok(None)
    }

    /// For each experience, why the codebook or its own generator must not be judged on it: looked up once, whatever
    /// cells it is in.
    fn leaks(&self) -> Result<Vec<Option<String>>, RunError> {
        let leak_of = |contender: &Contender| {
            let trained = self.codebook_training();
            let parents = contender.making.as_ref().map_or(&contender.record, |making| &making.parent);
            let images = parents.nodes.iter().map(|node| node.left);
            match leak(self.catalog.objects(), &trained, &contender.traversal, images.clone())? {
                None => self.generator_leak(contender, &contender.traversal, images),
                known => Ok(known),
            }
        };
        self.contenders.iter().map(leak_of).collect()
    }

    fn add_cell(&mut self, live: LiveIx, against: &Against, refused: Option<&str>) -> Result<(), RunError> {
        let Against { label, members, policy } = against;
        let slot = self.live(live).record.slot;
        if let Some(reason) = refused {
            self.block(slot, label, reason);
            return Ok(());
        }
        let other_rig = members.iter().find(|i| self.contender(**i).record.rig != self.live(live).record.rig);
        if let Some(i) = other_rig {
            let reason = format!(
                "experience {} was recorded with another rig or calibration than the live traversal: verification needs the same",
                self.contender(*i).id.short()
            );
            self.block(slot, label, &reason);
            return Ok(());
        }
        let of_members: Vec<&Contender> = members.iter().map(|i| self.contender(*i)).collect();
        if let Some(reason) = self.recogniser.missing(self.live(live), &of_members) {
            self.block(slot, label, &reason);
            return Ok(());
        }
        for i in members {
            let shared = self.live(live).shared_images(self.contender(*i));
            if shared > 0 && members.len() == 1 {
                self.warnings.push(format!(
                    "live {slot} and experience {label} share {shared} images: matching them proves nothing"
                ));
            }
        }
        if *policy == Policy::Oracle && !self.has_truth(live, members) {
            let reason = "the oracle needs a ground truth of the live traversal and of every member: ingest them with --ground-truth";
            self.block(slot, label, reason);
            return Ok(());
        }
        let key = self.cell_key(live, members, *policy)?;
        let outcome = self.catalog.outcome(key)?.map(|outcome| outcome.named(label));
        let (label, members, policy) = (label.clone(), members.clone(), *policy);
        self.cells.push(PlannedCell { key, live, label, members, policy, outcome, asked: true });
        Ok(())
    }

    /// Whether live traversal and members come with true positions.
    fn has_truth(&self, live: LiveIx, members: &[ContenderIx]) -> bool {
        let known = |record: &TraversalRecord| {
            record.ground_truth.is_some() || record.sensors.iter().any(|sensor| sensor.kind == "nav_sat_fix")
        };
        known(&self.live(live).record) && members.iter().all(|i| known(&self.contender(*i).traversal))
    }

    pub(super) fn block(&mut self, live: TimeSlot, label: &str, reason: &str) {
        if !self.is_wanted(live, label) {
            return;
        }
        self.blocked.push(Blocked { live, experience: label.to_owned(), reason: reason.to_owned() });
    }

    /// Everything that determines a cell's outcome.
    fn cell_key(&self, live: LiveIx, members: &[ContenderIx], policy: Policy) -> Result<CellKey, CatalogError> {
        let members: Vec<_> =
            members.iter().map(|i| (self.contender(*i).id, self.contender(*i).traversal.ground_truth)).collect();
        let codebook =
            self.codebook.as_ref().filter(|_| self.recogniser.needs_codebook()).map(codebook_key).transpose()?;
        let vocabulary: Vec<ObjectId> = self.vocabulary.iter().map(|pass| pass.record.frames).collect();
        let matrix = self.matrix;
        // How a pair is verified is among the versions of every key.
        let single = !self.live(live).record.rig.is_pair();
        let recogniser = self.recogniser.cell_key_part();
        let method = if single { json!([recogniser, TWO_VIEW]) } else { recogniser };
        let judged = (matrix.verification.threshold, policy, matrix.evaluation.censored, matrix.seed);
        let parameters = (method, matrix.localiser.candidates, judged);
        let inputs = (self.live(live).id, members, codebook, vocabulary, matrix.keyframes, parameters, versions());
        Ok(CellKey(key_of(CELL, &inputs)?.0))
    }
}

/// The images of the vocabulary traversals, evenly spread where there are more than the matrix wants.
fn codebook_plan(matrix: &Matrix, vocabulary: &[LiveTraversal]) -> CodebookPlan {
    let all: Vec<VocabularyImage> = vocabulary
        .iter()
        .flat_map(|traversal| {
            traversal
                .frames
                .iter()
                .map(|frame| VocabularyImage { left: frame.left, calibration: traversal.record.calibration })
        })
        .collect();
    CodebookPlan {
        site: matrix.site.clone(),
        route: matrix.codebook.route.clone(),
        words: matrix.codebook.words,
        trainer: matrix.codebook.trainer,
        radius: matrix.codebook.radius,
        seed: matrix.seed,
        features: FeatureParameters { hessian: matrix.features.hessian, upright: matrix.features.upright },
        images: spread(&all, matrix.codebook.images.max(1)),
    }
}
