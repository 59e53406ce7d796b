//! The identity of a recording and of a request: digests of their bytes, whatever the files are called.

use crate::traversal::error::IngestError;
use crate::traversal::folders::holds_recording;
use crate::traversal::layout_identity::digest_layout;
use crate::traversal::motion::{GivenIdentity, MotionSource};
use crate::traversal::progress::{IngestProgress, IngestStage};
use crate::traversal::request::IngestRequest;
use furrow_catalog::index::{RecordingPart, RecordingRow};
use furrow_catalog::{Catalog, CatalogError, Staging, digest};
use furrow_model::{ObjectId, RecordingId};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// The identity of a recording and of what is asked of it.
#[derive(Debug)]
pub(crate) struct Identity {
    /// The recording as the index keeps it.
    pub(crate) recording: RecordingRow,
    /// The digest of bytes, request and odometry together.
    pub(crate) request: ObjectId,
    files: Vec<(PathBuf, ObjectId)>,
    /// Whether the store keeps the recording's files.
    keeps_files: bool,
}

impl Identity {
    /// Reads every byte once, but for those of the true poses, whose digest is known.
    pub(crate) fn of(
        request: &IngestRequest,
        ground_truth: Option<ObjectId>,
        progress: &mut dyn FnMut(IngestProgress),
    ) -> Result<Self, IngestError> {
        let (files, is_recording) = list_files(request)?;
        let keeps_files = is_recording && request.keep_recording;
        let bytes_total: u64 = files.iter().map(|(_, _, bytes)| bytes).sum();
        let mut bytes = 0;
        let mut parts = Vec::new();
        let mut digests = Vec::new();
        for (path, name, size) in files {
            let id = digest_file(&path, &mut |read| {
                progress(IngestProgress { stage: IngestStage::Digest, bytes: bytes + read, bytes_total, frames: 0 });
            })?;
            bytes += size;
            parts.push(RecordingPart { digest: id, name, bytes: size });
            digests.push((path, id));
        }
        if let Some(layout) = &request.imported.layout {
            parts.push(RecordingPart { digest: digest_layout(layout)?, name: "layout".to_owned(), bytes: 0 });
        }
        let id = recording_id(&parts);
        let name =
            request.files.first().and_then(|file| file.file_name()).unwrap_or_default().to_string_lossy().into_owned();
        let asked = digest_request(request, id, ground_truth)?;
        let parts = if keeps_files { parts } else { Vec::new() };
        let recording = RecordingRow { id, name, bytes: bytes_total, parts };
        Ok(Self { recording, request: asked, files: digests, keeps_files })
    }

    /// Puts the recording's files into the store: hard links where the file system has them, else copies. Does nothing
    /// for loose images, which are objects already, and where the request wants no copy of the recording.
    pub(crate) fn keep_recording(&self, catalog: &Catalog, staging: &Staging) -> Result<(), IngestError> {
        if !self.keeps_files {
            return Ok(());
        }
        for (path, id) in &self.files {
            let kept = catalog.recording_path(*id);
            if kept.exists() {
                continue;
            }
            let staged = staging.file(&format!("recording-{id}"));
            // A hard link to a symbolic link would point nowhere once its memory stick is gone.
            let source = fs::canonicalize(path).map_err(IngestError::file(path))?;
            if fs::hard_link(&source, &staged).is_err() {
                fs::copy(&source, &staged).map_err(CatalogError::file("copy the recording to", &kept))?;
            }
            File::open(&staged).and_then(|file| file.sync_all()).map_err(CatalogError::file("write", &kept))?;
            fs::rename(&staged, &kept).map_err(CatalogError::file("move into place", &kept))?;
            let folder = kept.parent().unwrap_or(Path::new("."));
            File::open(folder).and_then(|file| file.sync_all()).map_err(CatalogError::file("fsync", folder))?;
        }
        Ok(())
    }
}

/// One file's digest names a recording of one file; several are named by all their names and digests.
fn recording_id(parts: &[RecordingPart]) -> RecordingId {
    match parts {
        [part] => RecordingId(part.digest.0),
        parts => {
            let list: String = parts.iter().map(|part| format!("{} {}\n", part.digest, part.name)).collect();
            RecordingId(digest(list.as_bytes()).0)
        }
    }
}

/// A file of a recording: where it lies, its name in the recording, its bytes.
type NamedFile = (PathBuf, String, u64);

