//! The command `furrow`, run as a user runs it.

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// The built command.
pub fn furrow() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_furrow"));
    command.env_remove("FURROW_STORE");
    command
}

/// Runs `furrow ARGS`.
pub fn run(args: &[&str]) -> Output {
    furrow().args(args).output().expect("furrow starts")
}

/// Runs `furrow --store STORE ARGS --json`, which must succeed, and reads what it prints.
pub fn json(store: &Path, args: &[&str]) -> Value {
    let output = furrow().arg("--store").arg(store).args(args).arg("--json").output().expect("furrow starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "furrow {args:?} ended with {}: {said}", output.status);
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("furrow {args:?} --json: {error}"))
}

/// A new store in its own folder.
pub fn store() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    assert!(run(&["init", text(folder.path())]).status.success());
    folder
}

/// A path as an argument.
pub fn text(path: &Path) -> &str {
    path.to_str().expect("a path in UTF-8")
}

/// Recordings of the simulated field that several tests use, made once: slot and purpose to file.
pub struct Field {
    _folder: tempfile::TempDir,
    /// (file, route, slot, purpose).
    pub outings: Vec<(PathBuf, &'static str, &'static str, &'static str)>,
}

/// A short stretch of the simulated Old Zoo at two hours, and a vocabulary route.
pub fn field() -> &'static Field {
    static FIELD: OnceLock<Field> = OnceLock::new();
    FIELD.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let passes = [
            ("main", "08:00", "experience", "0", "6"),
            ("main", "08:00", "evaluation", "1", "6"),
            ("main", "10:00", "experience", "0", "6"),
            ("vocabulary", "10:00", "vocabulary", "0", "12"),
        ];
        let outings = passes.map(|(route, slot, purpose, number, metres)| {
            let file = folder.path().join(format!("{route}-{purpose}-{}.mcap", slot.replace(':', "")));
            let made = run(&[
                "simulate",
                "--site",
                "old-zoo",
                "--slot",
                slot,
                "--route",
                route,
                "--number",
                number,
                "--length",
                metres,
                "-o",
                text(&file),
            ]);
            assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
            (file, route, slot, purpose)
        });
        Field { _folder: folder, outings: outings.to_vec() }
    })
}

impl Field {
    /// Ingests every outing into a store.
    pub fn ingest(&self, store: &Path) -> Vec<Value> {
        let one = |(file, route, slot, purpose): &(PathBuf, &str, &str, &str)| {
            json(
                store,
                &["ingest", text(file), "--site", "old-zoo", "--route", route, "--slot", slot, "--pass", purpose],
            )
        };
        self.outings.iter().map(one).collect()
    }
}

/// A matrix over the outings of [`field`], written into a folder.
pub fn matrix(folder: &Path) -> PathBuf {
    let path = folder.join("matrix.toml");
    let text = "name = \"small\"\nsite = \"old-zoo\"\ncodebook = { words = 600, route = \"vocabulary\", images = 60 }\n\
        keyframes = { distance_m = 1.0, yaw_rad = 0.2536 }\nverification = { threshold = 40 }\n[axes]\nlive = [\"08:00\"]\nexperience = [\"08:00\", \"10:00\"]\n\
        [[collective]]\nname = \"both\"\nof = \"recorded\"\n";
    std::fs::write(&path, text).expect("a matrix file");
    path
}
