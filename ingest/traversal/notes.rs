//! What is noted on the way about a recording that is accepted, for the user to read.

use furrow_catalog::records::NotesRecord;
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

    /// The record of all that was noted.
    pub(crate) fn into_record(self) -> NotesRecord {
        NotesRecord { notes: self.0.into_inner().unwrap_or_else(PoisonError::into_inner) }
    }
}
