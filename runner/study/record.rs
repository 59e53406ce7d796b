//! A study as a run's record: what was asked, cell by cell, and all that its cells come from.

use crate::RunError;
use crate::study::run::record;
use crate::study::settings::Study;
use furrow_catalog::Catalog;
use furrow_catalog::records::{RunRecord, record_id};
use furrow_model::{ObjectId, TraversalId};
use std::collections::BTreeSet;

impl Study {
    /// The run's record: what was asked, cell by cell.
    pub fn record(&self, catalog: &Catalog) -> Result<RunRecord, RunError> {
        let mut parts = self.parts.iter().map(record);
        let mut all = parts.next().unwrap_or_else(|| RunRecord {
            name: self.matrix.name.clone(),
            site: self.matrix.site.clone(),
            source: String::new(),
            figures: Vec::new(),
            cells: Vec::new(),
            blocked: Vec::new(),
            traversals: Vec::new(),
            generators: Vec::new(),
            contrasts: Vec::new(),
        });
        for part in parts {
            all.cells.extend(part.cells);
            all.blocked.extend(part.blocked);
            all.contrasts.extend(part.contrasts);
        }
        (all.traversals, all.generators) = self.inputs(catalog)?;
        Ok(all)
    }

    /// The traversals and generators that the cells come from, by id.
    fn inputs(&self, catalog: &Catalog) -> Result<(Vec<TraversalId>, Vec<ObjectId>), RunError> {
        let (mut traversals, mut generators) = (BTreeSet::new(), BTreeSet::new());
        for part in &self.parts {
            traversals.extend(part.vocabulary.iter().chain(&part.lives).map(|traversal| traversal.id));
            for contender in &part.contenders {
                traversals.insert(TraversalId(record_id(&contender.traversal)?.0));
                generators.extend(contender.making.as_ref().map(|making| making.generator));
            }
        }
        let known: BTreeSet<ObjectId> = catalog.generators()?.into_iter().map(|row| row.id).collect();
        for id in generators.intersection(&known) {
            let record = catalog.generator(*id)?;
            traversals.extend(record.source.iter().chain(&record.target).flat_map(|domain| &domain.traversals));
        }
        Ok((traversals.into_iter().collect(), generators.into_iter().collect()))
    }
}
