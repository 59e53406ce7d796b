//! The stages after pairing: store, rectify, find features, estimate motion. A batch at a time, so that memory does not
//! grow with the recording; inside a batch on every core, with results in order.

use crate::pairing;
use crate::traversal::error::IngestError;
use crate::traversal::picture::Picture;
use crate::traversal::reader::Moment;
use crate::traversal::selection::FrameSelection;
use crate::traversal::source::ImageSource;
use furrow_catalog::images::Side;
use furrow_catalog::tables::{Frame, RightImage};
use furrow_catalog::{Staging, Views};
use furrow_model::{GreyImage, ObjectId, Trajectory};
use furrow_odometry::{ChainBuilder, Odometry, OdometryParams, SideVotes, StereoFrame};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::Receiver;

/// Pairs in a batch, and pairs that may wait for it. Two cores stay busy, and a batch of 1280x720 pairs with its
/// features is about 150 MB.
pub(crate) const BATCH: usize = 16;

/// Of so many first frames, and of every so manieth one after them, it is counted on which side their points lie.
const SIDES_FIRST: usize = 8;
const SIDES_EVERY: usize = 32;

/// What came out of the stages.
pub(crate) struct StagesReport {
    /// Pairs, or a single camera's images, before the selection.
    pub(crate) pairs: u32,
    /// The stored frames, in order.
    pub(crate) frames: Vec<Frame>,
    /// The odometry's chain through them; `None` where the motion is given.
    pub(crate) chain: Option<Trajectory>,
    /// On which side the points of some of its frames lie, and of how many frames that is.
    pub(crate) sides: (SideVotes, u32),
}

/// The stages, with the state that passes from batch to batch.
pub(crate) struct Stages<'a> {
    source: &'a dyn ImageSource,
    selection: FrameSelection,
    views: &'a Views,
    staging: &'a Staging,
    batch: Vec<Moment>,
    /// `None` where the motion is given.
    odometry: Option<Odometry>,
    chain: Option<ChainBuilder>,
    /// Frames that the chain does not have yet.
    waiting: Vec<(i64, StereoFrame)>,
    pairs: u32,
    frames: Vec<Frame>,
    sides: (SideVotes, u32),
    /// How many frames are stored, for whoever reports progress.
    stored: &'a AtomicU64,
}

impl<'a> Stages<'a> {
    /// Before the first frame. Without `odometry` no features are found and no motion is estimated.
    pub(crate) fn new(
        source: &'a dyn ImageSource,
        selection: FrameSelection,
        odometry: Option<OdometryParams>,
        views: &'a Views,
        staging: &'a Staging,
        stored: &'a AtomicU64,
    ) -> Self {
        let rig = views.rig();
        let chain = odometry.clone().map(|params| ChainBuilder::new(rig, params));
        let odometry = odometry.map(|params| Odometry::new(rig, params));
        Self {
            source,
            selection,
            views,
            staging,
            batch: Vec::with_capacity(BATCH),
            odometry,
            chain,
            waiting: Vec::new(),
            pairs: 0,
            frames: Vec::new(),
            sides: (SideVotes::default(), 0),
            stored,
        }
    }

    /// Takes moments until no more come.
    pub(crate) fn run(mut self, moments: Receiver<Moment>) -> Result<StagesReport, IngestError> {
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
            chain.extend(std::mem::take(&mut self.waiting));
        }
        let chain = self.chain.map(ChainBuilder::finish);
        Ok(StagesReport { pairs: self.pairs, frames: self.frames, chain, sides: self.sides })
    }

    /// Prepares a batch while the chain takes the one before: some of the chain's steps wait for each other and leave a
    /// core idle.
    fn finish_batch(&mut self) -> Result<(), IngestError> {
        let (batch, waiting) = (std::mem::take(&mut self.batch), std::mem::take(&mut self.waiting));
        let mut chain = self.chain.take();
        let (prepared, ()) = rayon::join(
            || batch.into_par_iter().map(|moment| self.prepare(moment)).collect::<Vec<_>>(),
            || {
                if let Some(chain) = &mut chain {
                    chain.extend(waiting);
                }
            },
        );
        self.chain = chain;
        // In the recording's order: of several frames that fail, the first is named, whichever thread came first.
        let prepared = prepared.into_iter().collect::<Result<Vec<_>, _>>()?;
        let (frames, views): (Vec<Frame>, Vec<Option<StereoFrame>>) = prepared.into_iter().unzip();
        self.count_sides(&views);
        let stamps_ns = frames.iter().map(|frame| frame.stamp_ns);
        self.waiting = stamps_ns.zip(views).filter_map(|(stamp_ns, view)| Some((stamp_ns, view?))).collect();
        self.frames.extend(frames);
        self.stored.store(self.frames.len() as u64, Ordering::Relaxed);
        Ok(())
    }

    /// Counts on which side the points of the batch's frames lie, where it is their turn.
    fn count_sides(&mut self, views: &[Option<StereoFrame>]) {
        let first = self.frames.len();
        let due: Vec<&StereoFrame> = (views.iter().enumerate())
            .filter(|(i, _)| first + i < SIDES_FIRST || (first + i).is_multiple_of(SIDES_EVERY))
            .filter_map(|(_, view)| view.as_ref())
            .collect();
        let params = OdometryParams::default().stereo;
        let votes: Vec<SideVotes> =
            due.par_iter().map(|frame| SideVotes::of(frame, &self.views.rig(), &params)).collect();
        self.sides.1 += votes.len() as u32;
        self.sides.0 = votes.into_iter().fold(self.sides.0, |sum, votes| sum + votes);
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
        let encoded = taken.image.encode_and_rectify(side, self.views);
        let (bytes, view) = encoded.map_err(|source| IngestError::Image {
            path: self.source.file_of(side, taken.stamp_ns),
            side,
            stamp_ns: taken.stamp_ns,
            source: Box::new(source),
        })?;
        Ok((self.staging.write(&bytes)?, view))
    }
}
