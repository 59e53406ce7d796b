//! `make bench`: how fast raw images are read from recordings in the page cache, beside Python's readers in the same
//! run.

use crate::python::Python;
use crate::row::{Row, row};
use furrow_ingest::message::Image;
use furrow_ingest::recording::{ReadError, open};
use serde_json::Value;
use std::ffi::OsStr;
use std::ops::ControlFlow;
use std::path::Path;
use std::time::Instant;

const PACKAGES: [&str; 7] = [
    "lz4==4.4.5",
    "mcap==1.6.0",
    "numpy==2.4.6",
    "pillow==13.0.0",
    "rosbags==0.11.9",
    "typing_extensions==4.16.0",
    "zstandard==0.25.0",
];
const SCRIPT: &str = include_str!("reading.py");
/// The fastest of so many rounds counts, which other programs disturbed least; of Python's, too.
const ROUNDS: usize = 5;

/// Files that the script writes, what our rows on one and two threads are called, and Python's reader of such a file.
const FILES: [(&str, [&str; 2], &str); 5] = [
    ("none.bag", ["reading ROS1, none, one thread", "reading ROS1, none, two threads"], "rosbags, same run,"),
    ("lz4.bag", ["reading ROS1, lz4, one thread", "reading ROS1, lz4, two threads"], "rosbags, same run,"),
    ("none.mcap", ["reading MCAP, none, one thread", "reading MCAP, none, two threads"], "mcap, same run,"),
    ("lz4.mcap", ["reading MCAP, lz4, one thread", "reading MCAP, lz4, two threads"], "mcap, same run,"),
    ("zstd.mcap", ["reading MCAP, zstd, one thread", "reading MCAP, zstd, two threads"], "mcap, same run,"),
];

/// Reads the drive's images, 0.46 GB of grey pixels, from each container and packing: GB of unpacked messages a second.
pub fn raw_images(data: &Path, rows: &mut Vec<Row>) {
    if let Err(why) = measure(&data.join("kitti_raw_drive_A"), rows) {
        eprintln!("SKIPPED: no figures for reading: {why}");
    }
}

fn measure(drive: &Path, rows: &mut Vec<Row>) -> Result<(), String> {
    if !drive.is_dir() {
        return Err(format!("{} is no folder", drive.display()));
    }
    let python = Python::with("peer-readers", &PACKAGES)?;
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    for (name, [one, two], peer) in FILES {
        let file = folder.path().join(name);
        let written = python.json(SCRIPT, &["write".as_ref(), drive.as_os_str(), file.as_os_str()])?;
        let rounds = ROUNDS.to_string();
        let theirs = python.json(SCRIPT, &["read".as_ref(), file.as_os_str(), OsStr::new(&rounds)])?;
        let number = |of: &Value, key: &str| of[key].as_f64().ok_or_else(|| format!("no {key} in {of}"));
        let bytes = number(&written, "message_bytes")?;
        let peer_value = (bytes / number(&theirs, "seconds")? / 1e7).round() / 100.0;
        for (name, threads) in [(one, 1), (two, 2)] {
            let seconds = seconds(&file, threads, bytes as u64)?;
            rows.push(row(name, bytes / seconds / 1e9, "GB/s", peer, Some(peer_value)));
        }
        std::fs::remove_file(&file).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// The shortest time that opening and reading takes on so many threads; all messages must come.
fn seconds(file: &Path, threads: usize, bytes: u64) -> Result<f64, String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|error| error.to_string())?;
    let mut shortest = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = Instant::now();
        let read = pool.install(|| read_images(file)).map_err(|error| error.to_string())?;
        shortest = shortest.min(start.elapsed().as_secs_f64());
        if read != bytes {
            return Err(format!("{read} bytes of messages were read, {bytes} were written"));
        }
    }
    Ok(shortest)
}

/// Visits every image as ingest does; the bytes of those messages that hold all their rows.
fn read_images(file: &Path) -> Result<u64, ReadError> {
    let recording = open(file)?;
    let images = recording.topics().iter().filter(|topic| topic.type_name == Image::TYPE);
    let wanted: Vec<&str> = images.map(|topic| topic.name.as_str()).collect();
    let mut bytes = 0;
    let _: ControlFlow<()> = recording.read(&wanted, &mut |_| (), &mut |message| {
        let image = Image::decode(message.topic.encoding, message.bytes);
        if image.is_ok_and(|image| image.rows().is_ok()) {
            bytes += message.bytes.len() as u64;
        }
        ControlFlow::Continue(())
    })?;
    Ok(bytes)
}
