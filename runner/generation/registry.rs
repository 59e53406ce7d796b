//! Generators by name.

use super::translator::Translator;
use crate::RunError;
use crate::suggest;
use furrow_catalog::Catalog;
use furrow_catalog::records::GeneratorRecord;
use furrow_generator::kinds::untrained_names;
use furrow_generator::{ALGORITHM, Generator};
use furrow_model::{ObjectId, TimeSlot};
use serde_json::json;

/// The slot that an image of `parent`'s slot stands for at `z`: on the generator's way between its slots, else the
/// parent's own.
pub fn mimicked_slot(record: &GeneratorRecord, parent: TimeSlot, z: f64) -> TimeSlot {
    match (&record.source, &record.target) {
        (Some(source), Some(target)) => source.slot.towards(target.slot, z),
        _ => parent,
    }
}

/// The generator of a name, or of the beginning of an id: one that was trained or added, else one that needs no
/// training. Writes nothing.
///
/// # Errors
/// [`RunError::Generator`] where there is none, with the nearest name.
pub fn find_generator(catalog: &Catalog, typed: &str) -> Result<(ObjectId, GeneratorRecord), RunError> {
    let rows = catalog.generators()?;
    let named = rows.iter().filter(|row| row.name == typed).max_by_key(|row| row.number);
    let by_id = || {
        let mut begin = rows.iter().filter(|row| typed.len() >= 4 && row.id.to_string().starts_with(typed));
        begin.next().filter(|_| begin.next().is_none())
    };
    if let Some(row) = named.or_else(by_id) {
        return Ok((row.id, catalog.generator(row.id)?));
    }
    if let Some(generator) = Generator::named(typed) {
        let generator = generator.map_err(|error| RunError::generator(typed, error))?;
        let (record, _) = record_of(&generator)?;
        return Ok((furrow_catalog::records::record_id(&record)?, record));
    }
    let hint = suggest::nearest(typed, rows.iter().map(|row| row.name.as_str()));
    Err(RunError::generator(
        typed,
        format!(
            "no generator has this name or id{hint}; train one with `furrow generator train`, add one with `furrow generator add`, or take {}",
            named_examples("or")
        ),
    ))
}

/// The names of generators that need no training, for people: `identity, invariant, gamma:0.8, noise:3 or blur:0.8`.
pub fn named_examples(last: &str) -> String {
    let names = untrained_names();
    match names.split_last() {
        Some((end, first)) if !first.is_empty() => format!("{} {last} {end}", first.join(", ")),
        _ => names.concat(),
    }
}

/// The digest of a command's own files, as they are now; `None` of other generators.
///
/// # Errors
/// [`RunError::Generator`] naming the file that cannot be read.
pub(crate) fn own_files(record: &GeneratorRecord) -> Result<Option<ObjectId>, RunError> {
    let files = Translator::of(record)?.map(|translator| translator.own_files());
    Ok(files.transpose().map_err(|reason| RunError::generator(&record.name, reason))?.flatten())
}

/// Enters the generator of [`find_generator`] where it needs no training and was never used; others are there already.
///
/// # Errors
/// Where the store cannot be written.
pub fn register_named(catalog: &Catalog, record: &GeneratorRecord) -> Result<(), RunError> {
    if let Some(Ok(generator)) = Generator::named(&record.name) {
        let (known, weights) = record_of(&generator)?;
        let id = furrow_catalog::records::record_id(&known)?;
        if known == *record && !catalog.generators()?.iter().any(|row| row.id == id) {
            catalog.objects().write(&weights)?;
            catalog.enter_generator(record)?;
        }
    }
    Ok(())
}

/// The record of a generator that needs no training, and its weights' bytes.
fn record_of(generator: &Generator) -> Result<(GeneratorRecord, Vec<u8>), RunError> {
    let weights = weights_of(generator)?;
    let record = GeneratorRecord {
        name: generator.name(),
        kind: generator.kind().to_owned(),
        algorithm: ALGORITHM.to_owned(),
        source: None,
        target: None,
        parameters: json!({}),
        weights: furrow_catalog::digest(&weights),
    };
    Ok((record, weights))
}

/// A model's bytes.
pub(crate) fn weights_of(generator: &Generator) -> Result<Vec<u8>, RunError> {
    Ok(furrow_catalog::to_json(generator)?)
}
