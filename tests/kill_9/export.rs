//! An export that is killed leaves a whole file or none.

use crate::support::kill::{killed_after, moments};
use crate::support::recordings::ran;
use std::time::Instant;

#[test]
fn an_export_killed_at_any_moment_leaves_nothing_of_the_name_or_all() {
    let store = &ran().store;
    let folder = tempfile::tempdir().unwrap();
    let file = crate::support::command::quoted(folder.path().join("killed.mcap"));
    let export = format!("export run latest --experience both -o {file}");
    let began = Instant::now();
    store.json(&export);
    let length = began.elapsed();
    let whole = std::fs::read(&file).unwrap();
    std::fs::remove_file(&file).unwrap();
    let mut killed = 0;
    for delay in moments(length, 10) {
        killed += u32::from(killed_after(store.furrow(&export), delay));
        // The kill may come between the name and the end.
        if file.exists() {
            assert!(std::fs::read(&file).unwrap() == whole, "half a file after {delay:?}");
            std::fs::remove_file(&file).unwrap();
        }
    }
    assert!(killed >= 1, "no kill came in time");
}
