//! Reading a source to its end: images paired as they come, other sensors collected in tables.

use crate::pairing::{Frame, PairingReport, Side};
use crate::traversal::clock::{ClockOffset, ClockWatch};
use crate::traversal::error::IngestError;
use crate::traversal::lost::LostImage;
use crate::traversal::picture::Picture;
use crate::traversal::selection::FrameSelection;
use crate::traversal::sensors::Sensors;
use crate::traversal::source::{ImageSource, Item};
use crate::traversal::stretches::{Step, Stretches, Taken};
use furrow_catalog::Staging;
use furrow_catalog::records::SensorTable;
use std::ops::ControlFlow;
use std::sync::mpsc::SyncSender;

/// What the cameras took at one moment.
pub(crate) struct Moment {
    /// The left image, or the single camera's.
    pub(crate) left: Frame<Picture>,
    /// `None` where there is one camera.
    pub(crate) right: Option<Frame<Picture>>,
}

/// What reading found beside the moments that it handed over.
pub(crate) struct ReadReport {
    /// What became of the frames.
    pub(crate) pairing: PairingReport,
    /// Images read, left and right.
    pub(crate) images: [u64; 2],
    /// The stamp of each side's images where they have but one.
    pub(crate) only_stamp_ns: [Option<i64>; 2],
    /// Where a side's clock was set back.
    pub(crate) steps: Vec<Step>,
    /// Pairs before the first step, between two, and behind the last.
    pub(crate) stretches: Vec<u32>,
    /// Images whose stamp is far from those around it.
    pub(crate) strays: u64,
    /// Where pairs were received whole periods apart.
    pub(crate) offset: Option<ClockOffset>,
    /// Images without a stamp that can be read.
    pub(crate) lost: Vec<LostImage>,
    /// Other sensors' tables.
    pub(crate) sensors: Vec<SensorTable>,
}

/// Reads a recording and pairs its frames.
pub(crate) struct FrameReader {
    /// Whether there are right images to be paired with.
    has_pairs: bool,
    watch: ClockWatch<Taken>,
    stretches: Stretches,
    selection: FrameSelection,
    only_stamp_ns: [Option<Option<i64>>; 2],
    sensors: Sensors,
    images: [u64; 2],
    lost: Vec<LostImage>,
}

impl FrameReader {
    /// Before the first frame of `source`.
    pub(crate) fn new(source: &dyn ImageSource, selection: FrameSelection) -> Self {
        let has_pairs = source.right_name().is_some();
        Self {
            has_pairs,
            watch: ClockWatch::default(),
            stretches: Stretches::default(),
            selection,
            only_stamp_ns: [None; 2],
            sensors: Sensors::default(),
            images: [0; 2],
            lost: Vec::new(),
        }
    }

    /// Reads to the end and hands over pairs as they are settled. Stops when nobody takes them any more.
    pub(crate) fn run(
        &mut self,
        source: &dyn ImageSource,
        staging: &Staging,
        moments: &SyncSender<Moment>,
        progress: &mut dyn FnMut(u64, u64),
    ) -> Result<(), IngestError> {
        source.stream(progress, &mut |item| {
            match item {
                Item::Sensor { topic, row } => self.sensors.push(topic, row, staging)?,
                Item::Lost(image) => {
                    self.images[usize::from(image.side == Side::Right)] += 1;
                    self.lost.push(image);
                }
                Item::Image { stamp_ns, picture, .. } if !self.has_pairs => {
                    let moment = Moment { left: Frame { stamp_ns, image: picture }, right: None };
                    return Ok(send(moments, moment));
                }
                Item::Image { side, pair_ns, stamp_ns, receive_ns, picture } => {
                    self.images[usize::from(side == Side::Right)] += 1;
                    let only = self.only_stamp_ns[side as usize].get_or_insert(Some(stamp_ns));
                    *only = only.filter(|only| *only == stamp_ns);
                    let taken = Taken { pair_ns, receive_ns, frame: Frame { stamp_ns, image: picture } };
                    match receive_ns {
                        Some(receive_ns) => self.watch.push(side, stamp_ns, receive_ns, taken),
                        None => self.stretches.push(side, taken),
                    }
                }
            }
            Ok(self.send_pairs(moments, false))
        })?;
        // Where nobody takes the last pairs, the stages have failed and say why.
        let _ = self.send_pairs(moments, true);
        Ok(())
    }

    /// What was found on the way.
    pub(crate) fn finish(self, staging: &Staging) -> Result<ReadReport, IngestError> {
        let Stretches { report: pairing, steps, pairs: stretches, strays, offsets, .. } = self.stretches;
        Ok(ReadReport {
            offset: offsets.judge(pairing.period_ns),
            pairing,
            images: self.images,
            lost: self.lost,
            only_stamp_ns: self.only_stamp_ns.map(Option::flatten),
            steps,
            stretches,
            strays,
            sensors: self.sensors.finish(staging)?,
        })
    }

    fn send_pairs(&mut self, moments: &SyncSender<Moment>, is_end: bool) -> ControlFlow<()> {
        while let Some((side, verdict, taken)) = self.watch.pop(is_end) {
            self.stretches.push_judged(side, verdict, taken);
        }
        if is_end {
            self.stretches.finish();
        }
        while let Some((left, right)) = self.stretches.pop() {
            // Pairs of several stretches will be refused: to count them, no image has to be decoded.
            if self.stretches.may_enter(self.selection) {
                send(moments, Moment { left, right: Some(right) })?;
            }
        }
        ControlFlow::Continue(())
    }
}

/// Hands over a moment; breaks off where nobody takes it.
fn send(moments: &SyncSender<Moment>, moment: Moment) -> ControlFlow<()> {
    if moments.send(moment).is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}
