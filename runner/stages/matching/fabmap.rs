//! FAB-MAP 2.0 on the words of live frames and nodes.

use super::{Candidate, FrameMatches, Matches, kept, remembered};
use crate::Matrix;
use crate::RunError;
use crate::inputs::key::{MATCHES, key_of};
use crate::stages::codebook::ReadyCodebook;
use crate::stages::words::Words;
use furrow_catalog::Objects;
use furrow_localiser::fabmap::{Answer, Best, FabMapError, FabMapParams, MotionModel, Track};
use furrow_localiser::{FabMap, Presence};
use furrow_model::{CodebookId, ObjectId};
use rayon::prelude::*;

/// How FAB-MAP answers a pass.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FabMapRules<'a> {
    /// Of each answer so many can be verified.
    pub verified: u32,
    /// The motion model and the distance between places in metres, with the distance travelled at every live frame.
    pub motion: Option<(MotionModel, f64, &'a [f64])>,
}

impl<'a> FabMapRules<'a> {
    /// As a matrix asks for them, for a live traversal that had travelled so far at each frame.
    pub fn of(matrix: &Matrix, travelled_m: &'a [f64]) -> Self {
        let motion = matrix.localiser.motion.map(|motion| (motion, matrix.keyframes.distance_m, travelled_m));
        Self { verified: matrix.localiser.candidates, motion }
    }
}

const PARAMS: FabMapParams = FabMapParams::OPENFABMAP;
/// Frames whose answers wait in memory for those before them.
const BATCH: usize = 64;

/// Finds or computes an experience's answers to a live pass.
pub(crate) fn fabmap_matches(
    objects: &Objects,
    live: &Words,
    map: &Words,
    codebook: &ReadyCodebook,
    rules: FabMapRules<'_>,
) -> Result<Matches, RunError> {
    let (kept, params) = (kept(rules.verified), PARAMS);
    let (live_images, map_images) = (live.presences.len(), map.presences.len());
    let key = fabmap_key((live.table, live_images), (map.table, map_images), codebook.id, rules);
    remembered(objects, key, || {
        let places = indexed(map, codebook)?;
        match rules.motion {
            None => each_alone(&places, &live.presences, kept),
            Some(motion) => one_after_another(&places, &live.presences, kept, motion, params.smoothing),
        }
    })
}

/// The key of an experience's answers to a live pass: each by its table of words and its number of images.
pub(crate) fn fabmap_key(
    (live, live_images): (ObjectId, usize),
    (map, map_images): (ObjectId, usize),
    codebook: CodebookId,
    rules: FabMapRules<'_>,
) -> ObjectId {
    let (kept, params) = (kept(rules.verified), PARAMS);
    match rules.motion {
        None => key_of(MATCHES, &(live, map, live_images, map_images, codebook, params, kept)),
        Some(motion) => key_of(MATCHES, &(live, map, (live_images, map_images), codebook, params, kept, motion)),
    }
}

/// The index of a map's places.
pub(crate) fn indexed(map: &Words, codebook: &ReadyCodebook) -> Result<FabMap, RunError> {
    let mut places = FabMap::new(&codebook.codebook.tree, PARAMS, &codebook.codebook.samples).map_err(wrong)?;
    for place in &map.presences {
        places.add_place(place).map_err(wrong)?;
    }
    Ok(places)
}

pub(crate) fn wrong(error: FabMapError) -> RunError {
    RunError::Codebook(error.to_string())
}

fn each_alone(places: &FabMap, live: &[Presence], kept: usize) -> Result<Vec<FrameMatches>, RunError> {
    let frames = live.par_iter().map_init(Answer::default, |answer, presence| {
        places.query_into(presence, answer).map_err(wrong)?;
        Ok(frame_matches(answer, answer.best() == Best::NewPlace, &answer.ranked(kept)))
    });
    frames.collect()
}

/// Behind a motion model each answer leans on those before it; likelihoods are computed side by side all the same.
fn one_after_another(
    places: &FabMap,
    live: &[Presence],
    kept: usize,
    (motion, spacing_m, travelled_m): (MotionModel, f64, &[f64]),
    smoothing: f64,
) -> Result<Vec<FrameMatches>, RunError> {
    let mut track = Track::new(motion).map_err(|error| RunError::Plan(error.to_string()))?;
    let mut frames = Vec::with_capacity(live.len());
    for batch in live.chunks(BATCH) {
        let answers: Vec<Answer> =
            batch.par_iter().map(|presence| places.query(presence).map_err(wrong)).collect::<Result<_, _>>()?;
        for mut answer in answers {
            let frame = frames.len();
            let driven_m = travelled_m[frame] - travelled_m[frame.saturating_sub(1)];
            track.drive(driven_m / spacing_m);
            track.follow(&mut answer, smoothing);
            frames.push(frame_matches(&answer, answer.most_probable() == Best::NewPlace, &answer.probable(kept)));
        }
    }
    Ok(frames)
}

fn frame_matches(answer: &Answer, new_place: bool, ranked: &[usize]) -> FrameMatches {
    let candidate = |&node: &usize| Candidate {
        node: node as u32,
        log_likelihood: answer.log_likelihoods[node],
        posterior: answer.posteriors[node],
    };
    FrameMatches {
        new_place,
        new_place_log_likelihood: answer.new_place_log_likelihood,
        new_place_posterior: answer.new_place_posterior,
        candidates: ranked.iter().map(candidate).collect(),
    }
}
