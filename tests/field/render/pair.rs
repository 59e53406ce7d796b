//! Both eyes' pictures, band by band.

use super::eye::{Eye, FINER};
use super::prepare::{Bounds, Prepared, prepare};
use super::stage::{Radiance, Stage};
use super::{raster, shade};
use furrow_model::widest;
use furrow_model::{Se3, StereoRig};
use rayon::prelude::*;

/// Rows of a finished image in one band.
const BAND_ROWS: u32 = 24;
/// Left and right radiance from the pose of the left camera (world from camera) at `time_s`, which decides where the
/// wind stands.
pub fn render_pair(stage: &Stage, rig: &StereoRig, world_from_left: &Se3, time_s: f32) -> [Radiance; 2] {
    let eyes = [0.0, rig.baseline_m].map(|shift_m| Eye::new(rig, world_from_left, shift_m, time_s));
    let bands = rig.height.div_ceil(BAND_ROWS);
    let sorted = |eye| {
        let facets = prepare(stage, eye);
        let drawn = by_band(&facets, bands as usize);
        (facets, drawn)
    };
    let sorted: Vec<(Vec<Prepared>, Vec<Vec<Drawn>>)> = eyes.par_iter().map(sorted).collect();
    let jobs: Vec<(usize, u32)> = (0..2).flat_map(|side| (0..bands).map(move |band| (side, band))).collect();
    let band = |(side, band): (usize, u32)| {
        let (prepared, drawn) = &sorted[side];
        let facets = (prepared.as_slice(), drawn[band as usize].as_slice());
        render_band(stage, &eyes[side], facets, band, rig)
    };
    let mut rows: Vec<Band> = jobs.into_par_iter().map(band).collect();
    let right = rows.split_off(bands as usize);
    [rows, right].map(|rows| {
        let (pixels, depths): (Vec<_>, Vec<_>) = rows.into_iter().unzip();
        Radiance { width: rig.width, height: rig.height, pixels: pixels.concat(), inverse_depth: depths.concat() }
    })
}

/// Rows of a finished picture: colours, and one over the depths.
type Band = (Vec<[f32; 3]>, Vec<f32>);

/// A facet in a band: its number, and its bounds beside it because most facets are found hidden by these alone.
type Drawn = (u32, Bounds);

/// The facets that each band shows, in their order.
fn by_band(facets: &[Prepared], bands: usize) -> Vec<Vec<Drawn>> {
    let fine_rows = (BAND_ROWS * FINER.0 / FINER.1) as usize;
    let mut drawn = vec![Vec::new(); bands];
    for (index, facet) in facets.iter().enumerate() {
        let (first, last) =
            (usize::from(facet.bounds.rows.0) / fine_rows, usize::from(facet.bounds.rows.1) / fine_rows);
        drawn[first..=last].iter_mut().for_each(|band| band.push((index as u32, facet.bounds)));
    }
    drawn
}

/// What is drawn in a band: all facets prepared, and those in the band.
type Facets<'a> = (&'a [Prepared<'a>], &'a [Drawn]);

widest!(
    fn render_band(stage: &Stage, eye: &Eye, facets: Facets<'_>, band: u32, rig: &StereoRig) -> Band
        = render_band_anywhere
);

#[inline(always)]
fn render_band_anywhere(stage: &Stage, eye: &Eye, facets: Facets<'_>, band: u32, rig: &StereoRig) -> Band {
    let first = band * BAND_ROWS;
    let count = BAND_ROWS.min(rig.height - first);
    let (fine_first, fine_count) = (first * FINER.0 / FINER.1, count * FINER.0 / FINER.1);
    let mut nearest = raster::Nearest::new(eye.width as usize, fine_first as usize, fine_count as usize);
    for (index, bounds) in facets.1 {
        nearest.fill(facets.0, *index, bounds);
    }
    shade::shade(stage, eye, facets.0, &nearest)
}
