//! A bound on memory: it changes no result, what it says is enough is enough, and what cannot fit is told.

use crate::command::{field, furrow, json, matrix, store, text};
use serde_json::Value;

/// What of a cell may not depend on the bound.
fn results(run: &Value) -> Vec<[&Value; 3]> {
    run["cells"].as_array().unwrap().iter().map(|cell| [&cell["key"], &cell["events"], &cell["evaluation"]]).collect()
}

fn nodes_prepared(run: &Value) -> u64 {
    run["work"]["features of candidate nodes"]["units"].as_u64().unwrap()
}

#[test]
fn results_are_the_same_within_the_least_memory_that_is_enough() {
    let free = store();
    field().ingest(free.path());
    let expected = json(free.path(), &["run", text(&matrix(free.path())), "-j", "1", "--memory", "16GB"]);

    let bounded = store();
    field().ingest(bounded.path());
    let file = matrix(bounded.path());
    let run = |memory: &str| {
        furrow()
            .arg("--store")
            .arg(bounded.path())
            .args(["run", text(&file), "-j", "1", "--memory", memory])
            .output()
            .unwrap()
    };
    let refused = run("100MB");
    let said = String::from_utf8(refused.stderr).unwrap();
    assert_eq!(refused.status.code(), Some(1), "{said}");
    assert!(said.contains("within 100 MB") && said.contains("on 1 threads") && said.contains("--memory"), "{said}");
    let least = said.split("need ").nth(1).unwrap().split(" MB").next().unwrap();
    let found = json(bounded.path(), &["run", text(&file), "-j", "1", "--memory", &format!("{least}MB")]);
    assert_eq!(results(&found), results(&expected));
    assert!(nodes_prepared(&found) > nodes_prepared(&expected), "nodes were forgotten and prepared again");
    assert_eq!(found["work"]["verifying"]["units"], expected["work"]["verifying"]["units"], "frames were not");
}

#[test]
fn a_wrong_size_is_wrong_usage() {
    let folder = store();
    let output =
        furrow().arg("--store").arg(folder.path()).args(["run", "m.toml", "--memory", "lots"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(2) && said.contains("512MB"), "{said}");
}
