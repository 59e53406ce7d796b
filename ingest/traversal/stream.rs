//! Frames through the stages: pair, store, rectify, find features, estimate motion. Where the motion is given, the last two are left out. A batch at a time, so that memory does not grow with the
//! recording; inside a batch on every core, with results in order.

use crate::traversal::motion::GivenMotion;
use crate::traversal::sensors::Sensors;
use crate::traversal::source::{Item, Picture, Source};
use crate::traversal::{FrameSelection, IngestError, IngestProgress};
use crate::pairing::{self, Pairer};
use furrow_catalog::images::Side;
use furrow_catalog::records::{SensorTable, Unpaired};
use furrow_catalog::tables::{Frame, RightImage};
use furrow_catalog::{Staging, Views};
use furrow_model::{GreyImage, ObjectId, Trajectory};
use furrow_odometry::{ChainBuilder, Odometry, OdometryParams, StereoFrame};
use rayon::prelude::*;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::time::Duration;

/// Pairs in a batch, and pairs that may wait for it. Two cores stay busy, and a batch of 1280x720 pairs with its features is about 150 MB.
const BATCH: usize = 16;

/// How often progress is told while the last pairs are computed.
const POLL: Duration = Duration::from_millis(20);

/// What came out of a recording.
pub(crate) struct FrameStream {
    /// The stored frames, in order.
    pub frames: Vec<Frame>,
    /// The chain through them.
    pub chain: Trajectory,
    /// Pairs, or a single camera's images, in the recording, before the selection.
    pub pairs: u32,
    /// Frames without a partner.
    pub unpaired: Vec<Unpaired>,
    /// Frames that gaps in the stamps speak of, both sides together.
    pub dropped: u32,
    /// Images whose stamp does not come after the one before.
    pub out_of_order: u32,
    /// Other sensors' tables.
    pub sensors: Vec<SensorTable>,
}

impl FrameStream {
    /// Runs the whole recording through the stages: reading and pairing on this thread, the rest beside it.
    pub fn run(
        source: &Source,
        selection: FrameSelection,
        given: Option<&GivenMotion>,
        views: &Views,
        staging: &Staging,
        progress: &mut dyn FnMut(IngestProgress),
    ) -> Result<Self, IngestError> {
        let behind = AtomicU64::new(0);
        let pairs = source.right_name().is_some();
        let mut reading = Reading { pairs, pairer: Pairer::new(), sensors: Sensors::default(), images: [0; 2] };
        let (read, stages) = std::thread::scope(|scope| {
            let (hand_over, pairs) = sync_channel(BATCH);
            let odometry = given.is_none().then(OdometryParams::default);
            let stages = Stages::new(source, selection, odometry, views, staging, &behind);
            let stages = scope.spawn(move || stages.run(pairs));
            let mut position = (0, 1);
            let mut tell = |(bytes, bytes_total)| {
                let frames = behind.load(Ordering::Relaxed);
                progress(IngestProgress { stage: "odometry", bytes, bytes_total, frames });
            };
            let read = reading.run(source, staging, hand_over, &mut |bytes, bytes_total| {
                position = (bytes, bytes_total);
                tell(position);
            });
            // All is read, but not all is computed.
            while !stages.is_finished() {
                tell(position);
                std::thread::sleep(POLL);
            }
            tell(position);
            (read, stages.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
        });
        // A frame that failed was read before whatever stopped the reading: of two faults the first in the recording is told.
        let stages = stages?;
        read?;
        let Reading { mut pairer, sensors, images, .. } = reading;
        let report = pairer.finish().clone();
        let name = |side| if side == pairing::Side::Left { "left" } else { "right" };
        let unpaired =
            report.unpaired.iter().map(|&(stamp_ns, side)| Unpaired { stamp_ns, side: name(side).to_owned() });
        let path = || source.path.clone();
        if stages.pairs == 0 {
            return Err(IngestError::NoPairs { path: path(), left: images[0], right: images[1] });
        }
        if stages.frames.is_empty() {
            let selection = selection.to_string();
            return Err(IngestError::NothingSelected { path: path(), selection, pairs: stages.pairs });
        }
        let chain = match given {
            None => stages.chain.map(ChainBuilder::finish).unwrap_or_default(),
            Some(given) => {
                let stamps_ns: Vec<i64> = stages.frames.iter().map(|frame| frame.stamp_ns).collect();
                given.chain(&stamps_ns, selection, stages.pairs)?
            }
        };
        Ok(Self {
            unpaired: unpaired.collect(),
            dropped: report.dropped.iter().sum::<u64>() as u32,
            out_of_order: (report.out_of_order + report.duplicates) as u32,
            pairs: stages.pairs,
            frames: stages.frames,
            chain,
            sensors: sensors.finish(staging)?,
        })
    }
}

/// What the cameras took at one moment.
struct Moment {
    left: pairing::Frame<Picture>,
    /// `None` where there is one camera.
    right: Option<pairing::Frame<Picture>>,
}

/// Reads a recording and pairs its frames.
struct Reading {
    /// Whether there are right images to be paired with.
    pairs: bool,
    pairer: Pairer<Picture>,
    sensors: Sensors,
    /// Images read, left and right.
    images: [u64; 2],
}

impl Reading {
    /// Reads to the end, handing over pairs as they are settled; stops where nobody takes them any more.
    fn run(
        &mut self,
        source: &Source,
        staging: &Staging,
        hand_over: SyncSender<Moment>,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), IngestError> {
        source.stream(progress, &mut |item| {
            match item {
                Item::Sensor { topic, reading } => self.sensors.push(topic, reading, staging)?,
                Item::Image { stamp_ns, picture, .. } if !self.pairs => {
                    let moment = Moment { left: pairing::Frame { stamp_ns, image: picture }, right: None };
                    let taken = hand_over.send(moment).is_ok();
                    return Ok(if taken { ControlFlow::Continue(()) } else { ControlFlow::Break(()) });
                }
                Item::Image { side, stamp_ns, picture } => {
                    self.images[side as usize] += 1;
                    let side = if side == Side::Left { pairing::Side::Left } else { pairing::Side::Right };
                    self.pairer.push(side, stamp_ns, picture);
                }
            }
            Ok(self.hand_over(&hand_over))
        })?;
        self.pairer.finish();
        // Where nobody takes the last pairs, the stages have failed and say why.
        let _ = self.hand_over(&hand_over);
        Ok(())
    }

