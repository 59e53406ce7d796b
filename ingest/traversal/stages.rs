//! The stages after pairing: store, rectify, find features, estimate motion. A batch at a time, so that memory does not
//! grow with the recording; inside a batch on every core, with results in order.

use crate::pairing;
use crate::traversal::error::IngestError;
use crate::traversal::lost::{Losses, LostImage, LostMoment};
use crate::traversal::picture::Picture;
use crate::traversal::reader::Moment;
use crate::traversal::request::IngestRequest;
use crate::traversal::source::ImageSource;
use furrow_catalog::images::{ImageError, Side};
use furrow_catalog::tables::{Frame, RightImage};
use furrow_catalog::{Staging, Views};
use furrow_model::{GreyImage, Trajectory};
use furrow_odometry::{ChainBuilder, Odometry, OdometryParams, SideVotes, StereoFrame};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::Receiver;

/// Pairs in a batch, and pairs that may wait for it. Two cores stay busy, and a batch of 1280x720 pairs with its
/// features is about 150 MB.
pub(crate) const BATCH: usize = 16;

/// Of so many first frames, and of every so manieth one after them, it is counted on which side their points lie.
const SIDES_FIRST: usize = 8;
pub(crate) const SIDES_EVERY: usize = 32;

/// What came out of the stages.
pub(crate) struct StagesReport {
    /// Pairs, or a single camera's images, before the selection.
    pub(crate) pairs: u32,
    /// The stored frames, in order.
    pub(crate) frames: Vec<Frame>,
    /// Their numbers among the pairs.
    pub(crate) numbers: Vec<u32>,
    /// What was selected and could not be read.
    pub(crate) losses: Losses,
    /// The odometry's chain through them; `None` where the motion is given.
    pub(crate) chain: Option<Trajectory>,
    /// On which side the points of some of its frames lie, with the frames' places.
    pub(crate) sides: Vec<(usize, SideVotes)>,
}

/// The stages, with the state that passes from batch to batch.
pub(crate) struct Stages<'a> {
    source: &'a dyn ImageSource,
    request: &'a IngestRequest,
    views: &'a Views,
    staging: &'a Staging,
    batch: Vec<(u32, Moment)>,
    /// `None` where the motion is given.
    odometry: Option<Odometry>,
    chain: Option<ChainBuilder>,
    /// Frames that the chain does not have yet.
    waiting: Vec<(i64, StereoFrame)>,
    pairs: u32,
    frames: Vec<Frame>,
    numbers: Vec<u32>,
    losses: Losses,
    sides: Vec<(usize, SideVotes)>,
    /// How many frames are stored, for whoever reports progress.
    stored: &'a AtomicU64,
}

