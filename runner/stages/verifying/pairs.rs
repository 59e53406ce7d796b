//! Verification of the frames of one traversal against each other, for calibration.

use super::Verifier;
use crate::RunError;
use crate::progress::{Counter, Progress, Stage, Subject};
use furrow_catalog::tables::Frame;
use furrow_catalog::{Objects, Views};
use furrow_model::ObjectId;
use rayon::prelude::*;

/// The inliers of pairs of frames of one traversal: live frame, candidate frame, both as indices into `frames`. Every
/// frame is held as a candidate, and as a live one only while its pairs are counted.
pub(crate) fn pair_inliers<V: Verifier>(
    verifier: &V,
    objects: &Objects,
    calibration: ObjectId,
    frames: &[Frame],
    pairs: &[(usize, usize)],
    progress: Progress<'_>,
) -> Result<Vec<u32>, RunError> {
    let views = Views::load(objects, calibration)?;
    let counter = Counter::new(progress, (Stage::Calibration, Subject::Whole), frames.len() + pairs.len());
    let nodes = frames
        .par_iter()
        .map(|frame| {
            let node = verifier.node(objects, &views, frame.left)?;
            counter.tick();
            Ok(node)
        })
        .collect::<Result<Vec<V::Node>, RunError>>()?;
    let counted = (0..frames.len()).into_par_iter().map(|live| {
        let own: Vec<usize> = (0..pairs.len()).filter(|pair| pairs[*pair].0 == live).collect();
        if own.is_empty() {
            return Ok(Vec::new());
        }
        let prepared = verifier.live(objects, &views, &frames[live])?;
        let count = |pair: usize| {
            let inliers = verifier.agree(&prepared, &nodes[pairs[pair].1]).inliers;
            counter.tick();
            (pair, inliers)
        };
        Ok(own.into_iter().map(count).collect())
    });
    let mut inliers = vec![0; pairs.len()];
    for (pair, found) in counted.collect::<Result<Vec<Vec<(usize, u32)>>, RunError>>()?.into_iter().flatten() {
        inliers[pair] = found;
    }
    Ok(inliers)
}
