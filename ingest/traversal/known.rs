//! Whether the store has a recording's frames already, under whatever name, label or true poses.

use crate::traversal::error::IngestError;
use crate::traversal::request::IngestRequest;
use crate::traversal::stored_request::was_asked_alike;
use furrow_catalog::Catalog;
use furrow_catalog::index::TraversalRow;
use furrow_catalog::records::TraversalRecord;
use furrow_model::{RecordingId, TraversalId};

/// The traversal that has just these frames of this recording for the same purpose, by what was asked: found before
/// anything is read. One of the same label goes first.
pub(crate) fn known_by_bytes(
    catalog: &Catalog,
    request: &IngestRequest,
    recording: RecordingId,
) -> Result<Option<TraversalId>, IngestError> {
    let selection = request.selection.to_string();
    find(
        catalog,
        request,
        |row| row.recording == recording,
        |id, record| {
            let is_same = record.selection == selection && record.odometry == request.motion.version();
            Ok(is_same && was_asked_alike(catalog, request, id)?)
        },
    )
}

/// The traversal for the same purpose that came to the same images, calibration and chain, whatever was asked.
pub(crate) fn known_by_frames(
    catalog: &Catalog,
    request: &IngestRequest,
    made: &TraversalRecord,
) -> Result<Option<TraversalId>, IngestError> {
    find(
        catalog,
        request,
        |_| true,
        |_, record| Ok((record.frames, record.chain, record.calibration) == (made.frames, made.chain, made.calibration)),
    )
}

/// What the same frames are in the store already for other purposes, a sentence each.
pub(crate) fn other_purposes(
    catalog: &Catalog,
    request: &IngestRequest,
    made: &TraversalRecord,
) -> Result<Vec<String>, IngestError> {
    let mut said = Vec::new();
    for row in catalog.traversals()?.into_iter().filter(|row| row.purpose != request.purpose) {
        let record = catalog.traversal(row.id)?;
        if record.frames == made.frames {
            said.push(format!(
                "the same frames are in the store for {} as traversal {}: matching images with themselves proves nothing",
                row.purpose,
                row.id.short()
            ));
        }
    }
    Ok(said)
}

/// The first traversal for the purpose that `is_it`; records are read of those only that their rows do not rule out.
fn find(
    catalog: &Catalog,
    request: &IngestRequest,
    may_be: impl Fn(&TraversalRow) -> bool,
    is_it: impl Fn(TraversalId, &TraversalRecord) -> Result<bool, IngestError>,
) -> Result<Option<TraversalId>, IngestError> {
    let mut rows: Vec<TraversalRow> =
        catalog.traversals()?.into_iter().filter(|row| row.purpose == request.purpose && may_be(row)).collect();
    let is_labelled_alike = |row: &TraversalRow| {
        (row.site == request.site, row.route == request.route, row.slot == request.slot) == (true, true, true)
    };
    rows.sort_by_key(|row| !is_labelled_alike(row));
    for row in rows {
        if is_it(row.id, &catalog.traversal(row.id)?)? {
            return Ok(Some(row.id));
        }
    }
    Ok(None)
}
