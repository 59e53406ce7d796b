//! A cell as a recording in MCAP, in Foxglove's well-known message types, that players of robot data show: both images,
//! poses, matches and what was decided, on the live recording's own stamps.
//!
//! In the order of the work:
//! - `answers`: the table of events, frame by frame;
//! - `scene`: the live traversal, the experiences, and the frames of reference that they stand in;
//! - `file`: a recording that is written message by message, with its lineage;
//! - `tracks`: whole tracks, at the first stamp;
//! - `frames`: live frame by live frame: what was seen, matched and decided;
//! - `camera`, `annotations`, `localisation`, `message`: what the messages hold.
//!
//! `places` and `placed` are another thing: the images of experiences and traversals as sets for place recognition
//! have them.
//!
//! Images are held for a few frames at a time, however long the traversal. Equal cells give equal bytes.

mod annotations;
mod answers;
mod camera;
mod file;
mod frames;
mod localisation;
mod message;
mod scene;
mod tracks;

pub mod pictures;
mod placed;
pub mod places;

use crate::RunError;
use crate::progress::Progress;
use furrow_catalog::records::{RunCell, RunRecord, record_id};
use furrow_catalog::{Catalog, write_file_by};
use furrow_model::{ObjectId, Outcome, RunId, shown};
use std::collections::BTreeMap;
use std::path::Path;

/// The cell of a run that is written.
#[derive(Debug, Clone, Copy)]
pub struct Exporting<'a> {
    /// The run.
    pub run: RunId,
    /// Its record.
    pub record: &'a RunRecord,
    /// The cell, under the name that the run gives it.
    pub cell: &'a RunCell,
    /// What it came to, as the store holds it.
    pub outcome: &'a Outcome,
    /// The program's version.
    pub furrow_version: &'a str,
}

/// What was written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Exported {
    /// The outcome.
    pub outcome: ObjectId,
    /// Messages by topic.
    pub messages: BTreeMap<String, u64>,
}

/// Writes a finished cell as a recording; all of it or nothing.
///
/// # Errors
/// Where the store cannot be read, a stamp lies before 1970, or the disk refuses.
pub fn export_cell(
    catalog: &Catalog,
    exporting: Exporting<'_>,
    path: &Path,
    progress: Progress<'_>,
) -> Result<Exported, RunError> {
    let scene = scene::Scene::load(catalog, exporting)?;
    let outcome = record_id(exporting.outcome)?;
    write_file_by(path, |file| {
        let mut recording = file::Recording::begin(file, exporting.furrow_version)?;
        recording.lineage("furrow", lineage(exporting, outcome, &scene))?;
        tracks::write(&scene, &mut recording)?;
        frames::write(catalog.objects(), &scene, &mut recording, progress)?;
        Ok(Exported { outcome, messages: recording.finish()? })
    })
}

/// What leads from the file back to the store, and how to read its frames of reference.
fn lineage(exporting: Exporting<'_>, outcome: ObjectId, scene: &scene::Scene) -> BTreeMap<String, String> {
    let Exporting { run, record, cell, outcome: found, furrow_version } = exporting;
    let mut entries = vec![
        ("furrow_version".to_owned(), furrow_version.to_owned()),
        ("run".to_owned(), run.to_string()),
        ("matrix".to_owned(), shown(&record.name)),
        ("site".to_owned(), shown(&record.site)),
        ("cell".to_owned(), cell.key.to_string()),
        ("setting".to_owned(), shown(&cell.setting)),
        ("outcome".to_owned(), outcome.to_string()),
        ("events".to_owned(), found.events.to_string()),
        ("live".to_owned(), cell.live.to_string()),
        ("live_traversal".to_owned(), found.live_traversal.to_string()),
        ("live_recording".to_owned(), scene.live.record.recording.to_string()),
        ("live_odometry".to_owned(), shown(&scene.live.record.odometry)),
        ("live_placed".to_owned(), scene.live_placed()),
        ("experience".to_owned(), shown(&cell.experience)),
        ("policy".to_owned(), found.policy.clone()),
        ("method".to_owned(), found.method.clone()),
        ("codebook".to_owned(), found.codebook.map_or_else(|| "none".to_owned(), |id| id.to_string())),
        ("threshold_inliers".to_owned(), found.threshold_inliers.to_string()),
    ];
    for member in &scene.members {
        let name = |what: &str| format!("experience_{}{what}", member.number);
        entries.push((name(""), member.id.to_string()));
        entries.push((name("_label"), member.label.clone()));
        entries.push((name("_placed"), member.placed()));
    }
    entries.into_iter().collect()
}
