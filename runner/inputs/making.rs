//! What is to be made: a recorded parent, a generator and a domainness.

use crate::RunError;
use crate::inputs::key::{GENERATED, key_of};
use furrow_catalog::records::{self, GeneratorRecord, record_id};
use furrow_catalog::{CatalogError, Objects};
use furrow_model::{Domainness, Experience, ExperienceId, ObjectId, TimeSlot};

/// How a generated experience of the axis is made.
#[derive(Debug, Clone)]
pub struct Making {
    /// The recorded experience.
    pub parent: Experience,
    /// The slot it was recorded at.
    pub parent_slot: TimeSlot,
    /// The generator.
    pub generator: ObjectId,
    /// Its record.
    pub record: GeneratorRecord,
    /// How far images are moved.
    pub domainness: Domainness,
    /// The slot that the result stands for.
    pub mimics: TimeSlot,
    /// Seeds what is drawn at random.
    pub seed: u64,
    /// Of a command, the digest of its own files.
    pub files: Option<ObjectId>,
    /// Whether it was made before.
    pub made: bool,
}

impl Making {
    /// What to ask of the generator.
    pub fn request(&self) -> Request<'_> {
        Request {
            parent: &self.parent,
            generator: self.generator,
            domainness: self.domainness,
            mimics: self.mimics,
            seed: self.seed,
            files: self.files,
        }
    }
}

/// What to generate.
#[derive(Debug, Clone, Copy)]
pub struct Request<'a> {
    /// The recorded experience.
    pub parent: &'a Experience,
    /// The generator's record.
    pub generator: ObjectId,
    /// How far to move the images.
    pub domainness: Domainness,
    /// The slot that the result stands for.
    pub mimics: TimeSlot,
    /// Seeds what is drawn at random.
    pub seed: u64,
    /// Of a command, the digest of its own files, so that a changed program gives another experience.
    pub files: Option<ObjectId>,
}

/// What was generated.
#[derive(Debug, Clone, PartialEq)]
pub struct Generated {
    /// The experience's id.
    pub id: ExperienceId,
    /// The experience.
    pub experience: Experience,
    /// Images that had to be painted; the others were found.
    pub painted: u32,
}

impl Request<'_> {
    /// The key under which the experience is remembered.
    pub(crate) fn key(&self) -> Result<ObjectId, CatalogError> {
        let inputs = (record_id(self.parent)?, self.generator, self.domainness, self.mimics, self.seed);
        match self.files {
            Some(files) => key_of(GENERATED, &(inputs, files)),
            None => key_of(GENERATED, &inputs),
        }
    }

    /// The experience, if it was ever made.
    ///
    /// # Errors
    /// Where the store cannot be read.
    pub fn known(&self, objects: &Objects) -> Result<Option<Generated>, RunError> {
        let Some(id) = objects.derived(self.key()?)? else { return Ok(None) };
        let experience = records::read(objects, id)?;
        Ok(Some(Generated { id: ExperienceId(id.0), experience, painted: 0 }))
    }
}
