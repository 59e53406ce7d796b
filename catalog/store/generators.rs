//! What is trained: codebooks and generators, and what the quality gate measured of these.

use super::catalog::Catalog;
use crate::CatalogError;
use crate::index::{GateRow, GeneratorRow};
use crate::records::{self, CodebookRecord, GeneratorRecord, encode};
use furrow_model::{CodebookId, ObjectId};

impl Catalog {
    /// Enters a codebook that was trained.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_codebook(&self, record: &CodebookRecord) -> Result<CodebookId, CatalogError> {
        let id = CodebookId(self.objects().write(&encode(record)?)?.0);
        self.index().enter_codebook(id, &record.site, record.words)?;
        Ok(id)
    }

    /// Enters a generator; it then answers to its name.
    ///
    /// # Errors
    /// Where the disk or the index refuses.
    pub fn enter_generator(&self, record: &GeneratorRecord) -> Result<ObjectId, CatalogError> {
        let id = self.objects().write(&encode(record)?)?;
        self.index().enter_generator(id, &record.name, &record.kind)?;
        Ok(id)
    }

    /// All generators, by name, the latest of each name last.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn generators(&self) -> Result<Vec<GeneratorRow>, CatalogError> {
        self.index().generators()
    }

    /// A generator's record.
    ///
    /// # Errors
    /// As [`records::read`].
    pub fn generator(&self, id: ObjectId) -> Result<GeneratorRecord, CatalogError> {
        records::read(self.objects(), id)
    }

    /// Enters what the quality gate measured, its record and its parent experience being stored.
    ///
    /// # Errors
    /// Where the index refuses.
    pub fn enter_gate(&self, gate: &GateRow) -> Result<(), CatalogError> {
        self.index().enter_gate(gate)
    }

    /// What the quality gate measured of a generator, by experience and domainness.
    ///
    /// # Errors
    /// [`CatalogError::Index`].
    pub fn gates(&self, generator: ObjectId) -> Result<Vec<GateRow>, CatalogError> {
        self.index().gates(generator)
    }
}
