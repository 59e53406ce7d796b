//! SeqSLAM: small images in a row, spaced by odometry (Milford and Wyeth 2012).

use super::table::{kept, of_ranked, remembered};
use crate::RunError;
use crate::inputs::key::{SEQUENCES, key_of};
use crate::inputs::recogniser::{Answering, Context, Recogniser, RecogniserEntry};
use crate::inputs::traversals::LiveTraversal;
use crate::matrix::{Fault, LocaliserSpec, Method, OwnKey};
use crate::progress::{Counter, Stage, Subject};
use crate::stages::codebook::left_view;
use furrow_catalog::Views;
use furrow_localiser::seqslam::{Route, SeqSlamParams, Thumbnail, rank};
use furrow_model::ObjectId;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::sync::Arc;

const NAME: &str = "seqslam";

pub(super) static SEQSLAM: RecogniserEntry = RecogniserEntry {
    method: Method {
        name: NAME,
        keys: &[OwnKey { name: "sequence", exclusive: false }, OwnKey { name: "shift", exclusive: false }],
        check: |spec| settings(spec).map(drop),
    },
    open: |matrix| {
        let (images, shift) = settings(&matrix.localiser)?;
        let params = SeqSlamParams { images, shift, ..SeqSlamParams::at_spacing(matrix.keyframes.distance_m) };
        Ok(Arc::new(SeqSlam { params, verified: matrix.localiser.candidates }))
    },
};

/// Images in a sequence, as far apart as keyframes; and the farthest that images are shifted sideways to find their
/// least difference, as a share of their width.
fn settings(spec: &LocaliserSpec) -> Result<(usize, f64), Fault> {
    let (images, shift) = (spec.get("sequence")?.unwrap_or(10), spec.get("shift")?.unwrap_or(0.0));
    if images == 0 {
        return Err(spec.fault("sequence", "a sequence must have at least 1 image"));
    }
    if !(0.0..=0.5).contains(&shift) {
        return Err(spec.fault("shift", format!("a shift of {shift} of the width: expected 0 to 0.5")));
    }
    Ok((images, shift))
}

/// SeqSLAM with its parameters.
struct SeqSlam {
    params: SeqSlamParams,
    /// Of each answer so many can be verified.
    verified: u32,
}

impl Recogniser for SeqSlam {
    fn cell_key_part(&self) -> Value {
        json!([NAME, SEQUENCES, self.params])
    }

    fn look_at<'a>(&'a self, context: &'a dyn Context, live: &'a LiveTraversal) -> Result<Answering<'a>, RunError> {
        let record = &live.record;
        let images: Vec<ObjectId> = live.images().collect();
        let seen = thumbnails(context, record.calibration, &images, Subject::Live(record.slot))?;
        let (live_m, kept) = (live.travelled_m(), kept(self.verified));
        Ok(Box::new(move |contender| {
            let inputs = (record.frames, record.calibration, record.chain, contender.id, &self.params, kept);
            remembered(context.objects(), key_of(SEQUENCES, &inputs)?, || {
                let images: Vec<ObjectId> = contender.images().collect();
                let of = Subject::experience(&contender.label);
                let places = thumbnails(context, contender.record.calibration, &images, of)?;
                let places_m = contender.travelled_m(context.objects())?;
                let live = Route { images: &seen, travelled_m: &live_m };
                let places = Route { images: &places, travelled_m: &places_m };
                rank(live, places, &self.params, kept)
                    .map(of_ranked)
                    .map_err(|error| RunError::Recogniser(error.to_string()))
            })
        }))
    }
}

fn thumbnails(
    context: &dyn Context,
    calibration: ObjectId,
    images: &[ObjectId],
    of: Subject<'_>,
) -> Result<Vec<Thumbnail>, RunError> {
    let objects = context.objects();
    let views = Views::load(objects, calibration)?;
    let counter = Counter::new(context.progress(), (Stage::SmallImages, of), images.len());
    let one = |image: &ObjectId| {
        let thumbnail = Thumbnail::of(&left_view(objects, &views, *image)?);
        counter.tick();
        Ok(thumbnail)
    };
    images.par_iter().map(one).collect()
}
