//! A run comes out of the recordings alone again, or where it does not is said.

use super::of_cells;
use crate::support::matrix::Matrix;
use crate::support::recordings::ingested;
use crate::support::store::Store;
use serde_json::{Value, json};

#[test]
fn a_run_comes_out_of_the_recordings_alone_again() {
    let store = ingested();
    let matrix = Matrix::small().without_collectives().write(store.path());
    let run = store.json(format!("run {matrix}"));
    let elsewhere = tempfile::tempdir().unwrap();
    let fresh = Store::at(elsewhere.path().join("a fresh one"));
    let done = store.json(format!("reproduce latest --into {}", fresh.root()));
    assert_eq!((&done["cells"], &done["passes"], &done["difference"]), (&json!(2), &json!(4), &Value::Null));
    // The fresh store has nothing of the first but bytes of the same names, and stands on its own.
    let again = fresh.json(format!("run {matrix}"));
    assert_eq!(of_cells(&again, "key"), of_cells(&run, "key"));
    fresh.assert_intact();

    // An outcome that was tampered with is found out, and where.
    forge(&store, run["cells"][0]["key"].as_str().unwrap());
    assert!(store.file("catalogue.db").is_file());
    let found = store.furrow("reproduce latest").json_with_code(3);
    assert_eq!(found["difference"]["place"], "body.threshold_inliers", "{found}");
}

/// Puts another number into a cell's outcome, under a right name.
fn forge(store: &Store, cell: &str) {
    let catalog = furrow_catalog::Catalog::open(store.path()).unwrap();
    let outcome = catalog.outcome(cell.parse().unwrap()).unwrap().unwrap();
    let forged = furrow_model::Outcome { threshold_inliers: outcome.threshold_inliers + 1, ..outcome };
    catalog.enter_outcome(&forged).unwrap();
}
