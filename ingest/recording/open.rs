//! Finding out what a path is, by its first bytes.

use super::chunk::ZSTD_MAGIC;
use super::db3::{self, Db3};
use super::error::{COPY_OR_SALVAGE, ReadError};
use super::file::Source;
use super::mcap_file::{self, Mcap};
use super::ros1_bag::{self, Bag};
use super::stream::{Part, Recording};
use super::{folder, stream};
use std::path::{Path, PathBuf};

/// Opens a recording: a ROS1 bag 2.0, an MCAP file, a rosbag2 `.db3` file, a rosbag2 folder or its `metadata.yaml`. One part of a
/// split recording opens as that part alone.
///
/// # Errors
/// Anything else, and files that are cut short, unindexed or unsound: with the byte, what was expected there and what to do.
pub fn open(path: &Path) -> Result<Recording, ReadError> {
    let parts = match folder::parts(path)? {
        Some(parts) => parts.iter().map(|part| open_part(part)).collect::<Result<Vec<_>, _>>()?,
        None => vec![open_part(path)?],
    };
    Ok(stream::Recording::of_parts(path, parts))
}

/// Opens several files as one recording, as a recorder splits it or as several recorders wrote it at once: messages come in order
/// of receive time across the files. Errors are those of [`open`]; no path at all is one too.
pub fn open_many(paths: &[PathBuf]) -> Result<Recording, ReadError> {
    let Some(first) = paths.first() else {
        let none = std::io::Error::new(std::io::ErrorKind::InvalidInput, "no file was given");
        return Err(ReadError::Io { path: PathBuf::new(), doing: "opening a recording", source: none });
    };
    let mut parts = Vec::new();
    for path in paths {
        parts.extend(open(path)?.into_parts());
    }
    Ok(Recording::of_parts(first, parts))
}

fn open_part(path: &Path) -> Result<Part, ReadError> {
    let mut source = Source::open(path)?;
    let start = source.take(source.len().min(16), "its first bytes")?;
    let bad = |found: String, advice| {
        let expected = "a ROS1 bag 2.0, an MCAP file or a rosbag2 .db3 file";
        Err(ReadError::bad(path, 0, expected, found, advice))
    };
    if start.starts_with(ros1_bag::MAGIC) {
        Bag::open(path).map(Part::Ros1)
    } else if start.starts_with(mcap_file::MAGIC) {
        Mcap::open(path).map(Part::Mcap)
    } else if start.starts_with(db3::MAGIC) {
        Db3::open(path).map(Part::Db3)
    } else if start.starts_with(b"#ROSBAG V") || start.starts_with(b"#ROSRECORD") {
        let line = String::from_utf8_lossy(&start).lines().next().unwrap_or_default().to_owned();
        bad(format!("'{line}'"), "bring a copy to version 2.0 with `rosbag fix`")
    } else if start.starts_with(&ZSTD_MAGIC) {
        bad(
            "a file compressed as a whole".to_owned(),
            "expand it first: `zstd -d FILE` (rosbag2's compression_mode: file)",
        )
    } else if [ros1_bag::MAGIC, mcap_file::MAGIC, db3::MAGIC].iter().any(|magic| magic.starts_with(&start)) {
        bad(format!("only {} bytes of one", start.len()), COPY_OR_SALVAGE)
    } else {
        bad(format!("a file that begins with {start:02x?}"), "give a recording; its name does not matter")
    }
}
