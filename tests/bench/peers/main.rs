//! `make bench`: what furrow computes for long, timed against the peers' figures. Prints a table and writes
//! `target/bench.json`. `cargo bench --profile release --bench peers -- step vocabulary` measures only these groups,
//! and writes nothing.
//!
//! The peers' figures are CPU times of one thread on their authors' reference box (libviso2, openFABMAP, OpenCV SURF),
//! so ours are measured on one thread too, as CPU time, but for the rows that say otherwise. Python's readers of
//! recordings are timed in the same run. Real images come from FURROW_DATA; without them those rows are left out and
//! said so.

use row::Row;
use std::path::Path;

#[path = "../../support/command.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod command;
#[path = "../../support/cpu_time.rs"]
mod cpu_time;
#[path = "../../support/field_views.rs"]
#[allow(dead_code, reason = "the tests use the rest")]
mod field_views;
mod generator;
#[path = "../../support/golden_data.rs"]
mod golden_data;
mod images;
mod ingest;
mod odometry;
#[path = "../../support/peak_memory.rs"]
mod peak_memory;
mod places;
#[path = "../../support/python.rs"]
mod python;
mod reading;
mod row;
mod step;
mod synthetic;

/// Measures a group of rows; the folder is FURROW_DATA, where there is one.
type Group = fn(&Path, &mut Vec<Row>);

/// Groups by name, and whether they need the real images.
const GROUPS: [(&str, bool, Group); 9] = [
    ("street", true, images::on_street_images),
    ("drive", true, images::on_the_real_drive),
    ("tracks", true, odometry::tracks),
    ("reading", true, reading::raw_images),
    ("generators", false, |_, rows| generator::generators(rows)),
    ("ingest", false, |_, rows| ingest::large_images(rows)),
    ("step", false, |_, rows| step::localisation_step(rows)),
    ("fabmap", false, |_, rows| places::chow_liu_and_fabmap(rows)),
    ("vocabulary", false, |_, rows| places::vocabulary(rows)),
];

fn main() {
    // Cargo passes --bench.
    let chosen: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with("--")).collect();
    if let Some(unknown) = chosen.iter().find(|name| GROUPS.iter().all(|group| group.0 != name.as_str())) {
        eprintln!("no group {unknown}: there are {}", GROUPS.map(|group| group.0).join(", "));
        std::process::exit(2);
    }
    let one_thread = rayon::ThreadPoolBuilder::new().num_threads(1).build_global();
    if let Err(error) = one_thread {
        eprintln!("cannot measure on one thread: {error}");
        std::process::exit(1);
    }
    println!(
        "CPU time of one thread where a row does not say otherwise; ratio = ours / peer's published figure \
         (other machine)"
    );
    let mut rows = Vec::new();
    let data = golden_data::data();
    for (_, needs_data, group) in GROUPS.iter().filter(|group| chosen.is_empty() || chosen.iter().any(|c| c == group.0))
    {
        match &data {
            Some(data) => group(data, &mut rows),
            None if !needs_data => group(Path::new(""), &mut rows),
            None => {}
        }
    }
    if !chosen.is_empty() {
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/bench.json");
    let written =
        serde_json::to_string_pretty(&rows).map_err(std::io::Error::from).and_then(|text| std::fs::write(&path, text));
    match written {
        Ok(()) => println!("written to target/bench.json"),
        Err(error) => {
            eprintln!("cannot write {}: {error}", path.display());
            std::process::exit(1);
        }
    }
}
