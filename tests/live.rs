//! Localisation frame by frame decides as a run does; on the clock it keeps up or says what it skipped.

use crate::command::{field, furrow, json, matrix, store, text};
use std::collections::BTreeMap;

#[test]
fn in_lockstep_a_live_drive_decides_as_the_run_does() {
    let store = store();
    field().ingest(store.path());
    let matrix = matrix(store.path());
    let result = json(store.path(), &["run", text(&matrix)]);
    let both = result["cells"].as_array().unwrap().iter().find(|cell| cell["experience"] == "both").unwrap();
    let drive = json(store.path(), &["live", text(&matrix), "--lockstep"]);
    assert_eq!(drive["localised"], both["good"], "{both}");
    assert_eq!((&drive["frames"], &drive["looked_at"]), (&both["frames"], &both["frames"]));
    // Which experience won which frame, from the single cells: the one with more inliers.
    let single = |name: &str| {
        let cell = result["cells"].as_array().unwrap().iter().find(|cell| cell["experience"] == name).unwrap();
        crate::evaluation::accepted_inliers(store.path(), cell)
    };
    let (early, late) = (single("08:00"), single("10:00"));
    let decisions = drive["decisions"].as_array().unwrap();
    let mut won: BTreeMap<&str, usize> = BTreeMap::new();
    for decision in decisions {
        let stamp = decision["stamp_ns"].as_i64().unwrap();
        let (a, b) = (early.get(&stamp).copied(), late.get(&stamp).copied());
        assert_eq!(decision["inliers"].as_u64().map(|n| n as u32), a.max(b), "{decision}");
        if a != b {
            let winner = if a > b { "08:00" } else { "10:00" };
            assert_eq!(decision["experience"], winner, "{decision}");
            *won.entry(winner).or_default() += 1;
        }
    }
    assert!(won.len() == 2, "one experience won every frame: {won:?}");

    // On the clock, far too fast to look at every frame: what was not looked at is counted, and the drive ends.
    let hurried = json(store.path(), &["live", text(&matrix), "--speed", "200"]);
    assert!(hurried["looked_at"].as_u64() < hurried["frames"].as_u64(), "{}", hurried["looked_at"]);
    assert_eq!(hurried["decisions"].as_array().unwrap().len() as u64, hurried["looked_at"].as_u64().unwrap());

    for (wrong, code, word) in [(["--speed", "0"], 2, "above 0"), (["--at", "09:00"], 1, "no live pass at 09:00")] {
        let output =
            furrow().arg("--store").arg(store.path()).args(["live", text(&matrix)]).args(wrong).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.code() == Some(code) && said.contains(word), "{said}");
    }
}
