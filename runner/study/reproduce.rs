//! A run again from nothing but the recordings' bytes: every traversal ingested, every generator trained and every cell
//! computed in a fresh store, and what comes of it compared with what the first store holds.

use crate::RunError;
use crate::generation::relighting::Relight;
use crate::generation::training::{TrainingRequest, train};
use crate::progress::{Progress, Stage, StageProgress};
use crate::stages::conduct::Conduct;
use crate::stages::matching::read_matrix;
use crate::study::{Study, run, study};
use furrow_catalog::records::{GeneratorRecord, Record, RunCell, RunRecord, encode, record_id};
use furrow_catalog::{Catalog, CatalogError};
use furrow_generator::kinds::OTF;
use furrow_ingest::traversal::{IngestError, ingest, request_from_store};
use furrow_model::{ObjectId, Outcome, RunId, TraversalId};
use serde::Serialize;
use serde_json::Value;
use std::path::Path;

/// What came of it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Reproduction {
    /// The run.
    pub run: RunId,
    /// Traversals that were ingested again with the same id.
    #[serde(rename = "passes")]
    pub traversals: usize,
    /// Generators that were trained again with the same id, or brought along where another program made them.
    pub generators: usize,
    /// Cells whose outcomes have the same id.
    pub cells: usize,
    /// Cells that the first store has no outcome of: nothing to compare with.
    pub unfinished: usize,
    /// The first thing that came out otherwise; none where all is the same.
    pub difference: Option<Difference>,
}

/// Something that came out otherwise.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Difference {
    /// What: a traversal, a generator or a cell.
    pub subject: String,
    /// The field where both part, as in `body.evaluation.good`.
    pub place: String,
    /// What the first store has there.
    pub expected: String,
    /// What the fresh one has.
    pub found: String,
}

/// Computes a run of `first` in `fresh`, an empty store; recordings are laid out in `folder` on the way.
///
/// # Errors
/// Where a recording cannot be ingested any more or the run cannot be computed at all. What merely differs is a
/// [`Difference`].
pub fn reproduce(
    first: &Catalog,
    id: RunId,
    fresh: &Catalog,
    folder: &Path,
    progress: Progress<'_>,
) -> Result<Reproduction, RunError> {
    let record = first.run(id)?;
    let mut done = Reproduction { run: id, traversals: 0, generators: 0, cells: 0, unfinished: 0, difference: None };
    let traversals = traversals_of(first, &record)?;
    for (i, traversal) in traversals.iter().enumerate() {
        let report = |done: usize| {
            progress(StageProgress::whole(Stage::Reingestion, done as u64, traversals.len() as u64));
        };
        report(i);
        done.difference = ingest_again(first, *traversal, fresh, &folder.join(i.to_string()))?;
        if done.difference.is_some() {
            return Ok(done);
        }
        done.traversals += 1;
        report(i + 1);
    }
    for generator in &record.generators {
        done.difference = train_again(first, *generator, fresh, progress)?;
        if done.difference.is_some() {
            return Ok(done);
        }
        done.generators += 1;
    }
    let matrix = read_matrix(Path::new("matrix.toml"), &record.source)?;
    let study = study(fresh, matrix, &record.source)?;
    done.difference = record.cells.iter().find_map(|cell| other_inputs(&study, cell));
    if done.difference.is_some() {
        return Ok(done);
    }
    run(fresh, &study, Conduct::default(), progress)?;
    for cell in &record.cells {
        match compared(first, fresh, cell)? {
            None => done.unfinished += 1,
            Some(Ok(())) => done.cells += 1,
            Some(Err(difference)) => {
                done.difference = Some(difference);
                return Ok(done);
            }
        }
    }
    Ok(done)
}

/// The traversals of a run; of one that an old version entered, all of its site.
fn traversals_of(first: &Catalog, record: &RunRecord) -> Result<Vec<TraversalId>, RunError> {
    if !record.traversals.is_empty() {
        return Ok(record.traversals.clone());
    }
    Ok(first.traversals()?.into_iter().filter(|row| row.site == record.site).map(|row| row.id).collect())
}

fn ingest_again(
    first: &Catalog,
    id: TraversalId,
    fresh: &Catalog,
    folder: &Path,
) -> Result<Option<Difference>, RunError> {
    let ingested = request_from_store(first, id, folder).and_then(|request| ingest(fresh, &request, &mut |_| {}));
    let found =
        ingested.map_err(|error: IngestError| RunError::Reingestion(format!("traversal {}: {error}", id.short())))?;
    // The recording is in the fresh store now, linked where that is possible; a folder that stays does no harm.
    let _ = std::fs::remove_dir_all(folder);
    let (expected, found) = (first.traversal(id)?, fresh.traversal(found.traversal)?);
    let subject = format!("traversal {} ({} {} {})", id.short(), expected.purpose, expected.route, expected.slot);
    Ok(difference(subject, &expected, &found)?)
}

