//! The codebook stage: vocabulary images → SURF → vocabulary, Chow-Liu tree, sample descriptors.

use super::training;
use crate::RunError;
use crate::inputs::codebook::{CodebookPlan, VocabularyImage};
use crate::inputs::codebook::{KMEANS, SEQUENTIAL, codebook_key};
use crate::inputs::table::{column, encode};
use crate::inputs::words::ReadyCodebook;
use crate::matrix::Trainer;
use crate::progress::{Counter, Progress, Stage, StageProgress, Subject};
use furrow_catalog::images::Side;
use furrow_catalog::records::{CodebookRecord, FeatureParameters};
use furrow_catalog::{Catalog, Objects, Views, records, tables};
use furrow_localiser::codebook::CodebookParams;
use furrow_localiser::surf::{Descriptor, SurfParams, surf};
use furrow_localiser::vocabulary::train_sequential;
use furrow_localiser::{ChowLiuTree, Codebook, Presence, Vocabulary};
use furrow_model::{CodebookId, GreyImage, ObjectId};
use polars::prelude::DataFrame;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// openFABMAP's least information of a tree's edge.
const INFORMATION_THRESHOLD_NATS: f64 = 0.0005;

/// SURF as the matrix asks for it.
pub(crate) fn surf_params(features: FeatureParameters) -> SurfParams {
    SurfParams { hessian_threshold: features.hessian as f32, upright: features.upright, ..SurfParams::GOLDEN }
}

/// Finds the codebook, or trains it.
pub(crate) fn find_or_train_codebook(
    catalog: &Catalog,
    plan: &CodebookPlan,
    progress: Progress<'_>,
) -> Result<ReadyCodebook, RunError> {
    let objects = catalog.objects();
    let key = codebook_key(plan)?;
    if let Some((id, record)) = trained(catalog, plan)? {
        return Ok(ReadyCodebook { id, codebook: load(objects, &record)? });
    }
    let descriptors = descriptors(objects, plan, progress)?;
    let wrong = |error: &dyn std::fmt::Display| RunError::Codebook(error.to_string());
    let params = |words: usize| CodebookParams {
        words,
        seed: plan.seed,
        information_threshold_nats: INFORMATION_THRESHOLD_NATS,
    };
    let (vocabulary, quantisation_error, trainer) = match plan.trainer {
        Trainer::KMeans => {
            let sample = Codebook::sample(&descriptors, &params(plan.words as usize)).map_err(|error| wrong(&error))?;
            let (vocabulary, trained) = training::train(catalog, key, sample, progress)?;
            (vocabulary, trained.quantisation_error, KMEANS)
        }
        Trainer::Sequential => {
            let all: Vec<Descriptor> = descriptors.iter().flatten().copied().collect();
            progress(StageProgress::whole(Stage::VocabularyTraining, 0, 1));
            let vocabulary = train_sequential(&all, plan.radius).map_err(|error| wrong(&error))?;
            let nearest = vocabulary.nearest(&all).map_err(|error| wrong(&error))?;
            let sum: f64 = nearest.iter().map(|nearest| nearest.squared_distance).sum();
            progress(StageProgress::whole(Stage::VocabularyTraining, 1, 1));
            (vocabulary, (sum / all.len().max(1) as f64).sqrt(), SEQUENTIAL)
        }
    };
    let words = if plan.words > 0 { plan.words as usize } else { vocabulary.len() };
    let codebook = Codebook::of_vocabulary(vocabulary, &descriptors, &params(words)).map_err(|error| wrong(&error))?;
    let record = CodebookRecord {
        site: plan.site.clone(),
        route: plan.route.clone(),
        images: plan.images.iter().map(|image| image.left).collect(),
        words: words as u32,
        features: plan.features,
        trainer: trainer.to_owned(),
        seed: plan.seed,
        quantisation_error,
        vocabulary: objects.write(&vocabulary_table(&codebook.vocabulary)?)?,
        tree: objects.write(&tree_table(&codebook.tree)?)?,
        samples: objects.write(&presence_table(&codebook.samples)?)?,
    };
    let id = catalog.enter_codebook(&record)?;
    objects.remember(key, ObjectId(id.0))?;
    training::forget(catalog, key);
    Ok(ReadyCodebook { id, codebook })
}

/// The codebook's record, where it is trained. Enters it: a worker on a cluster has no index to enter what it trained
/// in.
pub(crate) fn trained(
    catalog: &Catalog,
    plan: &CodebookPlan,
) -> Result<Option<(CodebookId, CodebookRecord)>, RunError> {
    let Some(id) = catalog.objects().derived(codebook_key(plan)?)? else { return Ok(None) };
    let record = records::read(catalog.objects(), id)?;
    Ok(Some((catalog.enter_codebook(&record)?, record)))
}

