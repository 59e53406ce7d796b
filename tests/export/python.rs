//! Python's readers of MCAP and protobuf.

use super::run::{Both, both, shown};
use crate::support::python::Python;

/// What is installed.
const PACKAGES: [&str; 6] = [
    "lz4==4.4.5",
    "mcap==1.6.0",
    "mcap-protobuf-support==0.6.0",
    "pillow==13.0.0",
    "protobuf==7.36.2",
    "zstandard==0.25.0",
];
const SCRIPT: &str = include_str!("read.py");

/// Python with the readers; `None`, and a word why, where there is no Python or no network.
fn readers() -> Option<Python> {
    let found = Python::with("mcap-readers", &PACKAGES);
    found.map_err(|why| eprintln!("SKIPPED: Python's readers are not asked: {why}")).ok()
}

#[test]
fn pythons_readers_find_the_same() {
    let Some(python) = readers() else { return };
    let Both { run, file, summary, frames, folder: _folder } = both();
    let read = python.json(SCRIPT, &[file.as_os_str()]).unwrap();
    assert_eq!(read["messages"], summary["messages"], "messages by topic");
    assert_eq!(read["metadata"]["furrow"]["run"], run.run["run"]);
    assert_eq!(read["metadata"]["furrow"]["cell"], run.cell("both")["key"]);
    assert_eq!(read["metadata"]["furrow"]["outcome"], summary["outcome"]);
    assert_eq!(read["metadata"]["furrow"]["furrow_version"], env!("CARGO_PKG_VERSION"));
    let stamps: Vec<i64> = frames.keys().copied().collect();
    assert_eq!(read["stamps"]["/live/left"], serde_json::json!(stamps));
    let calibrated = &read["calibrated"]["/live/calibration"];
    assert_eq!(read["sizes"]["/live/left"], *calibrated, "images decode to their camera's size");
    assert_eq!(read["sizes"]["/match/left"], read["calibrated"]["/match/calibration"]);
    let inliers: Vec<Option<u32>> = frames.values().map(|rows| shown(rows).and_then(|row| row.inliers)).collect();
    assert_eq!(read["inliers"], serde_json::json!(inliers));
    let lost = read["lost"].as_array().unwrap().iter().filter(|lost| **lost == true).count() as u64;
    let good = run.cell("both")["good"].as_u64().unwrap();
    assert_eq!(frames.len() as u64 - lost, good, "as many are localised as the run says");
    let [info, errors] = ["info", "errors"].map(|level| read[level].as_u64().unwrap());
    assert_eq!(info + errors, good, "and as many lines of the log say so");
    assert_eq!(errors, run.cell("both")["wrong"].as_u64().unwrap(), "errors are wrong ones");
}
