//! FAB-MAP 2.0 on the words of live frames and nodes.

use super::{Candidate, FrameMatches, Matches, kept, remembered};
use crate::RunError;
use crate::codebook::ReadyCodebook;
use crate::key::{MATCHES, key_of};
use crate::words::Words;
use furrow_catalog::Objects;
use furrow_localiser::FabMap;
use furrow_localiser::fabmap::{Answer, Best, FabMapParams};
use rayon::prelude::*;

/// Finds or computes an experience's answers to a live pass, enough candidates that `verified` of each can be verified.
pub(crate) fn fabmap_matches(
    objects: &Objects,
    live: &Words,
    map: &Words,
    codebook: &ReadyCodebook,
    verified: u32,
) -> Result<Matches, RunError> {
    let kept = kept(verified);
    let params = FabMapParams::OPENFABMAP;
    let key =
        key_of(MATCHES, &(live.table, map.table, live.presences.len(), map.presences.len(), codebook.id, params, kept));
    remembered(objects, key, || {
        let wrong = |error: furrow_localiser::fabmap::FabMapError| RunError::Codebook(error.to_string());
        let mut places = FabMap::new(&codebook.codebook.tree, params, &codebook.codebook.samples).map_err(wrong)?;
        for place in &map.presences {
            places.add_place(place).map_err(wrong)?;
        }
        let frames = live.presences.par_iter().map_init(Answer::default, |answer, presence| {
            places.query_into(presence, answer).map_err(wrong)?;
            Ok(frame_matches(answer, kept))
        });
        frames.collect()
    })
}

fn frame_matches(answer: &Answer, kept: usize) -> FrameMatches {
    let candidate = |node: usize| Candidate {
        node: node as u32,
        log_likelihood: answer.log_likelihoods[node],
        posterior: answer.posteriors[node],
    };
    FrameMatches {
        new_place: answer.best() == Best::NewPlace,
        new_place_log_likelihood: answer.new_place_log_likelihood,
        new_place_posterior: answer.new_place_posterior,
        candidates: answer.ranked(kept).into_iter().map(candidate).collect(),
    }
}
