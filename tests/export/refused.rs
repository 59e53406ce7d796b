//! What cannot be exported, and what names may not do.

use super::run::Run;
use crate::support::command::quoted;
use crate::support::store::Store;
use std::collections::BTreeSet;

/// Tries to export, and must not come to anything: what stands on stderr.
#[track_caller]
fn refused(store: &Store, options: &str, code: i32, words: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let file = quoted(folder.path().join("refused.mcap"));
    let stderr = store.fails(format!("export run {options} -o {file}"), code, words);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{options} left a file");
    stderr
}

#[test]
fn what_cannot_be_exported_is_told() {
    let store = &Run::made().store;
    let which = ["4 cells of the run fit", "--experience", "live 08:00 against both"];
    let stderr = refused(store, "latest", 2, &which);
    assert!(!stderr.contains('\u{202e}'), "names do not turn the text around: {stderr}");
    refused(store, "latest --experience neither", 2, &["'neither'", "live 08:00 against 10:00"]);
    refused(store, "latest --live 23:00", 2, &[]);
    refused(store, "latest --experience 14:00", 1, &["could not be run", "14:00"]);
    refused(store, "0123456789 --experience both", 1, &["no run begins with '0123456789'"]);
    refused(store, "latest --cell nothing", 2, &[]);
}

#[test]
fn a_cell_that_is_not_finished_is_told_apart() {
    let run = Run::made();
    let folder = tempfile::tempdir().unwrap();
    let summary = run.export("08:00", &folder.path().join("whole.mcap"));
    // In a store of its own, since the other tests export from this one.
    let store = run.store.copy();
    std::fs::remove_file(store.object(&summary["outcome"])).unwrap();
    refused(&store, "latest --experience 08:00", 1, &["not finished", "live 08:00 against 08:00"]);
}

#[test]
fn a_hostile_name_is_shown_and_turns_nothing_around() {
    let run = Run::made();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("hostile.mcap");
    run.export(&run.hostile, &file);
    let bytes = std::fs::read(&file).unwrap();
    let summary = mcap::Summary::read(&bytes).unwrap().unwrap();
    let [index] = summary.metadata_indexes.as_slice() else { panic!("one metadata record") };
    let metadata = mcap::read::metadata(&bytes, index).unwrap().metadata;
    assert_eq!(metadata["experience"], run.hostile.replace('\u{202e}', "\u{fffd}"));
    let topics: BTreeSet<&str> = summary.channels.values().map(|channel| channel.topic.as_str()).collect();
    assert!(
        topics.iter().all(|topic| topic.bytes().all(|byte| byte.is_ascii_lowercase() || b"/_12".contains(&byte))),
        "{topics:?}"
    );
}