/// Every file of the request with its name and size, and whether they are a recording rather than loose images.
fn list_files(request: &IngestRequest) -> Result<(Vec<NamedFile>, bool), IngestError> {
    if request.files.is_empty() {
        return Err(IngestError::Request("name at least one recording to ingest".to_owned()));
    }
    if request.files.len() > 1 && request.files.iter().any(|file| file.is_dir()) {
        return Err(IngestError::Request(
            "a folder is a recording of its own: ingest it without other files".to_owned(),
        ));
    }
    if let Some(layout) = &request.imported.layout {
        let named = |path: &PathBuf| {
            let size = size_of(path)?;
            let name = path.strip_prefix(&layout.root).unwrap_or(path.file_name().map_or(path, Path::new));
            Ok((path.clone(), name.to_string_lossy().into_owned(), size))
        };
        return Ok((layout.files.iter().map(named).collect::<Result<_, IngestError>>()?, false));
    }
    let mut files = Vec::new();
    let mut is_recording = true;
    for file in &request.files {
        if file.is_dir() {
            is_recording &= holds_recording(file);
            collect_files(file, file, &mut files)?;
        } else {
            let size = size_of(file)?;
            let no_file = || IngestError::Request(format!("{}: expected a path with a file name", file.display()));
            let name = file.file_name().ok_or_else(no_file)?.to_string_lossy().into_owned();
            files.push((file.clone(), name, size));
        }
    }
    Ok((files, is_recording))
}

/// Adds the files below `folder`, in the order of their paths, named from `top`.
fn collect_files(top: &Path, folder: &Path, files: &mut Vec<NamedFile>) -> Result<(), IngestError> {
    let entries = fs::read_dir(folder).and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect());
    let mut paths: Vec<PathBuf> = entries.map_err(IngestError::file(folder))?;
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect_files(top, &path, files)?;
        } else {
            let name = path.strip_prefix(top).unwrap_or(&path).to_string_lossy().into_owned();
            let size = size_of(&path)?;
            files.push((path, name, size));
        }
    }
    Ok(())
}

/// The size of a plain file, in bytes: pipes and devices would be read without end.
fn size_of(path: &Path) -> Result<u64, IngestError> {
    let found = fs::metadata(path).map_err(IngestError::file(path))?;
    if found.is_file() {
        return Ok(found.len());
    }
    Err(IngestError::Request(format!("{}: expected a file, found a pipe, a device or a socket", path.display())))
}

fn digest_file(path: &Path, progress: &mut dyn FnMut(u64)) -> Result<ObjectId, IngestError> {
    let mut file = File::open(path).map_err(IngestError::file(path))?;
    let mut hasher = blake3::Hasher::new();
    // Long enough for every core to hash a part of it.
    let mut buffer = vec![0; 1 << 22];
    let mut done = 0;
    loop {
        let count = file.read(&mut buffer).map_err(IngestError::file(path))?;
        if count == 0 {
            return Ok(ObjectId(*hasher.finalize().as_bytes()));
        }
        hasher.update_rayon(&buffer[..count]);
        done += count as u64;
        progress(done);
    }
}

/// Every input that changes the result, as one digest.
fn digest_request(
    request: &IngestRequest,
    recording: RecordingId,
    ground_truth: Option<ObjectId>,
) -> Result<ObjectId, IngestError> {
    let file_digest = |path: &PathBuf| digest_file(path, &mut |_| {});
    let calibration = request.calibration.iter().map(file_digest).collect::<Result<Vec<_>, _>>()?;
    let given = match &request.motion {
        MotionSource::Odometry => None,
        MotionSource::Spacing(metres) => Some(GivenIdentity::Spacing { metres: *metres }),
        MotionSource::Poses(path) => Some(GivenIdentity::Poses { digest: file_digest(path)? }),
    };
    let mut asked = serde_json::json!([
        "ingest",
        request.motion.version(),
        recording,
        request.site,
        request.route,
        request.slot,
        request.purpose,
        request.selection.to_string(),
        request.left,
        request.right,
        calibration,
        ground_truth,
    ]);
    // An option that is not used leaves no trace, so that requests from before it existed keep their digests.
    if let Some(list) = asked.as_array_mut() {
        list.extend(request.left_info.as_ref().map(|topic| serde_json::json!({ "left_info": topic })));
        list.extend(request.right_info.as_ref().map(|topic| serde_json::json!({ "right_info": topic })));
        list.extend(given.map(|given| serde_json::json!(given)));
        list.extend(request.field_of_view_deg.map(|degrees| serde_json::json!({ "field_of_view_deg": degrees })));
    }
    Ok(digest(asked.to_string().as_bytes()))
}
