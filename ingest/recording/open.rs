//! Which container a path is, by its first bytes.

use super::chunk::ZSTD_MAGIC;
use super::container::Container;
use super::db3::{self, Db3};
use super::error::{COPY_OR_SALVAGE, ReadError};
use super::file::Source;
use super::mcap::{self, Mcap};
use super::ros1::{self, Bag};
use super::rosbag2_folder::list_parts;
use super::stream::Recording;
use std::path::{Path, PathBuf};

/// Opens a recording: a ROS1 bag 2.0, an MCAP file, a rosbag2 `.db3` file, a rosbag2 folder or its `metadata.yaml`. One
/// part of a split recording opens as that part alone.
///
/// # Errors
/// Any other file, and files that are cut short, unindexed or damaged: with the byte, what was expected there and what
/// to do.
pub fn open(path: &Path) -> Result<Recording, ReadError> {
    let parts = match list_parts(path)? {
        Some(parts) => parts.iter().map(|part| open_part(part)).collect::<Result<Vec<_>, _>>()?,
        None => vec![open_part(path)?],
    };
    Ok(Recording::from_parts(path, parts))
}

/// Opens several files as one recording, as a recorder splits it or as several recorders wrote it at once: messages
/// come in order of receive time across the files. Errors are those of [`open`]; so is a list without files.
pub fn open_many(paths: &[PathBuf]) -> Result<Recording, ReadError> {
    let Some(first) = paths.first() else {
        let none = std::io::Error::new(std::io::ErrorKind::InvalidInput, "no file was given");
        return Err(ReadError::Io { path: PathBuf::new(), doing: "opening a recording", source: none });
    };
    let mut parts = Vec::new();
    for path in paths {
        parts.extend(open(path)?.into_parts());
    }
    Ok(Recording::from_parts(first, parts))
}

/// Opens a file as the container that its first bytes name.
fn open_part(path: &Path) -> Result<Box<dyn Container>, ReadError> {
    let mut source = Source::open(path)?;
    let start = source.take(source.len().min(16), "its first bytes")?;
    if start.starts_with(ros1::MAGIC) {
        return Ok(Box::new(Bag::open(path)?));
    }
    if start.starts_with(mcap::MAGIC) {
        return Ok(Box::new(Mcap::open(path)?));
    }
    if start.starts_with(db3::MAGIC) {
        return Ok(Box::new(Db3::open(path)?));
    }
    let (found, advice) = describe_other(&start);
    let expected = "a ROS1 bag 2.0, an MCAP file or a rosbag2 .db3 file";
    Err(ReadError::unexpected(path, 0, expected, found, advice))
}

/// What a file is that begins like no container, and what to do about it.
fn describe_other(start: &[u8]) -> (String, &'static str) {
    if start.starts_with(b"#ROSBAG V") || start.starts_with(b"#ROSRECORD") {
        let text = String::from_utf8_lossy(start);
        let line = text.lines().next().unwrap_or_default();
        (format!("'{line}'"), "bring a copy to version 2.0 with `rosbag fix`")
    } else if start.starts_with(&ZSTD_MAGIC) {
        let advice = "expand it first: `zstd -d FILE` (rosbag2's compression_mode: file)";
        ("a file compressed as a whole".to_owned(), advice)
    } else if [ros1::MAGIC, mcap::MAGIC, db3::MAGIC].iter().any(|magic| magic.starts_with(start)) {
        (format!("only {} bytes of one", start.len()), COPY_OR_SALVAGE)
    } else {
        (format!("a file that begins with {start:02x?}"), "give a recording; its name does not matter")
    }
}
