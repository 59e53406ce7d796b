//! Wrong, torn and hostile files: a clear error, the right exit code, and a store that is as it was.

use crate::support::command::{furrow, quoted};
use crate::support::recordings::recordings;
use crate::support::store::Store;
use serde_json::json;

#[test]
fn torn_and_foreign_recordings_leave_the_store_as_it_was() {
    let store = Store::new();
    let good = std::fs::read(&recordings()[0].file).unwrap();
    let mut flipped = good.clone();
    let middle = flipped.len() / 2;
    flipped[middle..middle + 64].iter_mut().for_each(|byte| *byte ^= 0x5a);
    let noise: Vec<u8> = (0..4096_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let files: [(&str, &[u8]); 5] = [
        ("torn.mcap", &good[..good.len() * 6 / 10]),
        ("empty.bag", b""),
        ("text.bag", b"#ROSBAG V2.0\nthis is no bag at all"),
        ("noise.db3", &noise),
        ("flipped.mcap", &flipped),
    ];
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let file = quoted(folder.path().join(name));
        std::fs::write(&file, bytes).unwrap();
        store.fails(format!("ingest {file} --site s --route r --slot 12:00 --purpose experience"), 1, &[name]);
    }
    let listing = store.json("ls");
    assert_eq!((&listing["traversals"], &listing["recordings"]), (&json!([]), &json!([])));
    assert_eq!(store.assert_intact()["objects"], 0);
    assert_eq!(store.unfinished_files(), 0, "tmp/ is swept");
}

#[test]
fn fsck_finds_what_is_damaged_or_missing() {
    let store = Store::new();
    store.json(recordings()[0].ingest());
    let mut objects: Vec<_> = std::fs::read_dir(store.file("objects"))
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
    let state = store.furrow("fsck").json_with_code(3);
    let faults = state["faults"].as_array().unwrap();
    assert_eq!(faults.len(), 1, "{faults:?}");
    assert_eq!(faults[0]["subject"].as_str().unwrap(), objects[0].file_name().unwrap().to_str().unwrap());

    std::fs::write(&objects[0], whole).unwrap();
    // Every object of a traversal is needed by something: whichever goes missing is missed.
    for object in objects.iter().step_by(objects.len() / 7 + 1) {
        let bytes = std::fs::read(object).unwrap();
        std::fs::remove_file(object).unwrap();
        let state = store.furrow("fsck").json_with_code(3).to_string();
        let name = object.file_name().unwrap().to_str().unwrap();
        assert!(state.contains(name), "{name} is missing and nobody misses it");
        std::fs::write(object, bytes).unwrap();
    }
}

#[test]
fn a_wrong_matrix_is_an_error_with_its_line() {
    let store = Store::new();
    let file = store.write("wrong.toml", "name = \"x\"\nsite = \"s\"\ncodebok = 3\n");
    store.fails(format!("plan {file}"), 1, &["wrong.toml", "line 3", "codebok"]);
}

#[test]
fn a_wrong_trajectory_is_an_error_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, bytes: &[u8]| {
        let file = quoted(folder.path().join(name));
        std::fs::write(&file, bytes).unwrap();
        file
    };
    let good = write("good.tum", b"1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 1 1 0 0 0 0 1\n4 2 1 1 0 0 0 1\n");
    let cases: [(&str, &[u8], &str); 6] = [
        ("torn.tum", b"1 0 0 0 0 0 0 1\n2 1 0 0", "torn.tum: line 2: expected 8 numbers"),
        ("words.tum", b"here be dragons\n", "words.tum: line 1: expected 8 numbers"),
        ("binary.tum", &[0x31, 0xff, 0xfe], "binary.tum: byte 1 is no text"),
        ("nothing.tum", b"", "nothing.tum: the file holds no pose"),
        ("elsewhen.tum", b"901 0 0 0 0 0 0 1\n902 1 0 0 0 0 0 1\n", "only 0 poses"),
        ("kitti.txt", b"1 0 0 7 0 1 0 8 0 0 1 9\n", "not both have stamps"),
    ];
    for (name, bytes, expected) in cases {
        furrow(format!("compare-trajectory {good} {}", write(name, bytes))).fails(1, &[expected]);
    }
    furrow(format!("compare-trajectory {good} {good} --delta 0")).fails(2, &[]);
    furrow(format!("compare-trajectory {good} {good} --align sideways")).fails(2, &[]);
    let same = furrow(format!("compare-trajectory {good} {good}")).json();
    assert!(same["report"]["ape_m"]["max"].as_f64().unwrap() < 1e-9, "{same}");
}
