//! A run that is killed goes on where it was.

use crate::support::kill::{killed_after, moments};
use crate::support::matrix::Matrix;
use crate::support::recordings::ingested;
use std::time::Instant;

const MOMENTS: u32 = 20;

#[test]
fn a_run_killed_at_any_moment_ends_with_the_same_ids() {
    let undisturbed = ingested();
    let run = format!("run {}", Matrix::small().write(undisturbed.path()));
    let began = Instant::now();
    let expected = undisturbed.json(&run);
    let whole = began.elapsed();

    let disturbed = ingested();
    let mut killed = 0;
    for delay in moments(whole, MOMENTS) {
        killed += u32::from(killed_after(disturbed.furrow(&run), delay));
        disturbed.assert_intact();
    }
    assert!(killed >= 1, "no kill came in time");
    let mut found = disturbed.json(&run);
    let (found_cells, expected_cells) = (found["cells"].as_array_mut().unwrap(), expected["cells"].as_array().unwrap());
    for (found, expected) in found_cells.iter_mut().zip(expected_cells) {
        found["cached"] = expected["cached"].clone();
    }
    // What this very command computed is not what the undisturbed one did.
    found["work"] = expected["work"].clone();
    assert_eq!(found, expected);
}
