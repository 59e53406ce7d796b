//! rosbag2 folders: `metadata.yaml` names the parts.

use super::error::{COPY_OR_SALVAGE, ReadError};
use super::file::Source;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The file that makes a folder a recording.
const METADATA: &str = "metadata.yaml";
/// Metadata take a few kilobytes.
const MOST_METADATA_BYTES: u64 = 1 << 24;

#[derive(Deserialize)]
struct Metadata {
    rosbag2_bagfile_information: Information,
}

/// What is used of it; rosbag2 adds keys with every version.
#[derive(Deserialize)]
struct Information {
    relative_file_paths: Vec<String>,
}

/// The parts that a rosbag2 folder lists, in its order; `None` where `path` is neither a folder nor a `metadata.yaml`.
pub(crate) fn list_parts(path: &Path) -> Result<Option<Vec<PathBuf>>, ReadError> {
    let folder = match path.file_name() {
        _ if path.is_dir() => path,
        Some(name) if name == METADATA => path.parent().unwrap_or(Path::new("")),
        _ => return Ok(None),
    };
    let file = folder.join(METADATA);
    if !file.exists() {
        let (expected, found) = ("a rosbag2 folder with metadata.yaml", "a folder without");
        let advice = "give the recording's files themselves, or write the metadata with `ros2 bag reindex`";
        return Err(ReadError::unexpected(path, 0, expected, found, advice));
    }
    let mut source = Source::open(&file)?;
    let wrong_metadata = |found: String| ReadError::unexpected(&file, 0, "rosbag2 metadata", found, COPY_OR_SALVAGE);
    if source.len() > MOST_METADATA_BYTES {
        return Err(wrong_metadata(format!("{} bytes", source.len())));
    }
    let text = source.take(source.len(), "metadata")?;
    let metadata: Metadata = serde_norway::from_slice(&text).map_err(|error| wrong_metadata(error.to_string()))?;
    let names = metadata.rosbag2_bagfile_information.relative_file_paths;
    if names.is_empty() {
        return Err(wrong_metadata("no relative_file_paths".to_owned()));
    }
    // Old versions wrote the folder's own name before the file's. A part is never looked for outside the folder.
    let part = |name: &String| {
        let name = Path::new(name).file_name().ok_or_else(|| wrong_metadata(format!("a part named '{name}'")))?;
        Ok(folder.join(name))
    };
    names.iter().map(part).collect::<Result<Vec<_>, _>>().map(Some)
}
