//! Localisation frame by frame decides as a run does; on the clock it keeps up or says what it skipped.

use crate::support::events::accepted_inliers;
use crate::support::matrix::Matrix;
use crate::support::recordings::ran;
use std::collections::BTreeMap;

#[test]
fn in_lockstep_a_live_traversal_decides_as_the_run_does() {
    let (store, result) = (ran().store.copy(), &ran().run);
    let matrix = Matrix::small().write(store.path());
    let cell = |name: &str| result["cells"].as_array().unwrap().iter().find(|cell| cell["experience"] == name).unwrap();
    let both = cell("both");
    let live = store.json(format!("live {matrix} --lockstep"));
    assert_eq!(live["localised"], both["good"], "{both}");
    assert_eq!((&live["frames"], &live["looked_at"]), (&both["frames"], &both["frames"]));
    // Which experience won which frame, from the single cells: the one with more inliers.
    let [early, late] = ["08:00", "10:00"].map(|name| accepted_inliers(store.path(), cell(name)));
    let decisions = live["decisions"].as_array().unwrap();
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

    // On the clock, far too fast to look at every frame: what was not looked at is counted, and the traversal ends.
    let hurried = store.json(format!("live {matrix} --speed 200"));
    assert!(hurried["looked_at"].as_u64() < hurried["frames"].as_u64(), "{}", hurried["looked_at"]);
    assert_eq!(hurried["decisions"].as_array().unwrap().len() as u64, hurried["looked_at"].as_u64().unwrap());

    store.fails(format!("live {matrix} --speed 0"), 2, &["above 0"]);
    store.fails(format!("live {matrix} --at 09:00"), 1, &["no live traversal at 09:00"]);
}
