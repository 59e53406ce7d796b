//! `make bench`: how fast a recording of large images goes in, and what memory that takes.

use crate::command::{furrow, quoted};
use crate::peak_memory::peak_mib;
use crate::row::{Row, row};
use std::path::Path;
use std::process::Stdio;
use std::time::Instant;

/// Metres of the recording: some sixty pairs at 15 Hz, so that starting up counts little.
const LENGTH_M: &str = "3.2";
/// What is wanted: 15 Hz, one and a half times as fast as recorded.
const WANTED_PAIRS_PER_S: f64 = 22.5;

/// Simulates a raw recording of 1280x720 at 15 Hz and times `furrow ingest` on it, with all cores.
pub fn large_images(rows: &mut Vec<Row>) {
    let measured = tempfile::tempdir().ok().and_then(|folder| ingest(folder.path()));
    let Some(Ingest { pairs_per_s, peak_mib }) = measured else {
        eprintln!("SKIPPED: a recording of 1280x720 could not be simulated and ingested");
        return;
    };
    let name = "ingest, raw 1280x720, all cores";
    rows.push(row(name, pairs_per_s, "pairs/s", "wanted: 1.5 x 15 Hz,", Some(WANTED_PAIRS_PER_S)));
    rows.push(row("its peak memory", peak_mib, "MiB", "wanted: at most", Some(1500.0)));
}

struct Ingest {
    pairs_per_s: f64,
    peak_mib: f64,
}

fn ingest(folder: &Path) -> Option<Ingest> {
    let [recording, store] = ["large.mcap", "store"].map(|name| quoted(folder.join(name)));
    let place = "--site old-zoo --slot 10:00";
    furrow(format!("simulate {place} --size 1280x720 --rate 15 --length {LENGTH_M} -o {recording}")).text();
    furrow(format!("init {store}")).text();
    let ingest = format!("--store {store} ingest {recording} {place} --route bench --purpose evaluation --json");
    let mut ingest = furrow(ingest).into_command();
    ingest.stdout(Stdio::piped()).stderr(Stdio::null());
    let start = Instant::now();
    let mut child = ingest.spawn().ok()?;
    let peak_mib = peak_mib(&mut child)?;
    let seconds = start.elapsed().as_secs_f64();
    let summary: serde_json::Value = serde_json::from_reader(child.stdout.take()?).ok()?;
    Some(Ingest { pairs_per_s: summary["pairs"].as_f64()? / seconds, peak_mib })
}
