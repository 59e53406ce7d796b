//! Python's readers of MCAP and protobuf, in an environment of their own under the target folder, made once.

use super::run::{Both, both, shown};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// What is installed; every package that is needed, so that nothing else comes with it.
const PACKAGES: [&str; 6] = [
    "lz4==4.4.5",
    "mcap==1.6.0",
    "mcap-protobuf-support==0.6.0",
    "pillow==13.0.0",
    "protobuf==7.36.2",
    "zstandard==0.25.0",
];
const SCRIPT: &str = include_str!("read.py");

pub struct Python(PathBuf);

impl Python {
    /// Finds or makes the environment; `None`, and a word why, where there is no Python or no network.
    pub fn with_readers() -> Option<&'static Self> {
        static FOUND: OnceLock<Option<Python>> = OnceLock::new();
        FOUND
            .get_or_init(|| made().map_err(|why| eprintln!("SKIPPED: Python's readers are not asked: {why}")).ok())
            .as_ref()
    }

    /// Reads a recording by `read.py`.
    pub fn read(&self, file: &Path) -> Value {
        let output = Command::new(&self.0).args(["-c", SCRIPT]).arg(file).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice(&output.stdout).unwrap()
    }
}

fn made() -> Result<Python, String> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("mcap-readers");
    let (python, ready) = (folder.join("bin/python"), folder.join("ready"));
    let wanted = PACKAGES.join("\n");
    if std::fs::read_to_string(&ready).is_ok_and(|found| found == wanted) {
        return Ok(Python(python));
    }
    let run = |command: &mut Command| {
        let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        if output.status.success() { Ok(()) } else { Err(stderr.lines().last().unwrap_or("it failed").to_owned()) }
    };
    run(Command::new("python3").args(["-m", "venv", "--clear"]).arg(&folder))?;
    let mut install = Command::new(&python);
    let quietly = "-m pip install --quiet --disable-pip-version-check --timeout=15 --retries=1 --no-deps";
    install.args(quietly.split(' '));
    run(install.args(PACKAGES))?;
    std::fs::write(&ready, wanted).map_err(|error| error.to_string())?;
    Ok(Python(python))
}

#[test]
fn pythons_readers_find_the_same() {
    let Some(python) = Python::with_readers() else { return };
    let Both { run, file, summary, frames, folder: _folder } = both();
    let read = python.read(&file);
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
