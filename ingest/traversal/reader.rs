//! Reading a source to its end: images paired as they come, other sensors collected in tables.

use crate::pairing::{Frame, Pairer, PairingReport, Side};
use crate::traversal::error::IngestError;
use crate::traversal::picture::Picture;
use crate::traversal::sensors::Sensors;
use crate::traversal::source::{ImageSource, Item};
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
    /// Other sensors' tables.
    pub(crate) sensors: Vec<SensorTable>,
}

/// An image under its own stamp, which need not be the one that it is paired by.
type Taken = Frame<Picture>;

/// Reads a recording and pairs its frames.
pub(crate) struct FrameReader {
    /// Whether there are right images to be paired with.
    has_pairs: bool,
    pairer: Pairer<Taken>,
    sensors: Sensors,
    images: [u64; 2],
}

impl FrameReader {
    /// Before the first frame of `source`.
    pub(crate) fn new(source: &dyn ImageSource) -> Self {
        let has_pairs = source.right_name().is_some();
        Self { has_pairs, pairer: Pairer::new(), sensors: Sensors::default(), images: [0; 2] }
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
                Item::Image { stamp_ns, picture, .. } if !self.has_pairs => {
                    let moment = Moment { left: Frame { stamp_ns, image: picture }, right: None };
                    return Ok(send(moments, moment));
                }
                Item::Image { side, pair_ns, stamp_ns, picture, .. } => {
                    self.images[usize::from(side == Side::Right)] += 1;
                    self.pairer.push(side, pair_ns, Frame { stamp_ns, image: picture });
                }
            }
            Ok(self.send_pairs(moments))
        })?;
        self.pairer.finish();
        // Where nobody takes the last pairs, the stages have failed and say why.
        let _ = self.send_pairs(moments);
        Ok(())
    }

    /// What was found on the way.
    pub(crate) fn finish(mut self, staging: &Staging) -> Result<ReadReport, IngestError> {
        let pairing = self.pairer.finish().clone();
        Ok(ReadReport { pairing, images: self.images, sensors: self.sensors.finish(staging)? })
    }

    fn send_pairs(&mut self, moments: &SyncSender<Moment>) -> ControlFlow<()> {
        while let Some(pair) = self.pairer.pop() {
            send(moments, Moment { left: pair.left.image, right: Some(pair.right.image) })?;
        }
        ControlFlow::Continue(())
    }
}

/// Hands over a moment; breaks off where nobody takes it.
fn send(moments: &SyncSender<Moment>, moment: Moment) -> ControlFlow<()> {
    if moments.send(moment).is_ok() { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}
