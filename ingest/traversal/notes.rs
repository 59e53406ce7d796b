//! What is noted on the way about a recording that is accepted, for the user to read.

use crate::traversal::error::IngestError;
use furrow_catalog::records::{self, NotesRecord};
use furrow_catalog::{Catalog, digest};
use furrow_model::{ObjectId, TraversalId};
use std::sync::{Mutex, PoisonError};

/// Notes, in the order in which they are added; each once.
#[derive(Debug, Default)]
pub(crate) struct Notes(Mutex<Vec<String>>);

impl Notes {
    /// Adds a sentence. Only from the thread that tells the story, so that the order is always the same.
    pub(crate) fn add(&self, note: impl Into<String>) {
        let note = note.into();
        let mut notes = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if !notes.contains(&note) {
            notes.push(note);
        }
    }

    /// Writes the notes for a traversal that is about to be entered into the catalogue.
    pub(crate) fn store(self, catalog: &Catalog, id: TraversalId) -> Result<(), IngestError> {
        keep_notes(catalog, id, self.0.into_inner().unwrap_or_else(PoisonError::into_inner))
    }
}

/// Writes notes for a traversal that is about to be entered into the catalogue.
pub(crate) fn keep_notes(catalog: &Catalog, id: TraversalId, notes: Vec<String>) -> Result<(), IngestError> {
    if !notes.is_empty() {
        let object = catalog.objects().write(&records::encode(&NotesRecord { notes })?)?;
        catalog.objects().remember(key(id), object)?;
    }
    Ok(())
}

/// The notes on a traversal in the catalogue.
///
/// # Errors
/// Where the store cannot be read.
pub fn notes_of(catalog: &Catalog, id: TraversalId) -> Result<Vec<String>, IngestError> {
    match catalog.objects().derived(key(id))? {
        Some(object) => Ok(records::read::<NotesRecord>(catalog.objects(), object)?.notes),
        None => Ok(Vec::new()),
    }
}

fn key(traversal: TraversalId) -> ObjectId {
    digest(format!("notes/1 {traversal}").as_bytes())
}
