//! What other people's scripts rely on: commands, JSON forms, exit codes.

use crate::command::{field, furrow, json, matrix, run, store, text};
use std::collections::BTreeSet;

fn keys(value: &serde_json::Value) -> BTreeSet<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

#[track_caller]
fn has(value: &serde_json::Value, wanted: &[&str]) {
    let missing: Vec<&&str> = wanted.iter().filter(|key| !keys(value).contains(**key)).collect();
    assert!(missing.is_empty(), "{missing:?} missing in {value}");
}

#[test]
fn json_has_the_promised_fields() {
    let store = store();
    let summaries = field().ingest(store.path());
    has(&summaries[0], &["recording", "traversal", "experience", "pairs", "unpaired", "trajectory", "keyframes"]);
    has(&summaries[0]["trajectory"], &["frames", "length_m", "failed_steps"]);
    assert!(summaries[1]["experience"].is_null(), "an evaluation pass is no experience");
    let listing = json(store.path(), &["ls"]);
    assert_eq!(listing["traversals"].as_array().unwrap().len(), 4);
    assert_eq!(listing["experiences"].as_array().unwrap().len(), 2);
    has(&listing["traversals"][0], &["traversal", "site", "route", "slot", "pass", "recording"]);
    has(&listing["experiences"][0], &["experience", "site", "route", "slot", "kind", "nodes"]);
    let matrix = matrix(store.path());
    let planned = json(store.path(), &["plan", text(&matrix)]);
    has(&planned, &["run", "cells"]);
    let fields = [
        "key",
        "live",
        "experience",
        "codebook",
        "method",
        "frames",
        "good",
        "percent_good",
        "lost_fraction",
        "max_lost_m",
        "correct",
        "wrong",
        "cached",
    ];
    has(&planned["cells"][0], &fields);
    has(&json(store.path(), &["fsck"]), &["objects", "rows", "faults"]);
    json(store.path(), &["run", text(&matrix)]);
    let status = json(store.path(), &["status"]);
    has(&status["runs"][0], &["run", "matrix", "cells", "finished"]);
}

#[test]
fn the_store_is_found_by_option_variable_and_folder() {
    let store = store();
    let inside = store.path().join("objects");
    let by_variable = furrow().env("FURROW_STORE", store.path()).arg("ls").output().unwrap();
    let by_folder = furrow().current_dir(&inside).arg("ls").output().unwrap();
    let by_option = run(&["ls", "--store", text(store.path())]);
    assert!(by_variable.status.success() && by_folder.status.success() && by_option.status.success());
    let elsewhere = tempfile::tempdir().unwrap();
    let nowhere = furrow().current_dir(elsewhere.path()).arg("ls").output().unwrap();
    assert_eq!(nowhere.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&nowhere.stderr).contains("furrow init"));
}

#[test]
fn exit_codes_are_as_designed() {
    let store = store();
    let code = |args: &[&str]| run(args).status.code();
    assert_eq!(code(&["ls", "--store", text(store.path())]), Some(0));
    assert_eq!(code(&["ls", "--store", "/nowhere/at/all"]), Some(1));
    assert_eq!(code(&["no-such-command"]), Some(2));
    assert_eq!(
        code(&["ingest", "x.bag", "--site", "s", "--route", "r", "--slot", "25:00", "--pass", "experience"]),
        Some(2)
    );
    assert_eq!(
        code(&["ingest", "x.bag", "--site", "s", "--route", "r", "--slot", "08:00", "--pass", "holiday"]),
        Some(2)
    );
    assert_eq!(
        code(&[
            "--store",
            text(store.path()),
            "ingest",
            "x.bag",
            "--site",
            "s",
            "--route",
            "r",
            "--slot",
            "08:00",
            "--pass",
            "experience"
        ]),
        Some(1)
    );
}

#[test]
fn a_matrix_that_cannot_run_wholly_says_which_cells_and_why() {
    let store = store();
    field().ingest(store.path());
    let path = store.path().join("partly.toml");
    let text_of = |live: &str, experience: &str, route: &str| {
        format!(
            "name = \"partly\"\nsite = \"old-zoo\"\ncodebook = {{ words = 300, route = \"{route}\", images = 30 }}\nverification = {{ threshold = 40 }}\n[axes]\nlive = [{live}]\nexperience = [{experience}]\n"
        )
    };
    std::fs::write(&path, text_of("\"08:00\"", "\"08:00\", \"16:00\"", "vocabulary")).unwrap();
    let output = furrow().arg("--store").arg(store.path()).args(["--json", "run", text(&path)]).output().unwrap();
    assert_eq!(output.status.code(), Some(3), "{}", String::from_utf8_lossy(&output.stderr));
    let result: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(result["cells"].as_array().unwrap().len(), 1);
    let reason = result["blocked"][0]["reason"].as_str().unwrap();
    assert!(reason.contains("16:00") && reason.contains("08:00, 10:00"), "{reason}");

    // The leakage guard: a vocabulary of the very route that is judged.
    let (file, _, _, _) = &field().outings[2];
    json(
        store.path(),
        &["ingest", text(file), "--site", "old-zoo", "--route", "main", "--slot", "10:00", "--pass", "vocabulary"],
    );
    std::fs::write(&path, text_of("\"08:00\"", "\"08:00\"", "main")).unwrap();
    let planned = json(store.path(), &["plan", text(&path)]);
    assert_eq!(planned["cells"], serde_json::json!([]));
    assert!(planned["blocked"][0]["reason"].as_str().unwrap().contains("same route"), "{planned}");

    // And one of the same ground under another name, which only the true positions betray.
    json(
        store.path(),
        &["ingest", text(file), "--site", "old-zoo", "--route", "elsewhere", "--slot", "10:00", "--pass", "vocabulary"],
    );
    std::fs::write(&path, text_of("\"08:00\"", "\"08:00\"", "elsewhere")).unwrap();
    let planned = json(store.path(), &["plan", text(&path)]);
    assert!(planned["blocked"][0]["reason"].as_str().unwrap().contains("true positions"), "{planned}");

    std::fs::write(&path, text_of("\"08:00\"", "\"08:00\"", "vocabulry")).unwrap();
    let planned = json(store.path(), &["plan", text(&path)]);
    assert!(planned["blocked"][0]["reason"].as_str().unwrap().contains("did you mean 'vocabulary'?"), "{planned}");
}

#[test]
fn completions_and_manual_are_printed() {
    let completions = run(&["completions", "bash"]);
    assert!(String::from_utf8_lossy(&completions.stdout).contains("furrow"));
    assert!(String::from_utf8_lossy(&run(&["man"]).stdout).contains(".TH furrow"));
}
