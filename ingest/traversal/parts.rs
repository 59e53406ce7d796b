//! Several files given as one recording: put in order of time, and refused where they are several recordings.

use crate::message::{CameraInfo, CompressedImage, Image};
use crate::recording::{Recording, open, unlisted_parts};
use crate::topics::find_stereo;
use crate::traversal::error::IngestError;
use crate::traversal::folders::holds_recording;
use crate::traversal::request::IngestRequest;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

/// Parts of one recording follow each other at most so long after: 10 s.
const LONGEST_PAUSE_NS: i64 = 10_000_000_000;
/// A recorder may write the last messages of a part and the first of the next at once: 1 s.
const LONGEST_OVERLAP_NS: i64 = 1_000_000_000;

/// The files of a request, in order of time.
pub(crate) struct Parts(Vec<Part>);

/// One file.
struct Part {
    path: PathBuf,
    /// When its first and last message were received; `None` where it has none.
    span_ns: Option<(i64, i64)>,
    /// Topics of images.
    images: Vec<String>,
    /// Whether it has a stereo pair by itself.
    is_stereo: bool,
    /// The camera that the first message of each topic of CameraInfo describes.
    cameras: BTreeMap<String, Camera>,
}

/// What tells one camera from another: columns and rows, K and P.
#[derive(Debug, PartialEq)]
struct Camera([u32; 2], [f64; 9], [f64; 12]);

impl Parts {
    /// Opens the files of a request, or those in a folder that nothing but their names holds together. A single file
    /// and any other folder are in order as they are.
    pub(crate) fn open(request: &IngestRequest) -> Result<Self, IngestError> {
        let unlisted = match request.files.as_slice() {
            [folder] if holds_recording(folder) => unlisted_parts(folder)?,
            _ => None,
        };
        let files = unlisted.as_ref().unwrap_or(&request.files);
        if files.len() < 2 || files.iter().any(|file| file.is_dir()) {
            return Ok(Self(Vec::new()));
        }
        let mut parts = Vec::new();
        let mut known: Vec<(PathBuf, &PathBuf)> = Vec::new();
        for path in files {
            let real = fs::canonicalize(path).map_err(IngestError::file(path))?;
            if let Some((_, first)) = known.iter().find(|(other, _)| *other == real) {
                let twice = format!("{} and {} are one file: give it once", first.display(), path.display());
                return Err(IngestError::Request(twice));
            }
            known.push((real, path));
            parts.push(Part::open(path, request)?);
        }
        // Files of one start, as two recorders write them, are in the order of their names.
        parts.sort_by_cached_key(|part| {
            (part.span_ns.map_or(i64::MAX, |span| span.0), part.path.file_name().map(ToOwned::to_owned))
        });
        Ok(Self(parts))
    }

    /// The request with its files in order of time; a folder stays a folder.
    pub(crate) fn in_order(&self, request: &IngestRequest) -> IngestRequest {
        let mut request = request.clone();
        if request.files.len() > 1 && !self.0.is_empty() {
            request.files = self.0.iter().map(|part| part.path.clone()).collect();
        }
        request
    }

    /// Refuses files that are several recordings, with the files of each.
    pub(crate) fn check(&self) -> Result<(), IngestError> {
        let mut recordings: Vec<Vec<&Part>> = Vec::new();
        let mut why = None;
        for part in &self.0 {
            let faults: Vec<Option<String>> = recordings.iter().map(|recording| part.misfit(recording)).collect();
            match faults.iter().position(Option::is_none) {
                Some(place) => recordings[place].push(part),
                None => {
                    why = why.or(faults.into_iter().next_back().flatten());
                    recordings.push(vec![part]);
                }
            }
        }
        let Some(why) = why else { return Ok(()) };
        let command = |recording: &Vec<&Part>| {
            let files: Vec<String> = recording.iter().map(|part| part.path.display().to_string()).collect();
            // No path has the character that cannot be quoted.
            let files = shlex::try_join(files.iter().map(String::as_str)).unwrap_or_default();
            format!("`furrow ingest {files} …`")
        };
        let commands: Vec<String> = recordings.iter().map(command).collect();
        Err(IngestError::Request(format!(
            "{why}: the files are {} recordings; ingest each by itself: {}; or insist with --parts that they are one",
            recordings.len(),
            commands.join(", ")
        )))
    }
}