fn descriptors(
    objects: &Objects,
    plan: &CodebookPlan,
    progress: Progress<'_>,
) -> Result<Vec<Vec<Descriptor>>, RunError> {
    let views: BTreeMap<ObjectId, Views> = views_of(objects, plan.images.iter().map(|image| image.calibration))?;
    let counter = Counter::new(progress, (Stage::VocabularyFeatures, Subject::Whole), plan.images.len());
    let params = surf_params(plan.features);
    plan.images
        .par_iter()
        .map(|image: &VocabularyImage| {
            let view = left_view(objects, &views[&image.calibration], image.left)?;
            let descriptors = surf(&view, &params).descriptors;
            counter.tick();
            Ok(descriptors)
        })
        .collect()
}

/// The views of some calibrations.
pub(crate) fn views_of(
    objects: &Objects,
    calibrations: impl Iterator<Item = ObjectId>,
) -> Result<BTreeMap<ObjectId, Views>, RunError> {
    let mut views = BTreeMap::new();
    for id in calibrations {
        if let std::collections::btree_map::Entry::Vacant(entry) = views.entry(id) {
            entry.insert(Views::load(objects, id)?);
        }
    }
    Ok(views)
}

/// A stored left image, rectified.
pub(crate) fn left_view(objects: &Objects, views: &Views, image: ObjectId) -> Result<GreyImage, RunError> {
    Ok(views.grey_of(objects, Side::Left, image)?)
}

fn vocabulary_table(vocabulary: &Vocabulary) -> Result<Vec<u8>, RunError> {
    let columns = (0..64).map(|d| column(&format!("d{d}"), vocabulary.words().iter().map(|word| word[d]))).collect();
    Ok(encode("vocabulary", vocabulary.len(), columns)?)
}

fn tree_table(tree: &ChowLiuTree) -> Result<Vec<u8>, RunError> {
    let columns = vec![
        column("parent", tree.parent().iter().copied()),
        column("p_present", tree.p_present().iter().copied()),
        column("p_present_given_parent_present", tree.p_present_given_parent_present().iter().copied()),
        column("p_present_given_parent_absent", tree.p_present_given_parent_absent().iter().copied()),
    ];
    Ok(encode("Chow-Liu tree", tree.words(), columns)?)
}

/// Presences as a table: a row per image and word; an image without words has none.
pub(crate) fn presence_table(presences: &[Presence]) -> Result<Vec<u8>, RunError> {
    let rows: Vec<(u32, u32)> = (0..)
        .zip(presences)
        .flat_map(|(image, presence)| presence.words().iter().map(move |word| (image, *word)))
        .collect();
    let columns = vec![column("image", rows.iter().map(|row| row.0)), column("word", rows.iter().map(|row| row.1))];
    Ok(encode("words", rows.len(), columns)?)
}

/// Presences of `images` images from their table.
pub(crate) fn presences_from(bytes: Vec<u8>, images: usize) -> Result<Vec<Presence>, RunError> {
    let table = tables::from_parquet("words", bytes)?;
    let mut words = vec![Vec::new(); images];
    for (image, word) in tables::u32s(&table, "image")?.into_iter().zip(tables::u32s(&table, "word")?) {
        if let Some(words) = words.get_mut(image as usize) {
            words.push(word);
        }
    }
    Ok(words.into_iter().map(Presence::from).collect())
}

fn load(objects: &Objects, record: &CodebookRecord) -> Result<Codebook, RunError> {
    let wrong = |error: &dyn std::fmt::Display| RunError::Codebook(error.to_string());
    let tree = tables::from_parquet("Chow-Liu tree", objects.read(record.tree)?)?;
    let tree = ChowLiuTree::from_columns(
        tables::u32s(&tree, "parent")?,
        tables::f64s(&tree, "p_present")?,
        tables::f64s(&tree, "p_present_given_parent_present")?,
        tables::f64s(&tree, "p_present_given_parent_absent")?,
    )
    .map_err(|error| wrong(&error))?;
    let vocabulary = tables::from_parquet("vocabulary", objects.read(record.vocabulary)?)?;
    let vocabulary = Vocabulary::from_flat(flat(&vocabulary)?).map_err(|error| wrong(&error))?;
    let samples = presences_from(objects.read(record.samples)?, record.images.len())?;
    Ok(Codebook { vocabulary, tree, samples })
}

/// The 64 columns of a vocabulary's table, word by word.
fn flat(table: &DataFrame) -> Result<Vec<f32>, RunError> {
    let columns = (0..64).map(|d| tables::f32s(table, &format!("d{d}"))).collect::<Result<Vec<_>, _>>()?;
    Ok((0..table.height()).flat_map(|word| columns.iter().map(move |column| column[word])).collect())
}
