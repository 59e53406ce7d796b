//! What a cell answered to each live image.

use crate::support::store::Store;
use furrow_catalog::{Catalog, tables};
use furrow_model::outcome::event;
use serde_json::Value;
use std::collections::BTreeSet;

/// An answer to a live image: the candidates by rank, each with its place and, where it was verified, its inliers.
pub type Ranked = Vec<(usize, Option<u32>)>;

/// The stored answers of a cell, by live image; places and live images are numbered in the order of their stamps.
pub fn answers(store: &Store, cell: &Value) -> Vec<Ranked> {
    let catalog = Catalog::open(store.path()).unwrap();
    let outcome = catalog.outcome(cell["key"].as_str().unwrap().parse().unwrap()).unwrap().unwrap();
    let nodes = catalog.experience(outcome.members[0].id).unwrap().nodes;
    let table = tables::from_parquet("events", catalog.objects().read(outcome.events).unwrap()).unwrap();
    let live = tables::i64s(&table, event::LIVE_STAMP_NS).unwrap();
    let inliers = tables::optional_u32s(&table, event::INLIERS).unwrap();
    let frames: Vec<i64> = live.iter().copied().collect::<BTreeSet<i64>>().into_iter().collect();
    let mut answers = vec![Ranked::new(); frames.len()];
    // Rows of a frame come by rank; the row of a new place has no node.
    for (i, stamp) in table.column(event::NODE_STAMP_NS).unwrap().i64().unwrap().iter().enumerate() {
        let place = stamp.and_then(|stamp| nodes.iter().position(|node| node.stamp_ns == stamp));
        let frame = frames.binary_search(&live[i]).unwrap();
        answers[frame].extend(place.map(|place| (place, inliers[i])));
    }
    answers
}
