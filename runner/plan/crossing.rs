//! Every live traversal crossed with every experience and collective: the cells, and those that are blocked.

use super::cell::{Against, Blocked, Collectives, PlannedCell, union_of};
use super::draft::Draft;
use super::index::{ContenderIx, LiveIx};
use crate::RunError;
use crate::inputs::codebook::codebook_key;
use crate::inputs::contender::Contender;
use crate::inputs::key::{CELL, TWO_VIEW, key_of, versions};
use crate::matrix::{Facts, Selection, wanted};
use furrow_catalog::CatalogError;
use furrow_catalog::records::TraversalRecord;
use furrow_localiser::hub::Policy;
use furrow_model::{CellKey, ObjectId, TimeSlot};
use serde_json::json;

impl Draft<'_> {
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
        let vocabulary: Vec<ObjectId> = self.vocabulary.iter().map(|traversal| traversal.record.frames).collect();
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
