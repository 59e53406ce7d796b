//! A bound on memory: it changes no result, what it says is enough is enough, and what cannot fit is said. Ingest needs
//! no bound: it takes no more for a long recording than for a short one.

use crate::support::command::{furrow, quoted};
use crate::support::matrix::Matrix;
use crate::support::peak_memory::peak_mib;
use crate::support::recordings::ingested;
use crate::support::repeated::repeated;
use crate::support::store::Store;
use serde_json::Value;
use std::process::Stdio;

/// What of a cell may not depend on the bound.
fn results(run: &Value) -> Vec<[&Value; 3]> {
    run["cells"].as_array().unwrap().iter().map(|cell| [&cell["key"], &cell["events"], &cell["evaluation"]]).collect()
}

fn nodes_prepared(run: &Value) -> u64 {
    run["work"]["features of candidate nodes"]["units"].as_u64().unwrap()
}

#[test]
fn results_are_the_same_within_the_least_memory_that_is_enough() {
    let free = ingested();
    let expected = free.json(format!("run {} -j 1 --memory 16GB", Matrix::small().write(free.path())));

    let bounded = ingested();
    let run = format!("run {} -j 1 --memory", Matrix::small().write(bounded.path()));
    let refused = bounded.fails(format!("{run} 100MB"), 1, &["within 100 MB", "on 1 threads", "--memory"]);
    let least = refused.split("need ").nth(1).unwrap().split(" MB").next().unwrap();
    let found = bounded.json(format!("{run} {least}MB"));
    assert_eq!(results(&found), results(&expected));
    assert!(nodes_prepared(&found) > nodes_prepared(&expected), "nodes were forgotten and prepared again");
    assert_eq!(found["work"]["verifying"]["units"], expected["work"]["verifying"]["units"], "frames were not");
}

#[test]
fn a_wrong_size_is_wrong_usage() {
    Store::new().fails("run m.toml --memory lots", 2, &["512MB"]);
}

/// What the peaks of two ingests may differ by: threads come to their work in another order, and a frame's pose, name
/// and sensor rows are kept. Of the seven eighths that only the longer recording has, the images alone are twice that.
const MOST_MIB: f64 = 32.0;

#[test]
fn ingest_of_a_recording_eight_times_as_long_takes_no_more_memory() {
    let folder = tempfile::tempdir().unwrap();
    let [once, long] = ["once.mcap", "long.mcap"].map(|name| quoted(folder.path().join(name)));
    furrow(format!("simulate --site old-zoo --slot 10:00 --size 160x90 --rate 15 --length 2 -o {once}")).text();
    let ingest = |laps| {
        repeated(&once, &long, laps);
        let store = Store::new();
        let label = "--site old-zoo --slot 10:00 --route long --purpose evaluation";
        let line = format!("--store {} ingest {long} {label} --no-recording --json", quoted(store.path()));
        let mut ingest = furrow(line).into_command();
        let mut child = ingest.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
        let peak_mib = peak_mib(&mut child).unwrap();
        let summary: Value = serde_json::from_reader(child.stdout.take().unwrap()).unwrap();
        (summary["pairs"].as_u64().unwrap(), peak_mib)
    };
    let ((few, short_mib), (many, long_mib)) = (ingest(3), ingest(24));
    assert_eq!(many, 8 * few);
    let image_mib = ((many - few) * 2 * 160 * 90 * 3) as f64 / f64::from(1 << 20);
    assert!(image_mib > 2.0 * MOST_MIB, "{image_mib} MiB of images");
    assert!(long_mib < short_mib + MOST_MIB, "{few} pairs: {short_mib} MiB, {many} pairs: {long_mib} MiB");
}
