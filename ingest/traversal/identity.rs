//! Who a recording is: its bytes, whatever it is called and wherever it lies.

use crate::traversal::motion::GivenIdentity;
use crate::traversal::{IngestError, IngestProgress, IngestRequest, MotionSource};
use furrow_catalog::index::{RecordingPart, RecordingRow};
use furrow_catalog::{Catalog, Staging, digest};
use furrow_model::{ObjectId, RecordingId};
use std::fs::{self, File};
use std::io::Read;
use std::path::{Path, PathBuf};

/// A recording's name and what is asked of it.
#[derive(Debug)]
pub(crate) struct Identity {
    /// The recording as the index keeps it.
    pub recording: RecordingRow,
    /// The digest of bytes, request and odometry together.
    pub request: ObjectId,
    files: Vec<(PathBuf, ObjectId)>,
    keep: bool,
}

impl Identity {
    /// Reads every byte once.
    pub fn of(request: &IngestRequest, progress: &mut dyn FnMut(IngestProgress)) -> Result<Self, IngestError> {
        let (files, whole) = files_of(request)?;
        let keep = whole && request.keep_recording;
        let bytes_total: u64 = files.iter().map(|(_, _, bytes)| bytes).sum();
        let mut bytes = 0;
        let mut parts = Vec::new();
        let mut digests = Vec::new();
        for (path, name, size) in files {
            let id = digest_file(&path, &mut |read| {
                progress(IngestProgress { stage: "reading", bytes: bytes + read, bytes_total, frames: 0 });
            })?;
            bytes += size;
            parts.push(RecordingPart { digest: id, name, bytes: size });
            digests.push((path, id));
        }
        let id = recording_id(&parts);
        let name =
            request.files.first().and_then(|file| file.file_name()).unwrap_or_default().to_string_lossy().into_owned();
        let asked = digest_request(request, id)?;
        let parts = if keep { parts } else { Vec::new() };
        let recording = RecordingRow { id, name, bytes: bytes_total, parts };
        Ok(Self { recording, request: asked, files: digests, keep })
    }

    /// Puts the recording's files into the store: linked where the file system can, else copied. Loose images are objects already, and
    /// what was not to be kept is not.
    pub fn keep_recording(&self, catalog: &Catalog, staging: &Staging) -> Result<(), IngestError> {
        if !self.keep {
            return Ok(());
        }
        for (path, id) in &self.files {
            let kept = catalog.recording_path(*id);
            if kept.exists() {
                continue;
            }
            let staged = staging.file(&format!("recording-{id}"));
            let wrong = |source| IngestError::File { path: path.clone(), source };
            // A link to a symbolic link would point nowhere once the stick is pulled.
            let source = fs::canonicalize(path).map_err(wrong)?;
            if fs::hard_link(&source, &staged).is_err() {
                fs::copy(&source, &staged).map_err(wrong)?;
            }
            File::open(&staged).and_then(|file| file.sync_all()).map_err(wrong)?;
            fs::rename(&staged, &kept).map_err(wrong)?;
            let folder = kept.parent().unwrap_or(Path::new("."));
            File::open(folder).and_then(|folder| folder.sync_all()).map_err(wrong)?;
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
type Found = (PathBuf, String, u64);

/// Every file of the request with its name and size, and whether the store should keep them as they are.
fn files_of(request: &IngestRequest) -> Result<(Vec<Found>, bool), IngestError> {
    if request.files.is_empty() {
        return Err(IngestError::Request("name at least one recording to ingest".to_owned()));
    }
    if request.files.len() > 1 && request.files.iter().any(|file| file.is_dir()) {
        return Err(IngestError::Request(
            "a folder is a recording of its own: ingest it without other files".to_owned(),
        ));
    }
    let mut files = Vec::new();
    let mut keep = true;
    for file in &request.files {
        if file.is_dir() {
            keep &= file.join("metadata.yaml").is_file();
            collect(file, file, &mut files)?;
        } else {
            let size = fs::metadata(file).map_err(|source| IngestError::File { path: file.clone(), source })?.len();
            let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
            files.push((file.clone(), name, size));
        }
    }
    Ok((files, keep))
}

fn collect(top: &Path, folder: &Path, files: &mut Vec<Found>) -> Result<(), IngestError> {
    let wrong = |source| IngestError::File { path: folder.to_owned(), source };
    let mut paths = fs::read_dir(folder)
        .map_err(wrong)?
        .map(|entry| entry.map(|e| e.path()))
        .collect::<Result<Vec<_>, _>>()
        .map_err(wrong)?;
    paths.sort();
    for path in paths {
        if path.is_dir() {
            collect(top, &path, files)?;
        } else {
            let name = path.strip_prefix(top).unwrap_or(&path).to_string_lossy().into_owned();
            let size = fs::metadata(&path).map_err(wrong)?.len();
            files.push((path, name, size));
        }
    }
    Ok(())
}

fn digest_file(path: &Path, progress: &mut dyn FnMut(u64)) -> Result<ObjectId, IngestError> {
    let wrong = |source| IngestError::File { path: path.to_owned(), source };
    let mut file = File::open(path).map_err(wrong)?;
    let mut hasher = blake3::Hasher::new();
    // Long enough that all cores have some of it to hash.
    let mut buffer = vec![0; 1 << 22];
    let mut done = 0;
    loop {
        let count = file.read(&mut buffer).map_err(wrong)?;
        if count == 0 {
            return Ok(ObjectId(*hasher.finalize().as_bytes()));
        }
        hasher.update_rayon(&buffer[..count]);
        done += count as u64;
        progress(done);
    }
}

/// What was asked, as one digest: every input that changes the result.
fn digest_request(request: &IngestRequest, recording: RecordingId) -> Result<ObjectId, IngestError> {
    let file_digest = |path: &PathBuf| digest_file(path, &mut |_| {});
    let calibration = request.calibration.iter().map(file_digest).collect::<Result<Vec<_>, _>>()?;
    let ground_truth = request.ground_truth_file().as_ref().map(file_digest).transpose()?;
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
    // What is not asked for leaves no trace, so that requests from before it could be asked for keep their names.
    if let Some(list) = asked.as_array_mut() {
        list.extend(given.map(|given| serde_json::json!(given)));
        list.extend(request.field_of_view_deg.map(|degrees| serde_json::json!({ "field_of_view_deg": degrees })));
    }
    Ok(digest(asked.to_string().as_bytes()))
}
