//! Recordings of the simulated field that most tests use, made once, and the stores made of them: each is made once and
//! handed out as a copy.

use super::command::{Quoted, furrow, quoted};
use super::matrix::Matrix;
use super::store::Store;
use serde_json::Value;
use std::sync::OnceLock;

/// A recording in the simulated Old Zoo, and what it is ingested as.
pub struct Recording {
    pub file: Quoted,
    pub route: &'static str,
    pub slot: &'static str,
    pub purpose: &'static str,
}

impl Recording {
    /// The line that ingests it.
    pub fn ingest(&self) -> String {
        self.ingest_as(self.route, self.purpose)
    }

    /// The line that ingests it as something else.
    pub fn ingest_as(&self, route: &str, purpose: &str) -> String {
        format!("ingest {} --site old-zoo --route {route} --slot {} --purpose {purpose}", self.file, self.slot)
    }
}

/// A folder for what lives as long as the tests do.
fn folder() -> Quoted {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let made = || tempfile::Builder::new().prefix("furrow recordings ").tempdir().expect("a temporary folder");
    quoted(FOLDER.get_or_init(made).path())
}

/// Records the `number`th traversal of a slot over some metres of a route.
fn record(route: &'static str, slot: &'static str, purpose: &'static str, number: u32, metres: u32) -> Recording {
    let file = quoted(folder().join(format!("{route}-{purpose}-{}.mcap", slot.replace(':', ""))));
    let traversal = format!("--site old-zoo --slot {slot} --route {route} --number {number} --length {metres}");
    furrow(format!("simulate {traversal} -o {file}")).text();
    Recording { file, route, slot, purpose }
}

/// A short stretch of the main route at two hours, a second traversal of it, and the vocabulary route.
pub fn recordings() -> &'static [Recording; 4] {
    static RECORDINGS: OnceLock<[Recording; 4]> = OnceLock::new();
    RECORDINGS.get_or_init(|| {
        [
            record("main", "08:00", "experience", 0, 6),
            record("main", "08:00", "evaluation", 1, 6),
            record("main", "10:00", "experience", 0, 6),
            record("vocabulary", "10:00", "vocabulary", 0, 12),
        ]
    })
}

/// A store with all [`recordings`] in it, and what `ingest` printed of each.
fn first_ingested() -> &'static (Store, Vec<Value>) {
    static INGESTED: OnceLock<(Store, Vec<Value>)> = OnceLock::new();
    INGESTED.get_or_init(|| {
        let store = Store::new();
        let summaries = recordings().iter().map(|recording| store.json(recording.ingest())).collect();
        (store, summaries)
    })
}

/// A store of its own with all [`recordings`] in it.
pub fn ingested() -> Store {
    first_ingested().0.copy()
}

/// What `ingest --json` printed of each of the [`recordings`].
pub fn summaries() -> &'static [Value] {
    &first_ingested().1
}

/// The same with a second vocabulary traversal at 08:00, so that there are two slots to train a generator on.
pub fn ingested_for_training() -> Store {
    static INGESTED: OnceLock<Store> = OnceLock::new();
    let made = || {
        let store = ingested();
        store.json(record("vocabulary", "08:00", "vocabulary", 1, 8).ingest());
        store
    };
    INGESTED.get_or_init(made).copy()
}

/// A store in which the small matrix was run.
pub struct Ran {
    pub store: Store,
    /// What `run --json` printed.
    pub run: Value,
}

/// The store in which the small matrix was run: to be read; a test that writes takes a copy of the store.
pub fn ran() -> &'static Ran {
    static RAN: OnceLock<Ran> = OnceLock::new();
    RAN.get_or_init(|| {
        let store = ingested();
        let matrix = Matrix::small().write(store.path());
        let run = store.json(format!("run {matrix}"));
        Ran { store, run }
    })
}
