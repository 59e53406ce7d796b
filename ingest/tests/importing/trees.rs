//! The trees that the script writes, once for all tests, and the ingest of one.

use furrow_catalog::Catalog;
use furrow_ingest::import::find_profile;
use furrow_ingest::traversal::{
    FrameSelection, Imported, IngestError, IngestRequest, IngestSummary, MotionSource, ingest, request_of_dataset,
};
use furrow_model::Purpose;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use tempfile::TempDir;

/// A folder for each layout, and what is right of them.
pub struct Trees {
    folder: TempDir,
    pub right: Value,
}

impl Trees {
    /// The trees; `None`, and a word why, where there is no Python.
    pub fn written() -> Option<&'static Self> {
        static WRITTEN: OnceLock<Option<Trees>> = OnceLock::new();
        WRITTEN.get_or_init(write).as_ref()
    }

    pub fn path(&self, below: &str) -> PathBuf {
        self.folder.path().join(below)
    }

    /// A copy of a folder, to be damaged.
    pub fn copy(&self, below: &str) -> TempDir {
        let copy = tempfile::tempdir().unwrap();
        copy_folder(&self.path(below), copy.path());
        copy
    }
}

fn write() -> Option<Trees> {
    let folder = tempfile::tempdir().unwrap();
    let bags = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/importing/bags.py");
    let output = Command::new("python3").args(["-c", include_str!("layouts.py")]).arg(folder.path()).arg(bags).output();
    match output {
        Err(error) => {
            eprintln!("SKIPPED: no trees of other people's datasets: python3: {error}");
            None
        }
        Ok(output) => {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            Some(Trees { folder, right: serde_json::from_slice(&output.stdout).unwrap() })
        }
    }
}

fn copy_folder(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap().flatten() {
        let target = to.join(entry.file_name());
        if entry.path().is_dir() {
            copy_folder(&entry.path(), &target);
        } else {
            std::fs::copy(entry.path(), target).unwrap();
        }
    }
}

/// An empty store.
pub fn store() -> (TempDir, Catalog) {
    let folder = tempfile::tempdir().unwrap();
    let catalog = Catalog::init(&folder.path().join("store")).unwrap();
    (folder, catalog)
}

/// Imports a dataset as an evaluation traversal.
pub fn import(
    catalog: &Catalog,
    profile: &str,
    path: &Path,
    motion: MotionSource,
    calibration: Vec<PathBuf>,
) -> Result<IngestSummary, IngestError> {
    let scratch = tempfile::tempdir().unwrap();
    let asked = IngestRequest {
        files: Vec::new(),
        site: "elsewhere".to_owned(),
        route: "loop".to_owned(),
        slot: "10:00".parse().unwrap(),
        purpose: Purpose::Evaluation,
        selection: FrameSelection::All,
        left: None,
        right: None,
        left_info: None,
        right_info: None,
        motion,
        field_of_view_deg: None,
        calibration,
        ground_truth: None,
        keep_recording: false,
        strict: false,
        insist_on_parts: false,
        accept_failed_odometry: false,
        imported: Imported::default(),
    };
    let (found, _) = find_profile(profile)?;
    ingest(catalog, &request_of_dataset(profile, &found, path, asked, scratch.path())?, &mut |_| ())
}
