//! What cannot be exported, and what names may not do.

use super::Run;
use std::collections::BTreeSet;

#[test]
fn what_cannot_be_exported_is_told() {
    let run = Run::made();
    let (code, said) = run.refused(&["latest"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("4 cells of the run fit") && said.contains("--experience"), "{said}");
    assert!(said.contains("live 08:00 against both"), "{said}");
    assert!(!said.contains('\u{202e}'), "names do not turn the text around: {said}");
    let (code, said) = run.refused(&["latest", "--experience", "neither"]);
    assert_eq!(code, Some(2), "{said}");
    assert!(said.contains("'neither'") && said.contains("live 08:00 against 10:00"), "{said}");
    let (code, said) = run.refused(&["latest", "--live", "23:00"]);
    assert_eq!(code, Some(2), "{said}");
    let (code, said) = run.refused(&["latest", "--experience", "14:00"]);
    assert!(code == Some(1) && said.contains("could not be run") && said.contains("14:00"), "{said}");
    let (code, said) = run.refused(&["0123456789", "--experience", "both"]);
    assert!(code == Some(1) && said.contains("no run begins with '0123456789'"), "{said}");
    let (code, said) = run.refused(&["latest", "--cell", "nothing"]);
    assert_eq!(code, Some(2), "{said}");
}

#[test]
fn a_cell_that_is_not_finished_is_told_apart() {
    let run = Run::made();
    let folder = tempfile::tempdir().unwrap();
    let told = run.export("08:00", &folder.path().join("whole.mcap"));
    let outcome = told["outcome"].as_str().unwrap();
    let object = run.store.path().join("objects").join(&outcome[..2]).join(outcome);
    let kept = std::fs::read(&object).unwrap();
    std::fs::remove_file(&object).unwrap();
    let (code, said) = run.refused(&["latest", "--experience", "08:00"]);
    std::fs::write(&object, kept).unwrap();
    assert!(code == Some(1) && said.contains("not finished") && said.contains("live 08:00 against 08:00"), "{said}");
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
