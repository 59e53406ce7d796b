//! kill -9 at any moment: the store opens, the same command ends with the same ids, and nothing is half there.

use crate::command::{field, furrow, json, matrix, store, text};
use std::path::Path;
use std::time::{Duration, Instant};

const MOMENTS: u32 = 20;

/// Runs a command and kills it after `delay`; true where it was still running.
pub fn killed_after(store: &Path, args: &[&str], delay: Duration) -> bool {
    let mut child = furrow()
        .arg("--store")
        .arg(store)
        .args(args)
        .stdout(std::process::Stdio::null())
        .stderr(std::process::Stdio::null())
        .spawn()
        .unwrap();
    std::thread::sleep(delay);
    let running = child.try_wait().unwrap().is_none();
    // SIGKILL on Unix: the process gets no chance to tidy up.
    let _ = child.kill();
    child.wait().unwrap();
    running
}

/// Delays that look random and are the same every time, spread over the command's whole length.
pub fn moments(whole: Duration, count: u32) -> impl Iterator<Item = Duration> {
    (0..count).map(move |i| whole.mul_f64((f64::from(i) + f64::from(i * 7919 % 13) / 13.0) / f64::from(count)))
}

#[test]
fn an_ingest_killed_at_any_moment_is_as_if_it_had_not_begun() {
    let (file, route, slot, purpose) = &field().outings[0];
    let args = ["ingest", text(file), "--site", "old-zoo", "--route", route, "--slot", slot, "--pass", purpose];
    let undisturbed = store();
    let began = Instant::now();
    let expected = json(undisturbed.path(), &args);
    let whole = began.elapsed();
    let objects = json(undisturbed.path(), &["fsck"])["objects"].clone();

    let disturbed = store();
    let mut killed = 0;
    for delay in moments(whole, MOMENTS) {
        if !killed_after(disturbed.path(), &args, delay) {
            continue;
        }
        killed += 1;
        assert_eq!(json(disturbed.path(), &["fsck"])["faults"], serde_json::json!([]), "after {delay:?}");
        let listed = json(disturbed.path(), &["ls"])["traversals"].as_array().unwrap().len();
        assert!(listed <= 1, "after {delay:?}: {listed} traversals");
    }
    assert!(killed >= MOMENTS / 2, "only {killed} of {MOMENTS} came in time");
    let mut found = json(disturbed.path(), &args);
    found["known"] = expected["known"].clone();
    assert_eq!(found, expected);
    let state = json(disturbed.path(), &["fsck"]);
    assert_eq!((&state["objects"], &state["faults"]), (&objects, &serde_json::json!([])));
    assert_eq!(std::fs::read_dir(disturbed.path().join("tmp")).unwrap().count(), 0, "tmp/ is swept");
}

#[test]
fn a_run_killed_at_any_moment_ends_with_the_same_ids() {
    let undisturbed = store();
    field().ingest(undisturbed.path());
    let matrix_file = matrix(undisturbed.path());
    let args = ["run", text(&matrix_file)];
    let began = Instant::now();
    let expected = json(undisturbed.path(), &args);
    let whole = began.elapsed();

    let disturbed = store();
    field().ingest(disturbed.path());
    let mut killed = 0;
    for delay in moments(whole, MOMENTS) {
        killed += u32::from(killed_after(disturbed.path(), &args, delay));
        assert_eq!(json(disturbed.path(), &["fsck"])["faults"], serde_json::json!([]), "after {delay:?}");
    }
    assert!(killed >= 1, "no kill came in time");
    let mut found = json(disturbed.path(), &args);
    let (found_cells, expected_cells) = (found["cells"].as_array_mut().unwrap(), expected["cells"].as_array().unwrap());
    for (found, expected) in found_cells.iter_mut().zip(expected_cells) {
        found["cached"] = expected["cached"].clone();
    }
    // What this very command computed is not what the undisturbed one did.
    found["work"] = expected["work"].clone();
    assert_eq!(found, expected);
}
