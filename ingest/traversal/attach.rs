//! True poses that come later, or better ones: a version of a traversal that takes the earlier one's place.

use crate::traversal::beside::{self, notes_of};
use crate::traversal::error::IngestError;
use crate::traversal::truth::{GivenTruth, is_of_truth};
use furrow_catalog::records::{NotesRecord, TraversalRecord, record_id};
use furrow_catalog::{Catalog, tables};
use furrow_model::{ObjectId, TraversalId};
use serde::Serialize;
use std::path::Path;

/// What attaching true poses did.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct AttachSummary {
    /// The version with these true poses.
    pub traversal: TraversalId,
    /// The version whose place it took; `None` where these poses were attached before.
    pub supersedes: Option<TraversalId>,
    /// The file of true poses, as the store keeps it.
    pub ground_truth: ObjectId,
    /// The file that was attached before.
    pub replaced: Option<ObjectId>,
    /// Frames of the traversal.
    pub frames: u32,
    /// Frames that have a true pose.
    pub frames_with_pose: u32,
    /// What is odd about these poses, a sentence each.
    pub notes: Vec<String>,
}

/// Attaches a file of true poses to a traversal, in place of those that it had. Images, chain and experience stay; the
/// traversal's id is another, so that no outcome that was judged by other poses is taken for one judged by these.
///
/// # Errors
/// Where the file cannot be read or no frame has a pose in it; where the traversal is not the latest version of itself.
/// The store then is as it was.
pub fn attach_truth(catalog: &Catalog, id: TraversalId, path: &Path) -> Result<AttachSummary, IngestError> {
    let truth = GivenTruth::read(path)?;
    let record = catalog.traversal(id)?;
    let frames = tables::frames_from_parquet(catalog.objects().read(record.frames)?)?;
    let stamps_ns: Vec<i64> = frames.iter().map(|frame| frame.stamp_ns).collect();
    let said = [truth.check_frames(&stamps_ns)?, truth.check_way(&stamps_ns, record.counts.length_m)];
    let ground_truth = truth.digest();
    let replaced = record.ground_truth;
    let later = TraversalId(record_id(&TraversalRecord { ground_truth: Some(ground_truth), ..record.clone() })?.0);
    if later != id {
        beside::pass_on(catalog, id, later)?;
        let notes =
            notes_of(catalog, id)?.into_iter().filter(|note| !is_of_truth(note)).chain(said.iter().flatten().cloned());
        beside::keep(catalog, later, &NotesRecord { notes: notes.collect() })?;
        catalog.attach_truth(id, truth.bytes())?;
    }
    Ok(AttachSummary {
        traversal: later,
        supersedes: (later != id).then_some(id),
        ground_truth,
        replaced: replaced.filter(|_| later != id),
        frames: stamps_ns.len() as u32,
        frames_with_pose: truth.frames_with_pose(&stamps_ns),
        notes: said.into_iter().flatten().collect(),
    })
}
