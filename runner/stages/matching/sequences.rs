//! SeqSLAM: small images in a row, spaced by odometry.

use super::{Matches, kept, of_ranked, remembered};
use crate::RunError;
use crate::inputs::contender::Contender;
use crate::inputs::key::{SEQUENCES, key_of};
use crate::inputs::traversals::LiveTraversal;
use crate::progress::{Counter, Progress};
use crate::stages::codebook::left_view;
use furrow_catalog::{Objects, Views};
use furrow_localiser::seqslam::{Route, SeqSlamParams, Thumbnail, rank};
use furrow_model::ObjectId;
use rayon::prelude::*;

/// What a live pass looks like from far.
pub(crate) struct LiveThumbnails {
    images: Vec<Thumbnail>,
    travelled_m: Vec<f64>,
}

impl LiveThumbnails {
    /// Of all frames of a pass.
    pub fn of(objects: &Objects, pass: &LiveTraversal, progress: Progress<'_>) -> Result<Self, RunError> {
        let images: Vec<ObjectId> = pass.images().collect();
        let stage = format!("small images of the live pass at {}", pass.record.slot);
        let images = thumbnails(objects, pass.record.calibration, &images, (&stage, progress))?;
        Ok(Self { images, travelled_m: pass.chain.poses().iter().map(|pose| pose.travelled_m).collect() })
    }
}

/// Finds or computes an experience's answers to a live pass.
pub(crate) fn sequence_matches(
    objects: &Objects,
    (pass, live): (&LiveTraversal, &LiveThumbnails),
    contender: &Contender,
    params: &SeqSlamParams,
    verified: u32,
    progress: Progress<'_>,
) -> Result<Matches, RunError> {
    let kept = kept(verified);
    let record = &contender.record;
    let key = key_of(
        SEQUENCES,
        &(pass.record.frames, pass.record.calibration, pass.record.chain, contender.id, params, kept),
    );
    remembered(objects, key, || {
        let images: Vec<ObjectId> = contender.images().collect();
        let stage = format!("small images of the experience {}", contender.label);
        let images = thumbnails(objects, record.calibration, &images, (&stage, progress))?;
        let travelled_m = contender.travelled_m(objects)?;
        let (live, places) = (
            Route { images: &live.images, travelled_m: &live.travelled_m },
            Route { images: &images, travelled_m: &travelled_m },
        );
        rank(live, places, params, kept).map(of_ranked).map_err(|error| RunError::Plan(error.to_string()))
    })
}

fn thumbnails(
    objects: &Objects,
    calibration: ObjectId,
    images: &[ObjectId],
    (stage, progress): (&str, Progress<'_>),
) -> Result<Vec<Thumbnail>, RunError> {
    let views = Views::load(objects, calibration)?;
    let counter = Counter::new(progress, stage, images.len());
    let one = |image: &ObjectId| {
        let thumbnail = Thumbnail::of(&left_view(objects, &views, *image)?);
        counter.tick();
        Ok(thumbnail)
    };
    images.par_iter().map(one).collect()
}
