//! Killed anywhere while it trains or paints, the same command ends with the ids of one that was left alone.

use crate::support::kill::{killed_after, moments};
use crate::support::recordings::ingested_for_training;
use crate::support::store::Store;
use serde_json::Value;
use std::time::Instant;

#[test]
fn training_and_generating_killed_at_any_moment_end_with_the_same_ids() {
    let undisturbed = ingested_for_training();
    let parent = undisturbed.experience("10:00")["experience"].as_str().unwrap().to_owned();
    let train = "generator train --site old-zoo --from 10:00 --to 08:00 --images 30".to_owned();
    let generate = format!("generate {parent} --generator otf:10:00>08:00 --z 0.33,0.66,1");
    let disturbed = ingested_for_training();
    let mut killed = 0;
    for line in [train, generate] {
        let began = Instant::now();
        let expected = undisturbed.json(&line);
        for delay in moments(began.elapsed(), 8) {
            killed += u32::from(killed_after(disturbed.furrow(&line), delay));
            disturbed.assert_intact();
        }
        let mut found = disturbed.json(&line);
        // How many images were left to paint is the one thing that may differ.
        let children = found.get_mut("experiences").and_then(Value::as_array_mut).into_iter().flatten();
        for (found, expected) in children.zip(expected["experiences"].as_array().into_iter().flatten()) {
            found["painted"] = expected["painted"].clone();
        }
        assert_eq!(found, expected);
    }
    assert!(killed >= 4, "only {killed} kills came in time");
    let listed = |store: &Store| store.json("ls")["experiences"].as_array().unwrap().len();
    assert_eq!(listed(&disturbed), listed(&undisturbed));
}
