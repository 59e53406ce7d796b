//! Traversals and generators made again in a fresh store.

use super::difference::{Difference, difference};
use crate::RunError;
use crate::generation::relighting::Relight;
use crate::generation::training::{TrainingRequest, train};
use crate::progress::Progress;
use furrow_catalog::Catalog;
use furrow_catalog::records::GeneratorRecord;
use furrow_generator::kinds::OTF;
use furrow_ingest::traversal::{IngestError, ingest, request_from_store};
use furrow_model::{ObjectId, TraversalId};
use std::path::Path;

/// Ingests a traversal from the stored bytes of its recording; what differs, if anything.
pub(super) fn ingest_again(
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
pub(super) fn train_again(
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
