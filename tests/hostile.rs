//! Wrong, torn and hostile files: a clear error, the right exit code, and a store that is as it was.

use crate::command::{field, furrow, json, store, text};
use std::path::Path;

fn refused(store: &Path, file: &Path) -> String {
    let place = ["--site", "s", "--route", "r", "--slot", "12:00", "--pass", "experience"];
    let output = furrow().arg("--store").arg(store).arg("ingest").arg(file).args(place).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{}: {said}", file.display());
    assert!(!said.contains("panicked"), "{said}");
    assert!(said.contains(file.file_name().unwrap().to_str().unwrap()), "the file is not named: {said}");
    said
}

#[test]
fn torn_and_foreign_recordings_leave_the_store_as_it_was() {
    let store = store();
    let good = std::fs::read(&field().outings[0].0).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let mut files = Vec::new();
    let mut write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        files.push(path);
    };
    write("torn.mcap", &good[..good.len() * 6 / 10]);
    write("empty.bag", b"");
    write("text.bag", b"#ROSBAG V2.0\nthis is no bag at all");
    write("noise.db3", &(0..4096_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect::<Vec<_>>());
    let mut flipped = good.clone();
    let middle = flipped.len() / 2;
    flipped[middle..middle + 64].iter_mut().for_each(|byte| *byte ^= 0x5a);
    write("flipped.mcap", &flipped);
    for file in &files {
        refused(store.path(), file);
    }
    let listing = json(store.path(), &["ls"]);
    assert_eq!((&listing["traversals"], &listing["recordings"]), (&serde_json::json!([]), &serde_json::json!([])));
    let state = json(store.path(), &["fsck"]);
    assert_eq!((state["objects"].as_u64(), state["faults"].as_array().map(Vec::len)), (Some(0), Some(0)));
    assert_eq!(std::fs::read_dir(store.path().join("tmp")).unwrap().count(), 0, "tmp/ is swept");
}

#[test]
fn fsck_finds_what_is_damaged_or_missing() {
    let store = store();
    let (file, route, slot, _) = &field().outings[0];
    json(
        store.path(),
        &["ingest", text(file), "--site", "old-zoo", "--route", route, "--slot", slot, "--pass", "experience"],
    );
    let mut objects: Vec<_> = std::fs::read_dir(store.path().join("objects"))
        .unwrap()
        .flatten()
        .flat_map(|shelf| std::fs::read_dir(shelf.path()).unwrap().flatten())
        .map(|entry| entry.path())
        .collect();
    objects.sort();
    let whole = std::fs::read(&objects[0]).unwrap();
    let mut damaged = whole.clone();
    damaged[0] ^= 1;
    std::fs::write(&objects[0], damaged).unwrap();
    let output = furrow().arg("--store").arg(store.path()).args(["fsck", "--json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    let state: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let faults = state["faults"].as_array().unwrap();
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert_eq!(faults[0]["subject"].as_str().unwrap(), objects[0].file_name().unwrap().to_str().unwrap());

    std::fs::write(&objects[0], whole).unwrap();
    // Every object of an outing is needed by something: whichever goes missing is missed.
    for object in objects.iter().step_by(objects.len() / 7 + 1) {
        let bytes = std::fs::read(object).unwrap();
        std::fs::remove_file(object).unwrap();
        let output = furrow().arg("--store").arg(store.path()).args(["fsck", "--json"]).output().unwrap();
        let name = object.file_name().unwrap().to_str().unwrap();
        assert!(String::from_utf8_lossy(&output.stdout).contains(name), "{name} is missing and nobody misses it");
        std::fs::write(object, bytes).unwrap();
    }
}

#[test]
fn a_wrong_matrix_is_an_error_with_its_line() {
    let store = store();
    let path = store.path().join("wrong.toml");
    std::fs::write(&path, "name = \"x\"\nsite = \"s\"\ncodebok = 3\n").unwrap();
    let output = furrow().arg("--store").arg(store.path()).args(["plan", text(&path)]).output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1));
    assert!(said.contains("wrong.toml") && said.contains("line 3") && said.contains("codebok"), "{said}");
}

#[test]
fn a_wrong_trajectory_is_an_error_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        path
    };
    let good = write("good.tum", b"1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 1 1 0 0 0 0 1\n4 2 1 1 0 0 0 1\n");
    let refused = |estimate: &Path, options: &[&str]| {
        let output = furrow().args(["compare-trajectory", text(&good), text(estimate)]).args(options).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{said}");
        (output.status.code(), said)
    };
    let cases: [(&str, &[u8], &str); 6] = [
        ("torn.tum", b"1 0 0 0 0 0 0 1\n2 1 0 0", "torn.tum: line 2: expected 8 numbers"),
        ("words.tum", b"here be dragons\n", "words.tum: line 1: expected 8 numbers"),
        ("binary.tum", &[0x31, 0xff, 0xfe], "binary.tum: byte 1 is no text"),
        ("nothing.tum", b"", "nothing.tum: the file holds no pose"),
        ("elsewhen.tum", b"901 0 0 0 0 0 0 1\n902 1 0 0 0 0 0 1\n", "only 0 poses"),
        ("kitti.txt", b"1 0 0 7 0 1 0 8 0 0 1 9\n", "not both have stamps"),
    ];
    for (name, bytes, expected) in cases {
        let (code, said) = refused(&write(name, bytes), &[]);
        assert_eq!(code, Some(1), "{name}: {said}");
        assert!(said.contains(expected), "{name}: {said}");
    }
    assert_eq!(refused(&good, &["--delta", "0"]).0, Some(2));
    assert_eq!(refused(&good, &["--align", "sideways"]).0, Some(2));
    let same = furrow().args(["compare-trajectory", text(&good), text(&good), "--json"]).output().unwrap();
    let report: serde_json::Value = serde_json::from_slice(&same.stdout).unwrap();
    assert!(report["report"]["ape_m"]["max"].as_f64().unwrap() < 1e-9, "{report}");
}
