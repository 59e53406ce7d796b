//! The words stage: images → SURF → the words of a codebook that each shows.

use crate::RunError;
use crate::inputs::contender::Contender;
use crate::inputs::key::{WORDS, key_of};
use crate::inputs::traversals::LiveTraversal;
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

/// Left images of one calibration, and whose they are.
pub(crate) struct WordImages<'a> {
    calibration: ObjectId,
    images: Vec<ObjectId>,
    of: Subject<'a>,
}

impl<'a> WordImages<'a> {
    /// The frames of a live traversal.
    pub fn of_live(live: &LiveTraversal) -> Self {
        let of = Subject::Live(live.record.slot);
        Self { calibration: live.record.calibration, images: live.images().collect(), of }
    }

    /// The nodes of a contender.
    pub fn of_contender(contender: &'a Contender) -> Self {
        let of = Subject::experience(&contender.label);
        Self { calibration: contender.record.calibration, images: contender.images().collect(), of }
    }
}

/// How words are found: by which codebook, in which features.
#[derive(Clone, Copy)]
pub(crate) struct WordRules<'a> {
    pub codebook: &'a ReadyCodebook,
    pub features: FeatureParameters,
}

/// Finds or computes the words of images.
pub(crate) fn words(
    objects: &Objects,
    images: &WordImages<'_>,
    rules: WordRules<'_>,
    progress: Progress<'_>,
) -> Result<Words, RunError> {
    let key = words_key(images.calibration, &images.images, rules.codebook.id, rules.features)?;
    match objects.derived(key)? {
        Some(table) => Ok(Words { table, presences: presences_from(objects.read(table)?, images.images.len())? }),
        None => compute_words(objects, key, images, rules, progress),
    }
}

/// Computes the words of images if the store does not have them; those that it has are not read.
pub(crate) fn ensure_words(
    objects: &Objects,
    images: &WordImages<'_>,
    rules: WordRules<'_>,
    progress: Progress<'_>,
) -> Result<(), RunError> {
    let key = words_key(images.calibration, &images.images, rules.codebook.id, rules.features)?;
    match objects.derived(key)? {
        Some(_) => Ok(()),
        None => compute_words(objects, key, images, rules, progress).map(drop),
    }
}

fn compute_words(
    objects: &Objects,
    key: ObjectId,
    WordImages { calibration, images, of }: &WordImages<'_>,
    WordRules { codebook, features }: WordRules<'_>,
    progress: Progress<'_>,
) -> Result<Words, RunError> {
    let views = Views::load(objects, *calibration)?;
    let counter = Counter::new(progress, (Stage::Words, of.clone()), images.len());
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
