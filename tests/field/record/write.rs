//! A traversal from its first frame to the files on disk.

use super::bag::BagFile;
use super::beside::Beside;
use super::container::Container;
use super::error::RecordError;
use super::mcap::McapFile;
use super::sensors::Sensors;
use crate::simulation::Simulation;
use crate::traversal::Traversal;
use std::io;
use std::path::{Path, PathBuf};

/// What was recorded.
#[derive(Debug, Clone, PartialEq)]
pub struct Summary {
    /// Frames taken.
    pub frames: u64,
    /// Those of which both images were recorded.
    pub pairs: u64,
    /// Length of the left camera's path in metres.
    pub length_m: f64,
    /// Stamps of the first and last frame by the camera's clock.
    pub stamps_ns: (i64, i64),
    /// Bytes of the recording.
    pub bytes: u64,
    /// The files, the recording first.
    pub files: Vec<PathBuf>,
}

/// Simulates `traversal` and writes it to `output`; the container follows from the extension. `progress` hears (frames
/// done, frames in all).
pub fn record(
    traversal: &Traversal,
    output: &Path,
    progress: &mut dyn FnMut(u64, u64),
) -> Result<Summary, RecordError> {
    let mut container = container(output, traversal.camera.distorted)?;
    let simulation = Simulation::prepare(traversal)?;
    let mut sensors = Sensors::of(&simulation);
    let mut beside = Beside::of(&simulation);
    let total = simulation.frames();
    progress(0, total);
    simulation.take_all(|frame| {
        beside.note(&frame);
        sensors.messages(&simulation, frame, &mut |received_ns, message| container.put(received_ns, message))?;
        progress(beside.frames(), total);
        Ok::<(), RecordError>(())
    })?;
    let recording = container.finish()?;
    // An older recording goes first and the new one comes last: where one is, its own ground truth is.
    if let Err(source) = std::fs::remove_file(output)
        && source.kind() != io::ErrorKind::NotFound
    {
        return Err(RecordError::Write { path: output.to_owned(), source });
    }
    let mut files = beside.write(&simulation, output)?;
    let bytes = recording.publish()?;
    files.insert(0, output.to_owned());
    Ok(Summary {
        frames: beside.frames(),
        pairs: beside.pairs(),
        length_m: beside.length_m(),
        stamps_ns: beside.stamps_ns(),
        bytes,
        files,
    })
}

fn container(output: &Path, distorted: bool) -> Result<Box<dyn Container>, RecordError> {
    match output.extension().and_then(|extension| extension.to_str()) {
        Some("mcap") => Ok(Box::new(McapFile::create(output, distorted)?)),
        Some("bag") => Ok(Box::new(BagFile::create(output, distorted)?)),
        _ => Err(RecordError::Extension(output.to_owned())),
    }
}
