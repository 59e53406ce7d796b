//! An ingest that is killed leaves the store as it was, or all of its traversal.

use crate::support::kill::{killed_after, moments};
use crate::support::recordings::recordings;
use crate::support::store::Store;
use std::time::Instant;

const MOMENTS: u32 = 20;

#[test]
fn an_ingest_killed_at_any_moment_is_as_if_it_had_not_begun() {
    let ingest = recordings()[0].ingest();
    let undisturbed = Store::new();
    let began = Instant::now();
    let expected = undisturbed.json(&ingest);
    let whole = began.elapsed();
    let objects = undisturbed.json("fsck")["objects"].clone();

    let disturbed = Store::new();
    let mut killed = 0;
    for delay in moments(whole, MOMENTS) {
        if !killed_after(disturbed.furrow(&ingest), delay) {
            continue;
        }
        killed += 1;
        disturbed.assert_intact();
        let listed = disturbed.json("ls")["traversals"].as_array().unwrap().len();
        assert!(listed <= 1, "after {delay:?}: {listed} traversals");
    }
    assert!(killed >= MOMENTS / 2, "only {killed} of {MOMENTS} came in time");
    let mut found = disturbed.json(&ingest);
    found["known"] = expected["known"].clone();
    assert_eq!(found, expected);
    assert_eq!(disturbed.assert_intact()["objects"], objects);
    assert_eq!(disturbed.unfinished_files(), 0, "tmp/ is swept");
}