    fn hand_over(&mut self, to: &SyncSender<Moment>) -> ControlFlow<()> {
        while let Some(pair) = self.pairer.pop() {
            if to.send(Moment { left: pair.left, right: Some(pair.right) }).is_err() {
                return ControlFlow::Break(());
            }
        }
        ControlFlow::Continue(())
    }
}

/// The stages after pairing, with the state that passes from batch to batch.
struct Stages<'a> {
    source: &'a Source,
    selection: FrameSelection,
    views: &'a Views,
    staging: &'a Staging,
    batch: Vec<Moment>,
    /// `None` where the motion is given.
    odometry: Option<Odometry>,
    chain: Option<ChainBuilder>,
    /// Frames that the chain does not have yet.
    ahead: Vec<(i64, StereoFrame)>,
    pairs: u32,
    frames: Vec<Frame>,
    /// Frames that are through, told to whoever reports progress.
    behind: &'a AtomicU64,
}

impl<'a> Stages<'a> {
    fn new(
        source: &'a Source,
        selection: FrameSelection,
        odometry: Option<OdometryParams>,
        views: &'a Views,
        staging: &'a Staging,
        behind: &'a AtomicU64,
    ) -> Self {
        let rig = views.rig();
        let chain = odometry.clone().map(|params| ChainBuilder::new(rig, params));
        let odometry = odometry.map(|params| Odometry::new(rig, params));
        Self {
            behind,
            source,
            selection,
            views,
            staging,
            batch: Vec::with_capacity(BATCH),
            odometry,
            chain,
            ahead: Vec::new(),
            pairs: 0,
            frames: Vec::new(),
        }
    }

    /// Takes pairs until no more come.
    fn run(mut self, moments: Receiver<Moment>) -> Result<Self, IngestError> {
        for moment in moments {
            self.pairs += 1;
            if self.selection.contains(self.pairs - 1) {
                self.batch.push(moment);
            }
            if self.batch.len() == BATCH {
                self.finish_batch()?;
            }
        }
        self.finish_batch()?;
        if let Some(chain) = &mut self.chain {
            chain.extend(std::mem::take(&mut self.ahead));
        }
        Ok(self)
    }

    /// Prepares a batch while the chain takes the one before: some of the chain's steps wait for each other and leave a core idle.
    fn finish_batch(&mut self) -> Result<(), IngestError> {
        let (batch, ahead) = (std::mem::take(&mut self.batch), std::mem::take(&mut self.ahead));
        let mut chain = self.chain.take();
        let (stored, ()) = rayon::join(
            || batch.into_par_iter().map(|moment| self.prepare(moment)).collect::<Result<Vec<_>, _>>(),
            || {
                if let Some(chain) = &mut chain {
                    chain.extend(ahead);
                }
            },
        );
        self.chain = chain;
        let (frames, views): (Vec<Frame>, Vec<Option<StereoFrame>>) = stored?.into_iter().unzip();
        let stamps_ns = frames.iter().map(|frame| frame.stamp_ns);
        self.ahead = stamps_ns.zip(views).filter_map(|(stamp_ns, view)| Some((stamp_ns, view?))).collect();
        self.frames.extend(frames);
        self.behind.store(self.frames.len() as u64, Ordering::Relaxed);
        Ok(())
    }

    /// Stores the images and, for odometry, finds their features.
    fn prepare(&self, moment: Moment) -> Result<(Frame, Option<StereoFrame>), IngestError> {
        let stamp_ns = moment.left.stamp_ns;
        let (left, left_view) = self.store(moment.left, Side::Left)?;
        let Some(right) = moment.right else { return Ok((Frame { stamp_ns, left, right: None }, None)) };
        let right_stamp_ns = right.stamp_ns;
        let (right, right_view) = self.store(right, Side::Right)?;
        let frame = Frame { stamp_ns, left, right: Some(RightImage { stamp_ns: right_stamp_ns, image: right }) };
        Ok((frame, self.odometry.as_ref().map(|odometry| odometry.prepare(&left_view, &right_view))))
    }

    /// Stores an image, which must decode and be of its camera's size; gives its rectified view.
    fn store(&self, taken: pairing::Frame<Picture>, side: Side) -> Result<(ObjectId, GreyImage), IngestError> {
        let (bytes, view) = taken.image.store_and_view(side, self.views).map_err(|source| IngestError::Image {
            path: self.source.file_of(side, taken.stamp_ns),
            side,
            stamp_ns: taken.stamp_ns,
            source: Box::new(source),
        })?;
        Ok((self.staging.write(&bytes)?, view))
    }
}