impl Part {
    fn open(path: &Path, request: &IngestRequest) -> Result<Self, IngestError> {
        let recording = open(path)?;
        let of_type = |types: &[&str]| {
            let topics = recording.topics().iter();
            let topics = topics.filter(|topic| topic.messages != Some(0) && types.contains(&topic.type_name.as_str()));
            topics.map(|topic| topic.name.clone()).collect::<Vec<_>>()
        };
        let cameras = if request.insist_on_parts {
            BTreeMap::new()
        } else {
            first_cameras(&recording, &of_type(&[CameraInfo::TYPE]))?
        };
        Ok(Self {
            path: path.to_owned(),
            span_ns: recording.first_ns().zip(recording.last_ns()),
            images: of_type(&[Image::TYPE, CompressedImage::TYPE]),
            is_stereo: find_stereo(recording.topics(), None, None).is_ok(),
            cameras,
        })
    }

    /// Why this part, which begins later, does not belong to these; `None` where it does.
    fn misfit(&self, others: &[&Part]) -> Option<String> {
        let name = self.path.display();
        let (first, _) = self.span_ns?;
        let end = others.iter().filter_map(|other| other.span_ns).map(|span| span.1).max()?;
        let pause_ns = first.saturating_sub(end);
        if pause_ns > LONGEST_PAUSE_NS {
            let seconds = pause_ns as f64 / 1e9;
            return Some(format!("{name} begins {seconds:.1} s after the files before it end"));
        }
        let shares = |other: &&&Part| self.images.iter().any(|topic| other.images.contains(topic));
        for other in others.iter().filter(shares) {
            let overlap_ns = other.span_ns.map_or(0, |span| span.1.saturating_sub(first));
            if overlap_ns > LONGEST_OVERLAP_NS {
                let seconds = overlap_ns as f64 / 1e9;
                return Some(format!(
                    "{name} and {} have images of the same topics at the same time, for {seconds:.1} s",
                    other.path.display()
                ));
            }
        }
        for other in others {
            let differs =
                |(topic, camera): &(&String, &Camera)| other.cameras.get(*topic).is_some_and(|other| other != *camera);
            if let Some((topic, _)) = self.cameras.iter().find(differs) {
                return Some(format!("the cameras of {name} and {} differ, by {topic}", other.path.display()));
            }
        }
        let is_other =
            self.is_stereo && others.iter().any(|other| other.is_stereo) && !others.iter().any(|other| shares(&other));
        is_other.then(|| format!("{name} has other image topics ({}) than the files before it", self.images.join(", ")))
    }
}

/// The cameras that the first messages of these topics describe. One that cannot be decoded is refused where it is
/// used; one that says nothing yet, all zeros, may be any camera's.
fn first_cameras(recording: &Recording, topics: &[String]) -> Result<BTreeMap<String, Camera>, IngestError> {
    let (mut found, mut seen) = (BTreeMap::new(), BTreeSet::new());
    let wanted: Vec<&str> = topics.iter().map(String::as_str).collect();
    if wanted.is_empty() {
        return Ok(found);
    }
    let _ = recording.read::<()>(&wanted, &mut |_| {}, &mut |message| {
        let topic = &message.topic.name;
        if seen.insert(topic.clone())
            && let Ok(info) = CameraInfo::decode(message.topic.encoding, message.bytes)
            && info.k.iter().any(|value| *value != 0.0)
        {
            found.insert(topic.clone(), Camera([info.width, info.height], info.k, info.p));
        }
        if seen.len() == wanted.len() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    })?;
    Ok(found)
}
