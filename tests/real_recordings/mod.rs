//! The whole road on real recordings. Folders come from FURROW_DATA; what is absent is skipped and said so.

mod containers;
mod fixtures;
mod odd_and_even;
mod street;
mod track;

use crate::support::command::quoted;
use crate::support::golden_data::data;
use crate::support::store::Store;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// A real street: a bag with a stereo pair of compressed images and a GPS track of known accuracy, and its loose files
/// beside it.
fn street() -> Option<(PathBuf, PathBuf)> {
    let data = data()?;
    let (bag, folder) = (data.join("kitti_raw_drive_A.bag"), data.join("kitti_raw_drive_A"));
    if bag.is_file() && folder.join("gps_track.csv").is_file() {
        return Some((bag, folder));
    }
    eprintln!("SKIPPED: no kitti_raw_drive_A in {}", data.display());
    None
}

#[track_caller]
fn ingest(store: &Store, file: &Path, route: &str, purpose: &str, frames: &str) -> Value {
    let place = format!("--site karlsruhe --route {route} --slot 14:00 --purpose {purpose}");
    store.json(format!("ingest {} {place} --frames {frames}", quoted(file)))
}
