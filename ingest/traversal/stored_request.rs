//! A request that the store remembers: what was asked is written beside the traversal, and a store that kept the
//! recording can make the same request again.

use crate::traversal::beside;
use crate::traversal::error::IngestError;
use crate::traversal::motion::MotionSource;
use crate::traversal::request::{Imported, IngestRequest};
use furrow_catalog::records::RequestRecord;
use furrow_catalog::{Catalog, CatalogError, digest};
use furrow_model::{ObjectId, RecordingId, TraversalId};
use std::fs;
use std::path::{Path, PathBuf};

/// Writes the request for a traversal that is about to be entered into the catalogue.
pub(crate) fn keep_request(catalog: &Catalog, request: &IngestRequest, id: TraversalId) -> Result<(), IngestError> {
    let stored = asked(request, |bytes| Ok(catalog.objects().write(bytes)?))?;
    beside::keep(catalog, id, &stored)
}

/// Whether a traversal came of the same options, whatever their files are called.
pub(crate) fn was_asked_alike(
    catalog: &Catalog,
    request: &IngestRequest,
    id: TraversalId,
) -> Result<bool, IngestError> {
    let nameless = |mut record: RequestRecord| {
        record.calibration.iter_mut().chain(&mut record.poses).for_each(|(name, _)| name.clear());
        record
    };
    let now = asked(request, |bytes| Ok(digest(bytes)))?;
    Ok(nameless(now) == nameless(beside::read(catalog, id)?))
}

/// The options of a request; `keep` names the bytes of its files.
fn asked(
    request: &IngestRequest,
    keep: impl Fn(&[u8]) -> Result<ObjectId, IngestError>,
) -> Result<RequestRecord, IngestError> {
    let keep_file = |path: &PathBuf| {
        let bytes = fs::read(path).map_err(IngestError::file(path))?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok::<_, IngestError>((name, keep(&bytes)?))
    };
    let (poses, spacing_m) = match &request.motion {
        MotionSource::Odometry => (None, None),
        MotionSource::Spacing(metres) => (None, Some(*metres)),
        MotionSource::Poses(path) => (Some(keep_file(path)?), None),
    };
    Ok(RequestRecord {
        left: request.left.clone(),
        right: request.right.clone(),
        left_info: request.left_info.clone(),
        right_info: request.right_info.clone(),
        calibration: request.calibration.iter().map(keep_file).collect::<Result<_, _>>()?,
        poses,
        spacing_m,
        field_of_view_deg: request.field_of_view_deg,
    })
}

/// The request that gave a traversal, with its recording's files laid out in `folder`, which must be empty.
///
/// # Errors
/// [`IngestError::Request`] where the store kept no recording: loose images are objects only, and a request may want no
/// copy of its recording. Where files cannot be read or written.
pub fn request_from_store(catalog: &Catalog, id: TraversalId, folder: &Path) -> Result<IngestRequest, IngestError> {
    let record = catalog.traversal(id)?;
    let stored: RequestRecord = beside::read(catalog, id)?;
    let lay_out_file = |name: &str, object: ObjectId| {
        let path = folder.join("beside").join(name);
        write_file(&path, &catalog.objects().read(object)?)?;
        Ok::<_, IngestError>(path)
    };
    let motion = match (&stored.poses, stored.spacing_m) {
        (Some((name, object)), _) => MotionSource::Poses(lay_out_file(name, *object)?),
        (None, Some(metres)) => MotionSource::Spacing(metres),
        (None, None) => MotionSource::Odometry,
    };
    let calibration =
        stored.calibration.iter().enumerate().map(|(i, (name, object))| lay_out_file(&format!("{i}-{name}"), *object));
    Ok(IngestRequest {
        files: lay_out_recording(catalog, &record.recording, folder, id)?,
        calibration: calibration.collect::<Result<_, _>>()?,
        ground_truth: record.ground_truth.map(|object| lay_out_file("groundtruth.tum", object)).transpose()?,
        selection: record.selection.parse().map_err(IngestError::Request)?,
        motion,
        left: stored.left,
        right: stored.right,
        left_info: stored.left_info,
        right_info: stored.right_info,
        field_of_view_deg: stored.field_of_view_deg,
        keep_recording: true,
        // It entered once: whatever was insisted on then was insisted on with reason.
        strict: false,
        insist_on_parts: true,
        accept_failed_odometry: true,
        imported: Imported::default(),
        site: record.site,
        route: record.route,
        slot: record.slot,
        purpose: record.purpose,
    })
}

/// The files of a recording under their own names, as an ingest is given them.
fn lay_out_recording(
    catalog: &Catalog,
    id: &RecordingId,
    folder: &Path,
    traversal: TraversalId,
) -> Result<Vec<PathBuf>, IngestError> {
    let row = catalog.recordings()?.into_iter().find(|row| row.id == *id).filter(|row| !row.parts.is_empty());
    let row = row.ok_or_else(|| {
        IngestError::Request(format!(
            "traversal {} came as loose images or with --no-recording: the store has no recording to ingest again",
            traversal.short()
        ))
    })?;
    let top = folder.join("recording").join(&row.name);
    let is_folder = row.parts.iter().any(|part| part.name == "metadata.yaml");
    let mut files = Vec::new();
    for part in &row.parts {
        let path = if is_folder { top.join(&part.name) } else { folder.join("recording").join(&part.name) };
        let kept = catalog.recording_path(part.digest);
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(IngestError::file(parent))?;
        }
        if fs::hard_link(&kept, &path).is_err() {
            fs::copy(&kept, &path).map_err(CatalogError::file("copy the recording to", &path))?;
        }
        files.push(path);
    }
    Ok(if is_folder { vec![top] } else { files })
}

fn write_file(path: &Path, bytes: &[u8]) -> Result<(), IngestError> {
    let written = path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(path, bytes));
    Ok(written.map_err(CatalogError::file("write", path))?)
}
