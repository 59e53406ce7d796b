//! A cell that fails stops only itself.

use super::{of_cells, units};
use crate::support::matrix::Matrix;
use crate::support::recordings::ingested;
use crate::support::store::replace;
use serde_json::json;

#[test]
fn a_failing_cell_stops_only_itself_and_is_taken_up_again() {
    let store = ingested();
    let matrix = Matrix::small().write(store.path());
    let image = store.first_image("10:00");
    let bytes = std::fs::read(&image).unwrap();
    replace(&image, "damaged");

    // Without the flag the run ends there, as a failure.
    store.fails(format!("run {matrix}"), 1, &[]);
    let result = store.furrow(format!("run {matrix} --keep-going")).json_with_code(3);
    assert_eq!(of_cells(&result, "experience"), ["08:00"]);
    let failed: Vec<&str> =
        result["failed"].as_array().unwrap().iter().map(|f| f["experience"].as_str().unwrap()).collect();
    assert_eq!(failed, ["10:00", "both"]);
    let name = image.file_name().unwrap().to_str().unwrap();
    assert!(result["failed"][0]["reason"].as_str().unwrap().contains(name), "{result}");
    assert_eq!(store.json("status latest")["runs"][0]["failed"].as_array().unwrap().len(), 2);

    // Repaired, only what failed is computed: nothing of the cell that was finished.
    replace(&image, bytes);
    let result = store.json(format!("run {matrix} --failed"));
    assert_eq!(of_cells(&result, "experience"), ["08:00", "10:00", "both"]);
    assert_eq!((units(&result, "cells"), &result["failed"]), (2, &json!([])));
    assert_eq!(store.json("status latest")["runs"][0]["failed"], json!([]));
}