/// A generator that was trained here is trained again; one of another program comes along as it is; the built-in ones
/// need nothing.
fn train_again(
    first: &Catalog,
    id: ObjectId,
    fresh: &Catalog,
    progress: Progress<'_>,
) -> Result<Option<Difference>, RunError> {
    if !first.generators()?.iter().any(|row| row.id == id) {
        return Ok(None);
    }
    let record = first.generator(id)?;
    let parameter = |name: &str| record.parameters.get(name).cloned();
    let request = match (record.kind.as_str(), &record.source, &record.target) {
        (OTF, Some(source), Some(target)) => {
            let text = |name: &str| parameter(name).and_then(|value| value.as_str().map(str::to_owned));
            let strengths = parameter("strengths").and_then(|value| serde_json::from_value(value).ok());
            let relight = parameter("relight").and_then(|value| serde_json::from_value::<Relight>(value).ok());
            let place = relight.map(|relight| [relight.latitude_deg, relight.longitude_deg]);
            text("site").zip(text("route")).zip(strengths).map(|((site, route), strengths)| TrainingRequest {
                site,
                route,
                from: source.slot,
                to: target.slot,
                name: record.name.clone(),
                images: source.images.len().max(target.images.len()),
                strengths,
                place,
            })
        }
        _ => None,
    };
    let found: GeneratorRecord = match request {
        Some(request) => train(fresh, &request, progress)?.1,
        None => {
            fresh.objects().write(&first.objects().read(record.weights)?)?;
            fresh.enter_generator(&record)?;
            record.clone()
        }
    };
    Ok(difference(format!("generator '{}'", record.name), &record, &found)?)
}

fn named(cell: &RunCell) -> String {
    let setting = if cell.setting.is_empty() { String::new() } else { format!(" [{}]", cell.setting) };
    format!("cell live {} against {}{setting}", cell.live, cell.experience)
}

/// Why a cell of the run is no cell of the fresh plan, where it is none.
fn other_inputs(study: &Study, cell: &RunCell) -> Option<Difference> {
    if study.cells().any(|(_, planned)| planned.key == cell.key) {
        return None;
    }
    let alike = study.cells().find(|(part, planned)| {
        part.setting == cell.setting
            && planned.label == cell.experience
            && part.live(planned.live).record.slot == cell.live
    });
    let blocked = (study.parts.iter().flat_map(|part| &part.blocked))
        .find(|blocked| blocked.live == cell.live && blocked.experience == cell.experience);
    let found = match (alike, blocked) {
        (Some((_, planned)), _) => format!("{}: other inputs, parameters or algorithms", planned.key),
        (None, Some(blocked)) => format!("blocked: {}", blocked.reason),
        (None, None) => "no such cell".to_owned(),
    };
    Some(Difference { subject: named(cell), place: "key".to_owned(), expected: cell.key.to_string(), found })
}

/// Whether both stores' outcomes of a cell have the same id; `None` where the first has none.
fn compared(first: &Catalog, fresh: &Catalog, cell: &RunCell) -> Result<Option<Result<(), Difference>>, RunError> {
    let by_name = |outcome: Outcome| outcome.named(&cell.experience);
    let Some(expected) = first.outcome(cell.key)?.map(by_name) else { return Ok(None) };
    let Some(found) = fresh.outcome(cell.key)?.map(by_name) else {
        let (place, expected) = ("outcome".to_owned(), record_id(&expected)?.to_string());
        return Ok(Some(Err(Difference { subject: named(cell), place, expected, found: "none".to_owned() })));
    };
    Ok(Some(difference(named(cell), &expected, &found)?.map_or(Ok(()), Err)))
}

/// The first place where two records part; none where their ids are equal.
fn difference<R: Record>(subject: String, expected: &R, found: &R) -> Result<Option<Difference>, CatalogError> {
    let (a, b) = (encode(expected)?, encode(found)?);
    if a == b {
        return Ok(None);
    }
    let value = |bytes: &[u8]| serde_json::from_slice::<Value>(bytes).map_err(CatalogError::Json);
    let (place, expected, found) = parting("", &value(&a)?, &value(&b)?).unwrap_or_default();
    Ok(Some(Difference { subject, place, expected, found }))
}

fn parting(place: &str, a: &Value, b: &Value) -> Option<(String, String, String)> {
    let below = |name: &str| if place.is_empty() { name.to_owned() } else { format!("{place}.{name}") };
    let none = Value::Null;
    match (a, b) {
        (Value::Object(fields), Value::Object(others)) => {
            let names = fields.keys().chain(others.keys().filter(|name| !fields.contains_key(*name)));
            names.into_iter().find_map(|name| {
                parting(&below(name), fields.get(name).unwrap_or(&none), others.get(name).unwrap_or(&none))
            })
        }
        (Value::Array(items), Value::Array(others)) if items.len() == others.len() => {
            items.iter().zip(others).enumerate().find_map(|(i, (a, b))| parting(&below(&i.to_string()), a, b))
        }
        _ if a == b => None,
        _ => Some((place.to_owned(), shortened(a), shortened(b))),
    }
}

fn shortened(value: &Value) -> String {
    let text = value.to_string();
    match text.char_indices().nth(120) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn the_first_place_where_two_values_part_is_named() {
        let parting = |a: Value, b: Value| parting("", &a, &b).map(|(place, ..)| place);
        assert_eq!(parting(json!({"a": [1, {"b": 2}]}), json!({"a": [1, {"b": 2}]})), None);
        assert_eq!(parting(json!({"a": [1, {"b": 2}]}), json!({"a": [1, {"b": 3}]})).as_deref(), Some("a.1.b"));
        assert_eq!(parting(json!({"a": [1]}), json!({"a": [1, 2]})).as_deref(), Some("a"));
        assert_eq!(parting(json!({}), json!({"new": 1})).as_deref(), Some("new"));
    }
}
