//! A bound on memory: it changes no result, what it says is enough is enough, and what cannot fit is said.

use crate::support::matrix::Matrix;
use crate::support::recordings::ingested;
use crate::support::store::Store;
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
    let free = ingested();
    let expected = free.json(format!("run {} -j 1 --memory 16GB", Matrix::small().write(free.path())));

    let bounded = ingested();
    let run = format!("run {} -j 1 --memory", Matrix::small().write(bounded.path()));
    let refused = bounded.fails(format!("{run} 100MB"), 1, &["within 100 MB", "on 1 threads", "--memory"]);
    let least = refused.split("need ").nth(1).unwrap().split(" MB").next().unwrap();
    let found = bounded.json(format!("{run} {least}MB"));
    assert_eq!(results(&found), results(&expected));
    assert!(nodes_prepared(&found) > nodes_prepared(&expected), "nodes were forgotten and prepared again");
    assert_eq!(found["work"]["verifying"]["units"], expected["work"]["verifying"]["units"], "frames were not");
}

#[test]
fn a_wrong_size_is_wrong_usage() {
    Store::new().fails("run m.toml --memory lots", 2, &["512MB"]);
}
