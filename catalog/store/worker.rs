//! The store as a worker sees it: detached from its index.

use super::catalog::Catalog;
use super::traversals::row_of;
use crate::CatalogError;
use crate::index::{Index, RecordingRow};
use furrow_model::{ObjectId, TraversalId};
use std::path::Path;

impl Catalog {
    /// The store in `root` as a worker sees it: its objects, and of its rows only those of these traversals and
    /// generators, in memory. The store's own index is not touched; what a worker enters is in the objects, and the
    /// submitting process enters the rows.
    ///
    /// # Errors
    /// Where a record cannot be read.
    pub fn detached(root: &Path, traversals: &[TraversalId], generators: &[ObjectId]) -> Result<Self, CatalogError> {
        let catalog = Self::with_index(root, Index::scratch()?);
        for id in traversals {
            let record = catalog.traversal(*id)?;
            let experience =
                record.experience.map(|id| Ok::<_, CatalogError>((id, catalog.experience(id)?))).transpose()?;
            let recording = RecordingRow { id: record.recording, name: String::new(), bytes: 0, parts: Vec::new() };
            let experience = experience.as_ref().map(|(id, experience)| (*id, experience));
            // Nothing is ingested here: the traversal's own id stands for the request that led to it.
            catalog.index().enter_traversal(&recording, experience, &row_of(*id, &record), ObjectId(id.0))?;
        }
        for id in generators {
            let record = catalog.generator(*id)?;
            catalog.index().enter_generator(*id, &record.name, &record.kind)?;
        }
        Ok(catalog)
    }
}
