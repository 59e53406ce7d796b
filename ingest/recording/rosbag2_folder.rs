//! rosbag2 folders: `metadata.yaml` names the parts; without it, as after a power cut, they are those that lie there.

use super::error::{COPY_OR_SALVAGE, ReadError};
use super::file::Source;
use super::part_names::{PartName, in_order};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The file that makes a folder a recording.
const METADATA: &str = "metadata.yaml";
/// Metadata take a few kilobytes.
const MOST_METADATA_BYTES: u64 = 1 << 24;

/// The parts of a folder, in its order, and what is noted of them.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    pub(crate) files: Vec<PathBuf>,
    pub(crate) notes: Vec<String>,
}

#[derive(Deserialize)]
struct Metadata {
    rosbag2_bagfile_information: Information,
}

/// What is used of it; rosbag2 adds keys with every version.
#[derive(Deserialize)]
struct Information {
    relative_file_paths: Vec<String>,
    #[serde(default)]
    compression_format: String,
    #[serde(default)]
    compression_mode: String,
}

/// Whether a folder is a recording: it has a `metadata.yaml`, or files that only rosbag2 writes.
pub fn is_recording_folder(folder: &Path) -> bool {
    folder.join(METADATA).is_file() || list_files(folder).is_ok_and(|files| !files.is_empty())
}

/// The folder that a path to its `metadata.yaml` means; `None` for any other path.
pub fn folder_of_metadata(path: &Path) -> Option<PathBuf> {
    let is_metadata = path.file_name().is_some_and(|name| name == METADATA) && path.is_file();
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    is_metadata.then(|| folder.to_owned())
}

/// The parts of a rosbag2 folder; `None` where `path` is neither a folder nor a `metadata.yaml`.
pub(crate) fn list_parts(path: &Path) -> Result<Option<Parts>, ReadError> {
    let folder = match folder_of_metadata(path) {
        Some(folder) => folder,
        None if path.is_dir() => path.to_owned(),
        None => return Ok(None),
    };
    let there = list_files(&folder).map_err(ReadError::io(&folder, "listing"))?;
    if folder.join(METADATA).exists() { listed(&folder, there) } else { unlisted(&folder, there) }.map(Some)
}

/// The parts that were found in a folder without `metadata.yaml`, which nothing but their names holds together; `None`
/// for any other path.
pub(crate) fn unlisted_parts(path: &Path) -> Result<Option<Vec<PathBuf>>, ReadError> {
    if !path.is_dir() || path.join(METADATA).exists() || !is_recording_folder(path) {
        return Ok(None);
    }
    Ok(list_parts(path)?.map(|parts| parts.files))
}

/// The files in a folder that are named as rosbag2's, or as such files packed.
fn list_files(folder: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if PartName::of(&path).is_some() && path.is_file() {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// The parts that the metadata list.
fn listed(folder: &Path, there: Vec<PathBuf>) -> Result<Parts, ReadError> {
    let file = folder.join(METADATA);
    let mut source = Source::open(&file)?;
    let wrong_metadata = |found: String| ReadError::unexpected(&file, 0, "rosbag2 metadata", found, COPY_OR_SALVAGE);
    if source.len() > MOST_METADATA_BYTES {
        return Err(wrong_metadata(format!("{} bytes", source.len())));
    }
    let text = source.take(source.len(), "metadata")?;
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&text);
    let metadata: Metadata = serde_norway::from_slice(text).map_err(|error| wrong_metadata(error.to_string()))?;
    let information = metadata.rosbag2_bagfile_information;
    if !matches!(information.compression_format.as_str(), "" | "none" | "zstd")
        && !information.compression_mode.is_empty()
    {
        let name = information.compression_format;
        return Err(ReadError::Compression { path: file, offset: 0, name, readable: "zstd" });
    }
    if information.relative_file_paths.is_empty() {
        return Err(wrong_metadata("no relative_file_paths".to_owned()));
    }
    let mut parts = Parts::default();
    for name in &information.relative_file_paths {
        // Old versions wrote the folder's own name before the file's. A part is never looked for outside the folder.
        let name = Path::new(name).file_name().ok_or_else(|| wrong_metadata(format!("a part named '{name}'")))?;
        parts.files.push(expanded_or_packed(&folder.join(name)).ok_or_else(|| {
            let names: Vec<_> =
                there.iter().filter_map(|path| path.file_name()).map(|name| name.display().to_string()).collect();
            ReadError::MissingPart {
                path: file.clone(),
                part: name.display().to_string(),
                found: if names.is_empty() { "none".to_owned() } else { names.join(", ") },
            }
        })?);
    }
    let is_read = |path: &PathBuf| parts.files.iter().any(|part| PartName::same_recording(part, path));
    for path in there.iter().filter(|path| !is_read(path)) {
        let name = path.file_name().unwrap_or_default().display();
        parts.notes.push(format!(
            "{name} lies in {}, but metadata.yaml does not list it: it was not read (`ros2 bag reindex` lists all)",
            folder.display()
        ));
    }
    Ok(parts)
}

/// The file of a part, or the one that it was expanded to or packed into.
fn expanded_or_packed(part: &Path) -> Option<PathBuf> {
    PartName::twins(part).into_iter().find(|path| path.is_file())
}

/// The parts that lie in a folder without metadata.
fn unlisted(folder: &Path, there: Vec<PathBuf>) -> Result<Parts, ReadError> {
    if there.is_empty() {
        let (expected, found) = ("a rosbag2 folder with metadata.yaml or .db3 or .mcap files", "a folder without");
        let advice = "give the recording's files themselves, or write the metadata with `ros2 bag reindex`";
        return Err(ReadError::unexpected(folder, 0, expected, found, advice));
    }
    let (files, note) = in_order(there).map_err(|names| {
        let expected = "a folder without metadata.yaml to hold the parts of one recording (NAME_0.db3, NAME_1.db3 …)";
        let advice = "give the recording that you mean by its file, or write the metadata with `ros2 bag reindex`";
        ReadError::unexpected(folder, 0, expected, names.join(", "), advice)
    })?;
    let mut notes = vec![format!("{} has no metadata.yaml: its {} parts were read", folder.display(), files.len())];
    notes.extend(note);
    Ok(Parts { files, notes })
}
