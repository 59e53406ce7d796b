//! A store opened to be looked at: what others wrote is seen, and nothing is written.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use furrow_catalog::index::FailureRow;
use furrow_catalog::records::RunRecord;
use furrow_catalog::{Catalog, CatalogError};
use furrow_model::{CellKey, RunId};
use std::path::Path;
use std::time::{Duration, Instant};

fn run(name: &str) -> RunRecord {
    RunRecord {
        name: name.to_owned(),
        site: "zoo".to_owned(),
        source: String::new(),
        figures: Vec::new(),
        cells: Vec::new(),
        blocked: Vec::new(),
        traversals: Vec::new(),
        generators: Vec::new(),
        contrasts: Vec::new(),
    }
}

fn names(root: &Path) -> Vec<String> {
    Catalog::open_to_read(root).unwrap().runs().unwrap().into_iter().map(|run| run.matrix).collect()
}

/// Files beside the objects, with their bytes.
fn files(root: &Path) -> Vec<(String, Vec<u8>)> {
    let files = std::fs::read_dir(root).unwrap().flatten().filter(|entry| entry.path().is_file());
    let mut files: Vec<_> =
        files.map(|entry| (entry.file_name().into_string().unwrap(), std::fs::read(entry.path()).unwrap())).collect();
    files.sort();
    files
}

/// The files once a writer that was dropped has taken away its log: its thread does so in its own time.
fn settled(root: &Path) -> Vec<(String, Vec<u8>)> {
    let started = Instant::now();
    while files(root).len() > 1 {
        assert!(started.elapsed() < Duration::from_secs(20), "the writer's log stays");
        std::thread::sleep(Duration::from_millis(10));
    }
    files(root)
}

#[test]
fn a_reader_sees_what_a_writer_has_committed() {
    let folder = tempfile::tempdir().unwrap();
    let writer = Catalog::init(folder.path()).unwrap();
    writer.enter_run(&run("first")).unwrap();
    assert_eq!(names(folder.path()), ["first"]);
    writer.enter_run(&run("second")).unwrap();
    assert_eq!(names(folder.path()), ["first", "second"]);
}

#[test]
fn a_reader_leaves_no_trace_and_enters_nothing() {
    let folder = tempfile::tempdir().unwrap();
    Catalog::init(folder.path()).unwrap().enter_run(&run("first")).unwrap();
    let before = settled(folder.path());
    let reader = Catalog::open_to_read(folder.path()).unwrap();
    assert_eq!(files(folder.path()), before, "while it is read");
    let failure = FailureRow { cell: CellKey([1; 32]), run: RunId([2; 32]), reason: "none".to_owned() };
    let refused = reader.enter_failures(&[], &[failure]);
    assert!(matches!(refused, Err(CatalogError::ReadOnly { .. })), "a reader enters nothing");
    drop(reader);
    assert_eq!(files(folder.path()), before);
    assert_eq!(names(folder.path()), ["first"]);
}

#[test]
fn an_index_of_another_format_is_not_touched() {
    let folder = tempfile::tempdir().unwrap();
    drop(Catalog::init(folder.path()).unwrap());
    settled(folder.path());
    let older = || async {
        use sqlx::ConnectOptions;
        let options = sqlx::sqlite::SqliteConnectOptions::new().filename(folder.path().join("catalogue.db"));
        let mut index = options.connect().await.unwrap();
        let last = "DELETE FROM _sqlx_migrations WHERE version = (SELECT max(version) FROM _sqlx_migrations)";
        sqlx::query(last).execute(&mut index).await.unwrap();
        sqlx::Connection::close(index).await.unwrap();
    };
    tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap().block_on(older());
    let before = files(folder.path());
    let refused = Catalog::open_to_read(folder.path()).unwrap_err();
    assert!(matches!(refused, CatalogError::OtherFormat { found: 7, expected: 8, .. }), "{refused}");
    assert_eq!(files(folder.path()), before);
}
