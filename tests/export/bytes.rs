//! Equal cells are equal bytes.

use super::run::{Both, both};
use crate::support::command::quoted;

#[test]
fn equal_cells_are_equal_bytes_on_any_number_of_threads() {
    let Both { run, file, folder, .. } = both();
    let again = quoted(folder.path().join("again.mcap"));
    let export = format!("export run latest --experience both -o {again}");
    run.store.furrow(export).env("RAYON_NUM_THREADS", "1").text();
    assert!(std::fs::read(&file).unwrap() == std::fs::read(&again).unwrap(), "the bytes differ");
}