impl<'a> Stages<'a> {
    /// Before the first frame. Without `odometry` no features are found and no motion is estimated.
    pub(crate) fn new(
        source: &'a dyn ImageSource,
        request: &'a IngestRequest,
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
            request,
            views,
            staging,
            batch: Vec::with_capacity(BATCH),
            odometry,
            chain,
            waiting: Vec::new(),
            pairs: 0,
            frames: Vec::new(),
            numbers: Vec::new(),
            losses: Losses::default(),
            sides: Vec::new(),
            stored,
        }
    }

    /// Takes moments until no more come.
    pub(crate) fn run(mut self, moments: Receiver<Moment>) -> Result<StagesReport, IngestError> {
        for moment in moments {
            self.pairs += 1;
            if self.request.selection.contains(self.pairs - 1) {
                self.batch.push((self.pairs - 1, moment));
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
        let Self { pairs, frames, numbers, losses, sides, .. } = self;
        Ok(StagesReport { pairs, frames, numbers, losses, chain, sides })
    }

    /// Prepares a batch while the chain takes the one before: some of the chain's steps wait for each other and leave a
    /// core idle.
    fn finish_batch(&mut self) -> Result<(), IngestError> {
        let (batch, waiting) = (std::mem::take(&mut self.batch), std::mem::take(&mut self.waiting));
        let mut chain = self.chain.take();
        let (prepared, ()) = rayon::join(
            || batch.into_par_iter().map(|(number, moment)| (number, self.prepare(moment))).collect::<Vec<_>>(),
            || {
                if let Some(chain) = &mut chain {
                    chain.extend(waiting);
                }
            },
        );
        self.chain = chain;
        // In the recording's order: of several frames that fail, the first is named, whichever thread came first.
        let (mut frames, mut views) = (Vec::new(), Vec::new());
        for (number, prepared) in prepared {
            match prepared? {
                Prepared::Frame(frame, view) => {
                    self.numbers.push(number);
                    frames.push(frame);
                    views.push(view.map(|view| *view));
                }
                Prepared::Lost(lost) => self.losses.add(lost),
            }
        }
        self.count_sides(&views);
        let stamps_ns = frames.iter().map(|frame| frame.stamp_ns);
        self.waiting = stamps_ns.zip(views).filter_map(|(stamp_ns, view)| Some((stamp_ns, view?))).collect();
        self.frames.extend(frames);
        self.stored.store(self.frames.len() as u64, Ordering::Relaxed);
        self.losses.check_begin(self.source.path(), self.frames.len() as u32)
    }

    /// Counts on which side the points of the batch's frames lie, where it is their turn.
    fn count_sides(&mut self, views: &[Option<StereoFrame>]) {
        let first = self.frames.len();
        let due: Vec<(usize, &StereoFrame)> = (first..)
            .zip(views)
            .filter(|(i, _)| *i < SIDES_FIRST || i.is_multiple_of(SIDES_EVERY))
            .filter_map(|(i, view)| Some((i, view.as_ref()?)))
            .collect();
        let params = OdometryParams::default().stereo;
        let rig = self.views.rig();
        self.sides.par_extend(due.into_par_iter().map(|(i, frame)| (i, SideVotes::of(frame, &rig, &params))));
    }

    /// Stores the images and, for odometry, finds their features. Where one cannot be read, nothing of the moment is
    /// stored.
    fn prepare(&self, moment: Moment) -> Result<Prepared, IngestError> {
        let stamp_ns = moment.left.stamp_ns;
        let left = self.develop(moment.left, Side::Left);
        let right = moment.right.map(|right| (right.stamp_ns, self.develop(right, Side::Right)));
        let ((left, left_view), right) = match (left, right) {
            (Ok(left), None) => (left, None),
            (Ok(left), Some((right_stamp_ns, Ok(right)))) => (left, Some((right_stamp_ns, right))),
            (left, right) => {
                let left = (stamp_ns, Side::Left, left.err());
                let right = right.map(|(stamp_ns, right)| (stamp_ns, Side::Right, right.err()));
                return self.lose([Some(left), right].into_iter().flatten().collect());
            }
        };
        let left = self.staging.write(&left)?;
        let Some((right_stamp_ns, (right, right_view))) = right else {
            return Ok(Prepared::Frame(Frame { stamp_ns, left, right: None }, None));
        };
        let right = RightImage { stamp_ns: right_stamp_ns, image: self.staging.write(&right)? };
        let view = self.odometry.as_ref().map(|odometry| Box::new(odometry.prepare(&left_view, &right_view)));
        Ok(Prepared::Frame(Frame { stamp_ns, left, right: Some(right) }, view))
    }

    /// The bytes that are stored of an image, which must decode and be of its camera's size, and its rectified view.
    fn develop(&self, taken: pairing::Frame<Picture>, side: Side) -> Result<(Vec<u8>, GreyImage), ImageError> {
        taken.image.encode_and_rectify(side, self.views, self.source.depth())
    }

    /// A moment that has images which cannot be read: refused where the user wants no such recording.
    fn lose(&self, images: Vec<(i64, Side, Option<ImageError>)>) -> Result<Prepared, IngestError> {
        let mut lost = LostMoment { images: Vec::new(), partner: None, is_of_another_size: false };
        for (stamp_ns, side, error) in images {
            let Some(error) = error else {
                lost.partner = Some((stamp_ns, side));
                continue;
            };
            let file = self.source.file_of(side, stamp_ns);
            if self.request.strict {
                return Err(IngestError::Image { path: file, side, stamp_ns, source: Box::new(error) });
            }
            lost.is_of_another_size |= matches!(error, ImageError::NotOfTheCalibration { .. });
            lost.images.push(LostImage { stamp_ns, side, file, fault: error.to_string() });
        }
        Ok(Prepared::Lost(lost))
    }
}

/// What became of a moment.
enum Prepared {
    /// It is stored; with its features, where there is odometry.
    Frame(Frame, Option<Box<StereoFrame>>),
    /// It has an image that cannot be read.
    Lost(LostMoment),
}
