//! Generated entries of a matrix: which experiences they come to, and the placebos that stand beside them. Nothing is
//! painted here.

use super::draft::Draft;
use super::index::ContenderIx;
use crate::RunError;
use crate::generation::{find_generator, mimicked_slot, own_files};
use crate::inputs::contender::parent_of;
use crate::inputs::contender::{Contender, number_repeats};
use crate::inputs::making::Making;
use crate::inputs::traversals::{Found, LiveTraversal};
use crate::matrix::{Collective, GeneratedEntry, Part, Selection, TraversalEntry};
use crate::plan::leakage::{Trained, leak};
use furrow_catalog::records::{GeneratorRecord, TraversalRecord};
use furrow_generator::placebo_set;
use furrow_model::{Domainness, ExperienceId, ObjectId, TimeSlot};
use std::collections::BTreeSet;

/// Whether a part of a selection takes a contender of the axis.
fn takes(part: &Part, contender: &Contender) -> bool {
    match (&contender.making, part) {
        (None, Part::Recorded) => true,
        (None, Part::Slots(slots)) => slots.contains(&contender.slot),
        (Some(making), Part::Generated { parent, by }) => {
            parent.is_none_or(|slot| slot == making.parent_slot)
                && by.as_ref().is_none_or(|name| *name == making.record.name)
        }
        _ => false,
    }
}

impl Draft<'_> {
    /// One experience for each domainness and each recorded parent at the slot.
    pub(super) fn add_generated(&mut self, entry: &GeneratedEntry) -> Result<(), RunError> {
        let label = |z: &Domainness| format!("{} as made by {} at z = {}", entry.parent, entry.generator, z.0);
        let nothing = |reason: &str| entry.domainness.iter().map(|z| (label(z), reason.to_owned())).collect::<Vec<_>>();
        let parents = match self.traversals.recorded(&TraversalEntry::at(entry.parent))? {
            Found::Items(parents) => parents,
            Found::Nothing(reason) => {
                self.no_contenders.extend(nothing(&reason));
                return Ok(());
            }
        };
        let usable =
            find_generator(self.catalog, &entry.generator).and_then(|found| own_files(&found.1).map(|_| found));
        let (generator, record) = match usable {
            Ok(found) => found,
            Err(RunError::Generator { name, reason }) => {
                self.no_contenders.extend(nothing(&format!("generator '{name}': {reason}")));
                return Ok(());
            }
            Err(error) => return Err(error),
        };
        for parent in &parents {
            for z in &entry.domainness {
                let mimics = mimicked_slot(&record, parent.slot, z.0);
                self.add_making(parent, (generator, &record), (*z, mimics), false)?;
            }
        }
        Ok(())
    }

    fn add_making(
        &mut self,
        parent: &Contender,
        (generator, record): (ObjectId, &GeneratorRecord),
        (domainness, mimics): (Domainness, TimeSlot),
        placebo: bool,
    ) -> Result<ContenderIx, RunError> {
        let files = own_files(record)?;
        let mut making = Making {
            parent: parent.record.clone(),
            parent_slot: parent.slot,
            generator,
            record: record.clone(),
            domainness,
            mimics,
            seed: self.matrix.seed,
            files,
            made: false,
        };
        let known = making.request().known(self.catalog.objects())?;
        making.made = known.is_some();
        let id = ExperienceId(making.request().key()?.0);
        // Collectives over the same parents share their placebos.
        if let Some(known) = self.contenders.iter().position(|other| placebo && other.id == id) {
            return Ok(ContenderIx(known));
        }
        self.contenders.push(Contender {
            label: format!("{} as {mimics} ({} z {})", parent.label, record.name, domainness.0),
            slot: mimics,
            id,
            // Until it is made, its parent stands in: stamps, chain and rig are the same.
            record: known.map_or_else(|| parent.record.clone(), |known| known.experience),
            traversal: parent.traversal.clone(),
            making: Some(making),
        });
        Ok(ContenderIx(self.contenders.len() - 1))
    }

    /// The entries of the axis that a selection takes, by their place among the contenders; where a part takes none,
    /// none.
    pub(super) fn selected(&self, selection: &Selection) -> Vec<ContenderIx> {
        let of = |part: &Part| {
            let takes = |i: &ContenderIx| takes(part, self.contender(*i));
            ContenderIx::all(self.axis).filter(takes).collect::<Vec<_>>()
        };
        let parts: Vec<Vec<ContenderIx>> = selection.parts.iter().map(of).collect();
        if parts.iter().any(Vec::is_empty) {
            return Vec::new();
        }
        let all: BTreeSet<ContenderIx> = parts.into_iter().flatten().collect();
        all.into_iter().collect()
    }

    /// A collective with a placebo of the same parent in place of each generated member; recorded members stay. Or why
    /// there is none.
    pub(super) fn placebos(
        &mut self,
        collective: &Collective,
        members: &[ContenderIx],
    ) -> Result<Result<Vec<ContenderIx>, String>, RunError> {
        let mut parents: Vec<(Contender, usize)> = Vec::new();
        let mut places = Vec::new();
        for i in members {
            let Some(parent) = parent_of(self.contender(*i))? else {
                places.push(*i);
                continue;
            };
            match parents.iter_mut().find(|(known, _)| known.id == parent.id) {
                Some((_, count)) => *count += 1,
                None => parents.push((parent, 1)),
            }
        }
        if parents.is_empty() {
            return Ok(Err(format!(
                "placebos stand for generated experiences, and \"{}\" has recorded ones only: set placebo = false or select generated ones",
                collective.of.get_ref()
            )));
        }
        for (parent, count) in parents {
            for placebo in placebo_set(count) {
                let (generator, record) = find_generator(self.catalog, &placebo.name())?;
                places.push(self.add_making(&parent, (generator, &record), (Domainness(1.0), parent.slot), true)?);
            }
        }
        Ok(Ok(places))
    }

    /// Contenders of one name are numbered.
    pub(super) fn number_labels(&mut self) {
        let mut labels: Vec<String> = self.contenders.iter().map(|contender| contender.label.clone()).collect();
        number_repeats(&mut labels);
        self.contenders.iter_mut().zip(labels).for_each(|(contender, label)| contender.label = label);
    }

    /// Why a generated experience must not be judged on a traversal: its generator was trained on it.
    pub(super) fn generator_leak(
        &self,
        contender: &Contender,
        judged: &TraversalRecord,
        images: impl Iterator<Item = ObjectId> + Clone,
    ) -> Result<Option<String>, RunError> {
        let Some(making) = &contender.making else { return Ok(None) };
        let domains = || making.record.source.iter().chain(&making.record.target);
        let traversals =
            domains().flat_map(|domain| &domain.traversals).map(|id| LiveTraversal::load(self.catalog, *id));
        let traversals = traversals.collect::<Result<Vec<_>, _>>()?;
        let name = format!("generator '{}'", making.record.name);
        let trained = Trained { what: &format!("{name}'s training traversal"), traversals: &traversals };
        if let Some(reason) = leak(self.catalog.objects(), &trained, judged, images.clone())? {
            return Ok(Some(reason));
        }
        // Models that were trained elsewhere name images only.
        let shared = images.filter(|image| domains().any(|domain| domain.images.contains(image))).count();
        Ok((shared > 0).then(|| {
            format!(
                "{name} was trained on {shared} images of the {} traversal on route '{}': train it on others",
                judged.slot, judged.route
            )
        }))
    }
}
