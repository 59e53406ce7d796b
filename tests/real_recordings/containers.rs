//! One recording in several containers.

use super::ingest;
use crate::support::golden_data::data_folder;
use crate::support::store::Store;
use serde_json::Value;
use std::path::PathBuf;

#[test]
fn three_containers_of_one_recording_give_one_experience() {
    let Some(containers) = data_folder("derived_stereo_containers") else { return };
    let whole = |path: &PathBuf| {
        path.is_dir() || path.extension().is_some_and(|e| e == "bag") && !path.to_string_lossy().contains("half")
    };
    let mut found: Vec<PathBuf> =
        std::fs::read_dir(&containers).unwrap().flatten().map(|entry| entry.path()).filter(whole).collect();
    found.sort();
    assert!(found.len() >= 3, "{found:?}");
    let ids: Vec<(Value, Value)> = found
        .iter()
        .map(|path| {
            let store = Store::new();
            let summary = ingest(&store, path, "street", "experience", "all");
            (summary["experience"].clone(), summary["trajectory"].clone())
        })
        .collect();
    assert!(ids[0].0.is_string());
    assert!(ids.iter().all(|id| *id == ids[0]), "{ids:?}");
}
