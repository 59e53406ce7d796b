//! Checks a store: every object's bytes against its name, every row against the objects, every recording against its
//! digest. Reads only.

use crate::records::{self, CodebookRecord, GeneratorRecord, TraversalRecord};
use crate::{Catalog, CatalogError, tables};
use furrow_model::{Experience, ExperienceKind, ObjectId, Outcome};
use rayon::prelude::*;
use serde::Serialize;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// What a check found.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Findings {
    /// Objects checked.
    pub objects: u64,
    /// Rows checked.
    pub rows: u64,
    /// What is wrong; empty where all is well.
    pub faults: Vec<Fault>,
}

/// Something wrong in a store.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize)]
pub struct Fault {
    /// `damaged-object`, `damaged-record`, `misplaced-file`, `missing-object`, `missing-recording`, `damaged-recording`
    /// or `index`.
    pub kind: &'static str,
    /// What it concerns.
    pub subject: String,
    /// What was expected and found, and what to do.
    pub detail: String,
}

/// Checks the whole store. `progress` is called with the objects (done, total).
///
/// # Errors
/// Only where the store cannot be listed at all; what is wrong inside is a [`Fault`].
pub fn fsck(catalog: &Catalog, progress: &(dyn Fn(u64, u64) + Sync)) -> Result<Findings, CatalogError> {
    let files = object_files(&catalog.root().join("objects"))?;
    let total = files.len() as u64;
    let done = std::sync::atomic::AtomicU64::new(0);
    let mut faults: Vec<Fault> = files
        .par_iter()
        .filter_map(|path| {
            let fault = check_object(path);
            progress(done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1, total);
            fault
        })
        .collect();

    let (rows, references) = catalog.index().references()?;
    for &(table, id) in &references {
        if !catalog.objects().contains(id) {
            faults.push(Fault {
                kind: "missing-object",
                subject: id.to_string(),
                detail: format!(
                    "a row of {table} points at it: restore it from a copy of the store, or ingest or run again"
                ),
            });
        }
    }
    faults.extend(check_records(catalog, &references));
    faults.extend(check_recordings(catalog)?);
    faults.extend(catalog.index().integrity()?.into_iter().map(|detail| Fault {
        kind: "index",
        subject: "catalogue.db".to_owned(),
        detail,
    }));
    faults.sort();
    Ok(Findings { objects: total, rows, faults })
}

fn object_files(folder: &Path) -> Result<Vec<PathBuf>, CatalogError> {
    let mut files = Vec::new();
    for shelf in list(folder)? {
        files.extend(list(&shelf)?);
    }
    Ok(files)
}

fn list(folder: &Path) -> Result<Vec<PathBuf>, CatalogError> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).map_err(CatalogError::file("list", folder))?.flatten().map(|entry| entry.path()).collect();
    paths.sort();
    Ok(paths)
}

fn check_object(path: &Path) -> Option<Fault> {
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let Ok(id) = name.parse::<ObjectId>() else {
        return Some(Fault {
            kind: "misplaced-file",
            subject: path.display().to_string(),
            detail: "expected only objects named by 64 hexadecimal digits here: move it elsewhere".to_owned(),
        });
    };
    let detail = match digest_of_file(path) {
        Ok(found) if found == id => return None,
        Ok(found) => format!("its bytes have the digest {found}: restore it from a copy of the store"),
        Err(error) => format!("cannot be read: {error}"),
    };
    Some(Fault { kind: "damaged-object", subject: name, detail })
}

/// The objects that records name must be there too.
fn check_records(catalog: &Catalog, references: &[(&'static str, ObjectId)]) -> Vec<Fault> {
    let mut faults = Vec::new();
    let mut named: Vec<(String, ObjectId)> = Vec::new();
    for &(table, id) in references {
        match objects_named_by(catalog, table, id) {
            Ok(objects) => named.extend(objects.into_iter().map(|object| (format!("{table} {}", id.short()), object))),
            Err(CatalogError::MissingObject { .. } | CatalogError::DamagedObject { .. }) => {}
            Err(error) => {
                faults.push(Fault { kind: "damaged-record", subject: id.to_string(), detail: error.to_string() })
            }
        }
    }
    named.sort_by_key(|(_, object)| *object);
    named.dedup_by_key(|(_, object)| *object);
    faults.extend(named.into_iter().filter(|(_, object)| !catalog.objects().contains(*object)).map(|(by, object)| {
        Fault {
            kind: "missing-object",
            subject: object.to_string(),
            detail: format!("{by} needs it: restore it from a copy of the store"),
        }
    }));
    faults
}

/// The objects that a record names, itself and through its tables.
fn objects_named_by(catalog: &Catalog, table: &str, id: ObjectId) -> Result<Vec<ObjectId>, CatalogError> {
    let objects = catalog.objects();
    Ok(match table {
        "traversals" => {
            let record: TraversalRecord = records::read(objects, id)?;
            let frames = if objects.contains(record.frames) {
                tables::frames_from_parquet(objects.read(record.frames)?)?
            } else {
                Vec::new()
            };
            let mut found = vec![record.calibration, record.frames, record.chain];
            found.extend(record.ground_truth);
            found.extend(record.sensors.into_iter().flat_map(|sensor| sensor.parts));
            found.extend(frames.iter().map(|frame| frame.left));
            found.extend(frames.iter().filter_map(|frame| frame.right).map(|right| right.image));
            found
        }
        "experiences" => {
            let record: Experience = records::read(objects, id)?;
            let nodes = record.nodes.iter().map(|node| node.left);
            let generator = match record.kind {
                ExperienceKind::Recorded => None,
                ExperienceKind::Generated { generator, .. } => Some(generator),
            };
            nodes.chain([record.calibration, record.chain]).chain(generator).collect()
        }
        "codebooks" => {
            let record: CodebookRecord = records::read(objects, id)?;
            vec![record.vocabulary, record.tree, record.samples]
        }
        "generators" => vec![records::read::<GeneratorRecord>(objects, id)?.weights],
        "outcomes" => vec![records::read::<Outcome>(objects, id)?.events],
        _ => Vec::new(),
    })
}

fn check_recordings(catalog: &Catalog) -> Result<Vec<Fault>, CatalogError> {
    let mut faults = Vec::new();
    for recording in catalog.recordings()? {
        for part in &recording.parts {
            let path = catalog.recording_path(part.digest);
            let fault = match digest_of_file(&path) {
                Ok(found) if found == part.digest => continue,
                Ok(found) => ("damaged-recording", format!("its bytes have the digest {found}")),
                Err(error) => ("missing-recording", error.to_string()),
            };
            let detail = format!("'{}' of recording '{}': {}; copy it here again", part.name, recording.name, fault.1);
            faults.push(Fault { kind: fault.0, subject: part.digest.to_string(), detail });
        }
    }
    Ok(faults)
}

/// The BLAKE3 digest of a file, read piece by piece.
///
/// # Errors
/// Where the file cannot be read.
pub fn digest_of_file(path: &Path) -> std::io::Result<ObjectId> {
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(File::open(path)?)?;
    Ok(ObjectId(*hasher.finalize().as_bytes()))
}
