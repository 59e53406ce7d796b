//! A recording's frames from its source to the store: one thread reads and pairs, another runs the stages.

use crate::traversal::clock::ClockOffset;
use crate::traversal::error::IngestError;
use crate::traversal::motion::GivenMotion;
use crate::traversal::notes::Notes;
use crate::traversal::progress::{IngestProgress, IngestStage};
use crate::traversal::reader::FrameReader;
use crate::traversal::request::IngestRequest;
use crate::traversal::source::ImageSource;
use crate::traversal::stages::{BATCH, Stages};
use crate::traversal::stamp_checks::{check_rate, check_stamps, note_stamps};
use furrow_catalog::records::{SensorTable, Unpaired, UnreadableRecord};
use furrow_catalog::tables::Frame;
use furrow_catalog::{Staging, Views};
use furrow_model::Trajectory;
use furrow_odometry::{OdometryParams, SideVotes};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::sync_channel;
use std::time::Duration;

/// How often progress is reported while the last pairs are computed.
const POLL: Duration = Duration::from_millis(20);

/// What came out of a recording.
pub(crate) struct FrameStream {
    /// The stored frames, in order.
    pub(crate) frames: Vec<Frame>,
    /// The chain through them.
    pub(crate) chain: Trajectory,
    /// Pairs, or a single camera's images, in the recording, before the selection.
    pub(crate) pairs: u32,
    /// Frames without a partner.
    pub(crate) unpaired: Vec<Unpaired>,
    /// Frames that are missing by the gaps between stamps, both sides together.
    pub(crate) dropped: u32,
    /// Images whose stamp is not later than the one before.
    pub(crate) out_of_order: u32,
    /// Images whose stamp their side had already.
    pub(crate) duplicates: u64,
    /// Where the frames of pairs were received whole periods apart.
    pub(crate) offset: Option<ClockOffset>,
    /// Other sensors' tables.
    pub(crate) sensors: Vec<SensorTable>,
    /// On which side the points of some of the frames lie, with the frames' places.
    pub(crate) sides: Vec<(usize, SideVotes)>,
    /// Images that could not be read.
    pub(crate) unreadable: UnreadableRecord,
}

impl FrameStream {
    /// Runs the whole recording through the stages: reading and pairing on this thread, the rest beside it.
    pub(crate) fn run(
        source: &dyn ImageSource,
        request: &IngestRequest,
        given: Option<&GivenMotion>,
        views: &Views,
        staging: &Staging,
        notes: &Notes,
        progress: &mut dyn FnMut(IngestProgress),
    ) -> Result<Self, IngestError> {
        let stored = AtomicU64::new(0);
        let selection = request.selection;
        let mut reader = FrameReader::new(source, selection);
        let (read, stages) = std::thread::scope(|scope| {
            let (sender, moments) = sync_channel(BATCH);
            let odometry = given.is_none().then(OdometryParams::default);
            let stages = Stages::new(source, request, odometry, views, staging, &stored);
            let stages = scope.spawn(move || stages.run(moments));
            let mut position = (0, 1);
            let mut report_progress = |(bytes, bytes_total)| {
                let frames = stored.load(Ordering::Relaxed);
                progress(IngestProgress { stage: IngestStage::Frames, bytes, bytes_total, frames });
            };
            let read = reader.run(source, staging, &sender, &mut |bytes, bytes_total| {
                position = (bytes, bytes_total);
                report_progress(position);
            });
            // The stages end when no sender is left.
            drop(sender);
            // All is read, but not all is computed.
            while !stages.is_finished() {
                report_progress(position);
                std::thread::sleep(POLL);
            }
            report_progress(position);
            (read, stages.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
        });
        // A frame that failed was read before whatever stopped the reading: of two errors, the first in the recording
        // is reported.
        let mut stages = stages?;
        read?;
        let mut report = reader.finish(staging)?;
        check_stamps(source.path(), &report, selection)?;
        let pairs = stages.pairs - stages.losses.moments;
        stages.losses.extend(std::mem::take(&mut report.lost));
        stages.losses.check(source.path(), stages.frames.len() as u32)?;
        if stages.pairs == 0 {
            let [left, right] = report.images;
            return Err(IngestError::NoPairs { path: source.path().to_owned(), left, right });
        }
        if stages.frames.is_empty() {
            let (path, selection) = (source.path().to_owned(), request.selection.to_string());
            return Err(IngestError::NothingSelected { path, selection, pairs: stages.pairs });
        }
        let stamps_ns: Vec<i64> = stages.frames.iter().map(|frame| frame.stamp_ns).collect();
        check_rate(source.path(), &stamps_ns)?;
        let chain = match given {
            None => stages.chain.unwrap_or_default(),
            Some(given) => given.chain(&stamps_ns, &stages.numbers, stages.pairs)?,
        };
        note_stamps(notes, &report);
        let pairing = report.pairing;
        let mut unpaired = [&pairing.unpaired[..], &stages.losses.partners].concat();
        unpaired.sort_unstable();
        let unpaired =
            unpaired.into_iter().map(|(stamp_ns, side)| Unpaired { stamp_ns, side: side.to_string() }).collect();
        Ok(Self {
            frames: stages.frames,
            chain,
            pairs,
            unpaired,
            dropped: u32::try_from(pairing.dropped.iter().sum::<u64>()).unwrap_or(u32::MAX),
            out_of_order: u32::try_from(pairing.out_of_order + pairing.duplicates).unwrap_or(u32::MAX),
            duplicates: pairing.duplicates,
            offset: report.offset,
            sensors: report.sensors,
            sides: stages.sides,
            unreadable: stages.losses.note(source.path(), notes),
        })
    }
}
