//! Generated experiences, as a user makes and uses them.

mod children;
mod claims;
mod experiment;
mod programs;
mod relighting;

use crate::support::store::Store;
use serde_json::Value;

/// What trains a generator from the field's two vocabulary slots, in a few seconds.
const TRAIN: &str = "generator train --site old-zoo --from 10:00 --to 08:00 --images 30";

/// Trains the flow from 10:00 to 08:00 on a route.
#[track_caller]
fn train(store: &Store, route: &str) -> Value {
    store.json(format!("{TRAIN} --route {route}"))
}

/// The id of the recorded experience at 10:00.
fn parent_id(store: &Store) -> String {
    store.experience("10:00")["experience"].as_str().unwrap().to_owned()
}
