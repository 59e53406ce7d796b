//! FAB-MAP 2.0 on the words of live frames and nodes (Cummins and Newman 2011).

use super::table::{kept, remembered};
use crate::RunError;
use crate::inputs::answers::{Candidate, FrameMatches};
use crate::inputs::key::{MATCHES, key_of};
use crate::inputs::recogniser::{Answering, Context, FrameByFrame, PlaceIndex, Recogniser, RecogniserEntry};
use crate::inputs::traversals::LiveTraversal;
use crate::inputs::words::{ReadyCodebook, WordTables, Words};
use crate::matrix::{Fault, LocaliserSpec, Method, OwnKey};
use furrow_catalog::CatalogError;
use furrow_localiser::fabmap::{Answer, Best, FabMapError, FabMapParams, MotionModel, Track};
use furrow_localiser::{FabMap, Presence};
use furrow_model::ObjectId;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::sync::Arc;

const NAME: &str = "fabmap2";
const PARAMS: FabMapParams = FabMapParams::OPENFABMAP;
/// Frames whose answers wait in memory for those before them.
const BATCH: usize = 64;

pub(super) static FABMAP: RecogniserEntry = RecogniserEntry {
    method: Method {
        name: NAME,
        keys: &[OwnKey { name: "motion", exclusive: true }],
        check: |spec| motion(spec).map(drop),
    },
    open: |matrix| {
        let (motion, verified) = (motion(&matrix.localiser)?, matrix.localiser.candidates);
        Ok(Arc::new(FabMap2 { motion, spacing_m: matrix.keyframes.distance_m, verified }))
    },
};

/// How likely the robot goes from place to place; none, and every frame stands alone.
fn motion(spec: &LocaliserSpec) -> Result<Option<MotionModel>, Fault> {
    let motion: Option<MotionModel> = spec.get("motion")?;
    match motion {
        Some(motion) if !motion.is_valid() => {
            Err(spec.fault("motion", "motion needs chances from 0 to 1, and stay + leave at most 1"))
        }
        known => Ok(known),
    }
}

/// FAB-MAP 2.0 as a matrix asks for it.
struct FabMap2 {
    motion: Option<MotionModel>,
    /// The distance between places.
    spacing_m: f64,
    /// Of each answer so many can be verified.
    verified: u32,
}

impl Recogniser for FabMap2 {
    /// Its name alone, without a motion model: the algorithm's version is in every key.
    fn cell_key_part(&self) -> Value {
        self.motion.map_or(json!(NAME), |motion| json!([NAME, motion]))
    }

    fn needs_codebook(&self) -> bool {
        true
    }

    fn answers_key(&self, live: &LiveTraversal, words: &WordTables) -> Result<Option<ObjectId>, CatalogError> {
        Ok(Some(self.key(words, &live.travelled_m())?))
    }

    fn frame_by_frame(&self) -> Result<&dyn FrameByFrame, &'static str> {
        match self.motion {
            None => Ok(self),
            Some(_) => Err("live localisation knows no motion model: leave localiser.motion out"),
        }
    }

    fn look_at<'a>(&'a self, context: &'a dyn Context, live: &'a LiveTraversal) -> Result<Answering<'a>, RunError> {
        let codebook = context.codebook()?;
        let (seen, travelled_m) = (context.live_words(live)?, live.travelled_m());
        Ok(Box::new(move |contender| {
            let map = context.contender_words(contender)?;
            let tables = WordTables {
                codebook: codebook.id,
                live: (seen.table, seen.presences.len()),
                map: (map.table, map.presences.len()),
            };
            remembered(context.objects(), self.key(&tables, &travelled_m)?, || {
                let (places, kept) = (indexed(&map, codebook)?, kept(self.verified));
                match self.motion {
                    None => each_alone(&places, &seen.presences, kept),
                    Some(motion) => {
                        let motion = (motion, self.spacing_m, travelled_m.as_slice());
                        one_after_another(&places, &seen.presences, kept, motion, PARAMS.smoothing)
                    }
                }
            })
        }))
    }
}

impl FabMap2 {
    /// The key of an experience's answers to a live traversal that had travelled so far at each frame.
    fn key(&self, words: &WordTables, travelled_m: &[f64]) -> Result<ObjectId, CatalogError> {
        let WordTables { codebook, live: (live, live_images), map: (map, map_images) } = words;
        let kept = kept(self.verified);
        match self.motion {
            None => key_of(MATCHES, &(live, map, live_images, map_images, codebook, PARAMS, kept)),
            Some(motion) => {
                let motion = (motion, self.spacing_m, travelled_m);
                key_of(MATCHES, &(live, map, (live_images, map_images), codebook, PARAMS, kept, motion))
            }
        }
    }
}

impl FrameByFrame for FabMap2 {
    fn index(&self, map: &Words, codebook: &ReadyCodebook) -> Result<Box<dyn PlaceIndex>, RunError> {
        Ok(Box::new(indexed(map, codebook)?))
    }
}

impl PlaceIndex for FabMap {
    fn rank(&self, seen: &Presence, candidates: usize) -> Result<Vec<(usize, f64)>, RunError> {
        let mut found = Answer::default();
        self.query_into(seen, &mut found).map_err(fabmap_error)?;
        if found.best() == Best::NewPlace {
            return Ok(Vec::new());
        }
        Ok(found.ranked(candidates).into_iter().map(|node| (node, found.log_likelihoods[node])).collect())
    }
}

/// The index of a map's places.
fn indexed(map: &Words, codebook: &ReadyCodebook) -> Result<FabMap, RunError> {
    let mut places = FabMap::new(&codebook.codebook.tree, PARAMS, &codebook.codebook.samples).map_err(fabmap_error)?;
    for place in &map.presences {
        places.add_place(place).map_err(fabmap_error)?;
    }
    Ok(places)
}

fn fabmap_error(error: FabMapError) -> RunError {
    RunError::Codebook(error.to_string())
}

fn each_alone(places: &FabMap, live: &[Presence], kept: usize) -> Result<Vec<FrameMatches>, RunError> {
    let frames = live.par_iter().map_init(Answer::default, |answer, presence| {
        places.query_into(presence, answer).map_err(fabmap_error)?;
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
    let mut track = Track::new(motion).map_err(|error| RunError::Recogniser(error.to_string()))?;
    let mut frames = Vec::with_capacity(live.len());
    for batch in live.chunks(BATCH) {
        let answers: Vec<Answer> =
            batch.par_iter().map(|presence| places.query(presence).map_err(fabmap_error)).collect::<Result<_, _>>()?;
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
        posterior: Some(answer.posteriors[node]),
    };
    FrameMatches {
        new_place,
        new_place_log_likelihood: Some(answer.new_place_log_likelihood),
        new_place_posterior: Some(answer.new_place_posterior),
        candidates: ranked.iter().map(candidate).collect(),
    }
}
