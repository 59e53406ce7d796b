//! The count of images that have the stamp of another, beside a traversal.

use crate::traversal::error::IngestError;
use furrow_catalog::records::{self, DuplicatesRecord};
use furrow_catalog::{Catalog, digest};
use furrow_model::{ObjectId, TraversalId};

/// Writes the count for a traversal that is about to be entered into the catalogue.
pub(crate) fn store_duplicates(catalog: &Catalog, id: TraversalId, images: u64) -> Result<(), IngestError> {
    if images > 0 {
        let object = catalog.objects().write(&records::encode(&DuplicatesRecord { images })?)?;
        catalog.objects().remember(key(id), object)?;
    }
    Ok(())
}

/// The count of a traversal in the catalogue.
pub(crate) fn duplicates_of(catalog: &Catalog, id: TraversalId) -> Result<u64, IngestError> {
    match catalog.objects().derived(key(id))? {
        Some(object) => Ok(records::read::<DuplicatesRecord>(catalog.objects(), object)?.images),
        None => Ok(0),
    }
}

fn key(traversal: TraversalId) -> ObjectId {
    digest(format!("duplicates/1 {traversal}").as_bytes())
}
