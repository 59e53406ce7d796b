//! The words stage: images → SURF → the words of a codebook that each shows.

use crate::RunError;
use crate::inputs::key::{WORDS, key_of};
use crate::inputs::words::{ReadyCodebook, Words};
use crate::progress::{Counter, Progress, Stage, Subject};
use crate::stages::codebook::{left_view, presence_table, presences_from, surf_params};
use furrow_catalog::records::FeatureParameters;
use furrow_catalog::{CatalogError, Objects, Views};
use furrow_localiser::surf::surf;
use furrow_model::{CodebookId, ObjectId};
use rayon::prelude::*;

/// The key of the words of some images.
pub(crate) fn words_key(
    calibration: ObjectId,
    images: &[ObjectId],
    codebook: CodebookId,
    features: FeatureParameters,
) -> Result<ObjectId, CatalogError> {
    key_of(WORDS, &(calibration, images, codebook, features))
}

/// Finds or computes the words of left images of one calibration.
pub(crate) fn words(
    objects: &Objects,
    calibration: ObjectId,
    images: &[ObjectId],
    codebook: &ReadyCodebook,
    features: FeatureParameters,
    (of, progress): (Subject<'_>, Progress<'_>),
) -> Result<Words, RunError> {
    let key = words_key(calibration, images, codebook.id, features)?;
    if let Some(table) = objects.derived(key)? {
        return Ok(Words { table, presences: presences_from(objects.read(table)?, images.len())? });
    }
    let views = Views::load(objects, calibration)?;
    let counter = Counter::new(progress, (Stage::Words, of), images.len());
    let params = surf_params(features);
    let presences = images
        .par_iter()
        .map(|image| {
            let descriptors = surf(&left_view(objects, &views, *image)?, &params).descriptors;
            counter.tick();
            codebook.codebook.vocabulary.presence(&descriptors).map_err(|error| RunError::Codebook(error.to_string()))
        })
        .collect::<Result<Vec<_>, RunError>>()?;
    let table = objects.write(&presence_table(&presences)?)?;
    objects.remember(key, table)?;
    Ok(Words { table, presences })
}
