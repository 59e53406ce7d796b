//! Recording a pass as a robot would: a real MCAP file (ROS 2, zstd) or ROS 1 bag (lz4), and what no robot knows beside it.
//!
//! Beside `outing.mcap` lie `outing.groundtruth.tum` (stamp, position, quaternion of the rectified left camera: world from camera; world
//! x east, y north, z up; camera x right, y down, z forward), `outing.frames.csv` (sun, exposure, times and losses per frame) and
//! `outing.pass.json` (what was driven). Files appear complete or not at all.
//!
//! A frame is named by the stamp of its left image, by the camera's own clock; its pose is the true one in the middle of its exposure.
//! Where that clock runs fast, stamps and true times (`true_ns` in `frames.csv`) part; IMU and GPS keep the true time.

pub mod bag;
pub mod beside;
pub mod definitions;
pub mod fresh;
pub mod mcap;
pub mod messages;
pub mod sensors;
pub mod wire;

use crate::pass::Pass;
use crate::pass::check::BadPass;
use crate::simulate::Outing;
use beside::Beside;
use fresh::FreshFile;
use messages::Message;
use sensors::Sensors;
use std::io;
use std::path::{Path, PathBuf};

/// Why a recording could not be made.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The pass itself.
    #[error(transparent)]
    Pass(#[from] BadPass),
    /// The output's name.
    #[error("cannot record to {0}: expected a file name that ends in .mcap (ROS 2) or .bag (ROS 1)")]
    Extension(PathBuf),
    /// A file.
    #[error("cannot write {path}: {source}")]
    Write {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A container.
    #[error("cannot write {path} as MCAP: {source}")]
    Mcap {
        /// Which file.
        path: PathBuf,
        /// What the writer said.
        source: ::mcap::McapError,
    },
}

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

/// A container that takes messages in the order of their receive times.
trait Container {
    /// Writes one message, received at `received_ns`.
    fn put(&mut self, received_ns: i64, message: &Message) -> Result<(), RecordError>;
    /// Writes the index and gives the file back, ready to be named.
    fn finish(self: Box<Self>) -> Result<FreshFile, RecordError>;
}

/// Drives `pass` and writes it to `output`; the container follows from the extension. `progress` hears (frames done, frames in all).
pub fn record(pass: &Pass, output: &Path, progress: &mut dyn FnMut(u64, u64)) -> Result<Summary, RecordError> {
    let mut container = container(output, pass.camera.distorted)?;
    let outing = Outing::prepare(pass)?;
    let mut sensors = Sensors::of(&outing);
    let mut beside = Beside::of(&outing);
    let total = outing.frames();
    progress(0, total);
    outing.take_all(|frame| {
        beside.note(&frame);
        sensors.messages(&outing, frame, &mut |received_ns, message| container.put(received_ns, message))?;
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
    let mut files = beside.write(&outing, output)?;
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
        Some("mcap") => Ok(Box::new(mcap::McapFile::create(output, distorted)?)),
        Some("bag") => Ok(Box::new(bag::BagFile::create(output, distorted)?)),
        _ => Err(RecordError::Extension(output.to_owned())),
    }
}
