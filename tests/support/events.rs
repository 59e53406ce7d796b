//! The table of events of a cell, row by row.

use furrow_catalog::{Catalog, tables};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// A row of the table.
pub struct Row {
    pub experience: String,
    pub log_likelihood: f64,
    pub inliers: Option<u32>,
    pub decision: String,
    pub correct: Option<bool>,
    pub error_m: Option<f64>,
    pub travelled_m: f64,
}

/// The rows of each live frame, by stamp.
pub fn rows_by_frame(store: &Path, cell: &Value) -> BTreeMap<i64, Vec<Row>> {
    let catalog = Catalog::open(store).unwrap();
    let id = cell["events"].as_str().unwrap().parse().unwrap();
    let table = tables::from_parquet("events", catalog.objects().read(id).unwrap()).unwrap();
    let texts = |name: &str| -> Vec<String> {
        table.column(name).unwrap().str().unwrap().iter().map(|text| text.unwrap().to_owned()).collect()
    };
    let correct: Vec<Option<bool>> = table.column("correct").unwrap().bool().unwrap().iter().collect();
    let error_m: Vec<Option<f64>> = table.column("error_m").unwrap().f64().unwrap().iter().collect();
    let travelled_m = tables::f64s(&table, "travelled_m").unwrap();
    let (experience, decision) = (texts("experience"), texts("decision"));
    let inliers = tables::optional_u32s(&table, "inliers").unwrap();
    let log_likelihood = tables::f64s(&table, "log_likelihood").unwrap();
    let mut frames: BTreeMap<i64, Vec<Row>> = BTreeMap::new();
    for (i, stamp) in tables::i64s(&table, "live_stamp_ns").unwrap().into_iter().enumerate() {
        frames.entry(stamp).or_default().push(Row {
            experience: experience[i].clone(),
            log_likelihood: log_likelihood[i],
            inliers: inliers[i],
            decision: decision[i].clone(),
            correct: correct[i],
            error_m: error_m[i],
            travelled_m: travelled_m[i],
        });
    }
    frames
}

/// The localisation of a frame, where there is one.
pub fn accepted(rows: &[Row]) -> Option<&Row> {
    rows.iter().find(|row| row.decision == "accepted")
}

/// The inliers of each accepted frame, by stamp.
pub fn accepted_inliers(store: &Path, cell: &Value) -> BTreeMap<i64, u32> {
    let of_frame = |(stamp, rows): (i64, Vec<Row>)| Some((stamp, accepted(&rows)?.inliers?));
    rows_by_frame(store, cell).into_iter().filter_map(of_frame).collect()
}
