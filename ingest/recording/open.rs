//! Which container a path is, by its first bytes.

use super::container::Container;
use super::db3::{self, Db3};
use super::error::{COPY_OR_SALVAGE, ReadError};
use super::expanded::{Expanded, is_packed};
use super::file::Source;
use super::mcap::{self, Mcap};
use super::ros1::{self, Bag};
use super::rosbag2_folder::{Parts, list_parts};
use super::stream::Recording;
use std::path::{Path, PathBuf};

/// Opens a recording: a ROS1 bag 2.0, an MCAP file, a rosbag2 `.db3` file, a rosbag2 folder or its `metadata.yaml`. One
/// part of a split recording opens as that part alone.
///
/// # Errors
/// Any other file, and files that are cut short, unindexed or damaged: with the byte, what was expected there and what
/// to do.
pub fn open(path: &Path) -> Result<Recording, ReadError> {
    let parts = list_parts(path)?.unwrap_or_else(|| Parts { files: vec![path.to_owned()], notes: Vec::new() });
    let opened = parts.files.iter().map(|part| open_part(part)).collect::<Result<Vec<_>, _>>()?;
    Ok(Recording::from_parts(path, opened, parts.notes))
}

/// Opens several files as one recording, as a recorder splits it or as several recorders wrote it at once: messages
/// come in order of receive time across the files. Errors are those of [`open`]; so is a list without files.
pub fn open_many(paths: &[PathBuf]) -> Result<Recording, ReadError> {
    let Some(first) = paths.first() else {
        let none = std::io::Error::new(std::io::ErrorKind::InvalidInput, "no file was given");
        return Err(ReadError::Io { path: PathBuf::new(), doing: "opening a recording", source: none });
    };
    let (mut parts, mut notes) = (Vec::new(), Vec::new());
    for path in paths {
        let opened = open(path)?;
        notes.extend_from_slice(opened.notes());
        parts.extend(opened.into_parts());
    }
    Ok(Recording::from_parts(first, parts, notes))
}

/// Opens a file as the container that its first bytes name. One that is compressed as a whole is expanded first.
fn open_part(path: &Path) -> Result<Box<dyn Container>, ReadError> {
    if is_packed(&first_bytes(path)?) {
        return Ok(Box::new(Expanded::open(path, open_plain)?));
    }
    open_plain(path)
}

fn first_bytes(path: &Path) -> Result<Vec<u8>, ReadError> {
    let mut source = Source::open(path)?;
    source.take(source.len().min(16), "its first bytes")
}

fn open_plain(path: &Path) -> Result<Box<dyn Container>, ReadError> {
    let start = first_bytes(path)?;
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

/// Programs that compress files as a whole: how their files begin, their names, and what to do.
const OTHER_PACKINGS: [(&[u8], &str, &str); 6] = [
    (&[0x1f, 0x8b], "gzip", "expand it first: `gunzip -k FILE`"),
    (b"BZh", "bzip2", "expand it first: `bunzip2 -k FILE`"),
    (&[0xfd, b'7', b'z', b'X', b'Z'], "xz", "expand it first: `unxz -k FILE`"),
    (&[0x04, 0x22, 0x4d, 0x18], "lz4", "expand it first: `lz4 -d FILE`"),
    (b"PK\x03\x04", "zip", "expand it first: `unzip FILE`"),
    (&[b'7', b'z', 0xbc, 0xaf], "7z", "expand it first: `7z x FILE`"),
];

/// What a file is that begins like no container, and what to do about it.
fn describe_other(start: &[u8]) -> (String, &'static str) {
    if start.starts_with(b"#ROSBAG V") || start.starts_with(b"#ROSRECORD") {
        let text = String::from_utf8_lossy(start);
        let line = text.lines().next().unwrap_or_default();
        (format!("'{line}'"), "bring a copy to version 2.0 with `rosbag fix`")
    } else if is_packed(start) {
        ("a file compressed as a whole, twice".to_owned(), "expand it first: `zstd -d FILE`")
    } else if let Some((_, name, advice)) = OTHER_PACKINGS.iter().find(|(magic, ..)| start.starts_with(magic)) {
        (format!("a file compressed as a whole with {name}"), *advice)
    } else if [ros1::MAGIC, mcap::MAGIC, db3::MAGIC].iter().any(|magic| magic.starts_with(start)) {
        (format!("only {} bytes of one", start.len()), COPY_OR_SALVAGE)
    } else {
        (format!("a file that begins with {start:02x?}"), "give a recording; its name does not matter")
    }
}
