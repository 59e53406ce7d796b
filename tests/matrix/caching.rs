//! Nothing that is finished is computed again.

use super::units;
use crate::support::matrix::Matrix;
use crate::support::recordings::ingested;
use serde_json::{Value, json};

/// Units that were computed, by kind of stage.
fn work(result: &Value) -> Vec<(String, u64)> {
    let work = result["work"].as_object().unwrap();
    work.iter().map(|(kind, work)| (kind.clone(), work["units"].as_u64().unwrap())).collect()
}

#[test]
fn only_what_a_change_touches_is_computed_again() {
    let store = ingested();
    let listing = store.json("ls");
    let live = |one: &&Value| one["slot"] == "08:00" && one["pass"] == "evaluation";
    let live = listing["traversals"].as_array().unwrap().iter().find(live).unwrap();
    let live_frames = live["counts"]["frames"].as_u64().unwrap();
    let nodes = |slot| store.experience(slot)["nodes"].as_u64().unwrap();

    // The first run computes everything once, as the plan said. Keyframes lie as far apart as those that `ls` counts.
    let two_slots = Matrix::small().without_collectives().keyframes(2.0);
    let matrix = two_slots.clone().experiences(&["08:00"]).write(store.path());
    let planned = store.json(format!("plan {matrix}"));
    let first = store.json(format!("run {matrix}"));
    assert_eq!(units(&first, "features of the vocabulary images"), 60);
    assert_eq!(units(&first, "words of"), live_frames + nodes("08:00"));
    assert_eq!((units(&first, "verifying"), units(&first, "cells")), (live_frames, 1));
    for stage in planned["estimate"].as_array().unwrap() {
        let kind = stage["stage"].as_str().unwrap();
        if kind != "training the vocabulary" {
            assert_eq!(stage["units"].as_u64().unwrap(), units(&first, kind), "{kind}");
        }
    }

    // Unchanged, nothing.
    let again = store.json(format!("run {matrix}"));
    assert_eq!((&again["work"], &again["cells"][0]["cached"]), (&json!({}), &json!(true)));
    assert_eq!(store.json(format!("plan {matrix}"))["estimate"], json!([]));

    // Another threshold: one cell is decided anew; no feature, word, likelihood or inlier is computed.
    let matrix = two_slots.clone().experiences(&["08:00"]).threshold(55).write(store.path());
    let estimate = store.json(format!("plan {matrix}"))["estimate"].clone();
    let stages: Vec<&str> = estimate.as_array().unwrap().iter().map(|stage| stage["stage"].as_str().unwrap()).collect();
    assert_eq!(stages, ["cells"]);
    assert!(estimate[0]["seconds"].as_f64().unwrap() > 0.0, "known from a past run: {estimate}");
    assert_eq!(work(&store.json(format!("run {matrix}"))), [("cells".to_owned(), 1)]);

    // Another slot: the words of its nodes and its own inliers; those of the live traversal stay.
    let matrix = two_slots.write(store.path());
    let more = store.json(format!("run {matrix}"));
    assert_eq!(more["cells"].as_array().unwrap().iter().filter(|cell| cell["cached"] == true).count(), 1);
    assert_eq!(units(&more, "words of"), nodes("10:00"));
    assert_eq!((units(&more, "features of the vocabulary images"), units(&more, "cells")), (0, 1));

    // What was finished for another matrix says where.
    let matrix = two_slots.named("other").write(store.path());
    let planned = store.json(format!("plan {matrix}"));
    assert!(planned["cells"][0]["from"].as_str().unwrap().contains("'small'"), "{}", planned["cells"][0]["from"]);
}
