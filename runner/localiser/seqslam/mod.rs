//! SeqSLAM: no image need be recognised by itself where a whole sequence fits (Milford and Wyeth 2012, as OpenSeqSLAM
//! computes it), with sequences measured in metres: odometry says how far apart images are, so that keyframes and live
//! frames need no common rate.

mod thumbnail;

use crate::ranking::{Ranked, best_first};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

pub use thumbnail::Thumbnail;

/// How sequences are matched.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SeqSlamParams {
    /// Images in a sequence, the newest included (d_s of the paper).
    pub images: usize,
    /// Distance between them, metres: that of the map's places.
    pub spacing_m: f64,
    /// Places over which differences are normalised, half to each side (R_window).
    pub window: usize,
    /// Slowest and fastest drive through the map, as a multiple of the live one (V_min, V_max); odometry's scale and
    /// corners cut.
    pub speeds: [f64; 2],
    /// Step between speeds tried (V_step).
    pub speed_step: f64,
    /// Farthest that images are shifted sideways against each other to find their least difference, as a share of their
    /// width, 0 to 0.5: a robot does not look exactly where it looked before (variable offsets of Pepperell, Corke and
    /// Milford 2014, "SMART").
    #[serde(default, skip_serializing_if = "is_zero")]
    pub shift: f64,
}

impl SeqSlamParams {
    /// OpenSeqSLAM's settings, 10 images, a window of 10, speeds 0.8 to 1.2 by 0.1, at a distance between places.
    pub fn at_spacing(spacing_m: f64) -> Self {
        Self { images: 10, spacing_m, window: 10, speeds: [0.8, 1.2], speed_step: 0.1, shift: 0.0 }
    }
}

/// What can be wrong with sequences.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SeqSlamError {
    /// Parameters outside their ranges.
    #[error(
        "making SeqSLAM: {0:?}; expected at least 1 image, a spacing and a speed step above 0, a window of at least 2, speeds above 0 in \
         rising order, and a shift from 0 to 0.5"
    )]
    BadParams(SeqSlamParams),
    /// Thumbnails and distances that do not belong together.
    #[error(
        "SeqSLAM on {what}: {images} images and {distances} distances came, expected as many distances, finite and never falling"
    )]
    BadDistances {
        /// `places` or `live images`.
        what: &'static str,
        /// Images.
        images: usize,
        /// Distances.
        distances: usize,
    },
}

/// Images along a route, each with the distance travelled to it in metres.
#[derive(Debug, Clone, Copy)]
pub struct Route<'a> {
    /// The images in the order driven.
    pub images: &'a [Thumbnail],
    /// Distance travelled to each.
    pub travelled_m: &'a [f64],
}

impl Route<'_> {
    fn check(&self, what: &'static str) -> Result<(), SeqSlamError> {
        let (images, distances) = (self.images.len(), self.travelled_m.len());
        let rises = self.travelled_m.is_sorted() && self.travelled_m.iter().all(|distance| distance.is_finite());
        if images == distances && rises { Ok(()) } else { Err(SeqSlamError::BadDistances { what, images, distances }) }
    }

    /// The image nearest to `metres`, the earlier of two; there must be one.
    fn nearest(&self, metres: f64) -> usize {
        let after = self.travelled_m.partition_point(|&distance| distance < metres).min(self.travelled_m.len() - 1);
        let before = after.saturating_sub(1);
        if metres - self.travelled_m[before] <= self.travelled_m[after] - metres { before } else { after }
    }
}

/// For each live image the `count` best places. A score is minus the mean normalised difference along the best-fitting
/// drive through the map that ends at the place, hence comparable within a map. Sequences that begin before the live
/// traversal are shorter; drives that begin before the map stay at its first place. Errors: [`SeqSlamError`].
pub fn rank(
    live: Route<'_>,
    places: Route<'_>,
    params: &SeqSlamParams,
    count: usize,
) -> Result<Vec<Vec<Ranked>>, SeqSlamError> {
    check(params)?;
    live.check("live images")?;
    places.check("places")?;
    let normalised: Vec<Vec<f64>> = live
        .images
        .par_iter()
        .map(|live| {
            let differences: Vec<f64> =
                places.images.iter().map(|place| live.difference(place, params.shift)).collect();
            enhanced(&differences, params.window)
        })
        .collect();
    let ranked = (0..live.images.len()).into_par_iter().map(|newest| {
        let sequence = sequence(live, newest, params);
        let score = |place: usize| {
            let drives = speeds(params).map(|speed| cost(&normalised, places, place, speed, &sequence));
            -drives.fold(f64::INFINITY, f64::min)
        };
        best_first(&(0..places.images.len()).map(score).collect::<Vec<f64>>(), count)
    });
    Ok(ranked.collect())
}

/// What was computed before images were shifted keeps its name.
fn is_zero(shift: &f64) -> bool {
    *shift == 0.0
}

fn check(params: &SeqSlamParams) -> Result<(), SeqSlamError> {
    let [slowest, fastest] = params.speeds;
    let is_positive = |number: f64| number > 0.0 && number.is_finite();
    let fine = params.images > 0
        && params.window >= 2
        && [params.spacing_m, params.speed_step, slowest, fastest].into_iter().all(is_positive)
        && slowest <= fastest
        && (0.0..=0.5).contains(&params.shift);
    if fine { Ok(()) } else { Err(SeqSlamError::BadParams(*params)) }
}

fn speeds(params: &SeqSlamParams) -> impl Iterator<Item = f64> {
    let [slowest, fastest] = params.speeds;
    let steps = ((fastest - slowest) / params.speed_step + 1e-9) as usize;
    let step = params.speed_step;
    (0..=steps).map(move |k| slowest + k as f64 * step)
}

/// The live images of the sequence that ends at `newest`, each with its distance before that, metres.
fn sequence(live: Route<'_>, newest: usize, params: &SeqSlamParams) -> Vec<(usize, f64)> {
    let here_m = live.travelled_m[newest];
    let wanted = (0..params.images).map(|k| here_m - k as f64 * params.spacing_m);
    wanted
        .take_while(|metres| *metres >= live.travelled_m[0])
        .enumerate()
        .map(|(k, metres)| if k == 0 { newest } else { live.nearest(metres) })
        .map(|image| (image, here_m - live.travelled_m[image]))
        .collect()
}

/// Mean normalised difference along a drive at `speed` that ends at `place`.
fn cost(normalised: &[Vec<f64>], places: Route<'_>, place: usize, speed: f64, sequence: &[(usize, f64)]) -> f64 {
    let end_m = places.travelled_m[place];
    let at = |before_m: f64| if before_m == 0.0 { place } else { places.nearest(end_m - speed * before_m) };
    sequence.iter().map(|&(image, before_m)| normalised[image][at(before_m)]).sum::<f64>() / sequence.len() as f64
}

/// Local contrast enhancement: each difference less the mean over the places around it, in standard deviations of
/// theirs.
fn enhanced(differences: &[f64], window: usize) -> Vec<f64> {
    let around = |place: usize| {
        let first = place.saturating_sub(window / 2);
        &differences[first..(place + window / 2 + 1).min(differences.len())]
    };
    let one = |place: usize| {
        let near = around(place);
        let mean = near.iter().sum::<f64>() / near.len() as f64;
        let variance = near.iter().map(|d| (d - mean) * (d - mean)).sum::<f64>() / near.len() as f64;
        // Where all differences are alike, none stands out.
        if variance > 0.0 { (differences[place] - mean) / variance.sqrt() } else { 0.0 }
    };
    (0..differences.len()).map(one).collect()
}
