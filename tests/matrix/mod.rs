//! Matrices as a user declares them: axes, rules and contrasts; what is computed twice and what is not, failures,
//! reproduction, comparison. What a cell's numbers mean is counted again elsewhere (`recount`).

mod axes;
mod caching;
mod comparison;
mod contrasts;
mod failure;
mod reproduction;
mod shipped;

use serde_json::Value;

/// A key of every cell.
fn of_cells<'a>(value: &'a Value, key: &str) -> Vec<&'a str> {
    value["cells"].as_array().unwrap().iter().map(|cell| cell[key].as_str().unwrap()).collect()
}

/// Units that were computed by one kind of stage.
fn units(result: &Value, kind: &str) -> u64 {
    result["work"][kind]["units"].as_u64().unwrap_or(0)
}
