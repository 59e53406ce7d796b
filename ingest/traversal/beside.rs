//! What lies beside a traversal: records that are no part of its id, found by a key that names the traversal. None is
//! stored where there is nothing to say.

use crate::traversal::error::IngestError;
use furrow_catalog::records::{self, DuplicatesRecord, NotesRecord, Record, RequestRecord, UnreadableRecord};
use furrow_catalog::{Catalog, digest};
use furrow_model::{ObjectId, TraversalId};

/// A record that lies beside a traversal.
pub(crate) trait Beside: Record + Default + PartialEq {
    /// What its key begins with. It never changes: stores are found by it.
    const KEY: &'static str;
}

impl Beside for DuplicatesRecord {
    const KEY: &'static str = "duplicates/1";
}

impl Beside for NotesRecord {
    const KEY: &'static str = "notes/1";
}

impl Beside for RequestRecord {
    const KEY: &'static str = "asked/1";
}

impl Beside for UnreadableRecord {
    const KEY: &'static str = "unreadable/1";
}

/// Writes a record for a traversal that is about to be entered into the catalogue.
pub(crate) fn keep<R: Beside>(catalog: &Catalog, id: TraversalId, record: &R) -> Result<(), IngestError> {
    if *record != R::default() {
        let object = catalog.objects().write(&records::encode(record)?)?;
        catalog.objects().remember(key::<R>(id), object)?;
    }
    Ok(())
}

/// The record beside a traversal of the catalogue; the empty one where none was stored.
pub(crate) fn read<R: Beside>(catalog: &Catalog, id: TraversalId) -> Result<R, IngestError> {
    Ok(match catalog.objects().derived(key::<R>(id))? {
        Some(object) => records::read(catalog.objects(), object)?,
        None => R::default(),
    })
}

/// What lies beside a traversal and does not depend on its true poses, for another version of it, too.
pub(crate) fn pass_on(catalog: &Catalog, from: TraversalId, to: TraversalId) -> Result<(), IngestError> {
    for key in [key::<DuplicatesRecord>, key::<RequestRecord>, key::<UnreadableRecord>] {
        if let Some(object) = catalog.objects().derived(key(from))? {
            catalog.objects().remember(key(to), object)?;
        }
    }
    Ok(())
}

/// The notes on a traversal in the catalogue.
///
/// # Errors
/// Where the store cannot be read.
pub fn notes_of(catalog: &Catalog, id: TraversalId) -> Result<Vec<String>, IngestError> {
    Ok(read::<NotesRecord>(catalog, id)?.notes)
}

fn key<R: Beside>(traversal: TraversalId) -> ObjectId {
    digest(format!("{} {traversal}", R::KEY).as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;
    use furrow_catalog::records::UnreadableImage;

    #[test]
    fn what_was_lost_is_known_of_a_version_with_other_true_poses() {
        let folder = tempfile::tempdir().unwrap();
        let catalog = Catalog::init(folder.path()).unwrap();
        let (from, to) = (TraversalId([1; 32]), TraversalId([2; 32]));
        let image = UnreadableImage { stamp_ns: 5, side: "left".to_owned(), fault: "cut".to_owned() };
        let unreadable = UnreadableRecord { images: vec![image] };
        let request = RequestRecord { spacing_m: Some(5.0), ..RequestRecord::default() };
        let notes = NotesRecord { notes: vec!["3 of 12 frames have a true pose".to_owned()] };
        keep(&catalog, from, &unreadable).unwrap();
        keep(&catalog, from, &request).unwrap();
        keep(&catalog, from, &DuplicatesRecord { images: 24 }).unwrap();
        keep(&catalog, from, &notes).unwrap();

        pass_on(&catalog, from, to).unwrap();
        assert_eq!(read::<UnreadableRecord>(&catalog, to).unwrap(), unreadable);
        assert_eq!(read::<RequestRecord>(&catalog, to).unwrap(), request);
        assert_eq!(read::<DuplicatesRecord>(&catalog, to).unwrap().images, 24);
        assert_eq!(notes_of(&catalog, from).unwrap(), notes.notes);
        assert!(notes_of(&catalog, to).unwrap().is_empty(), "notes may speak of the poses that it had");
    }
}
