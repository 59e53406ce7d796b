//! Maxima of the determinant over place and filter size.

use super::integral::Integral;
use super::keypoint::{Keypoint, SurfParams};
use super::newton::{Neighbourhood, newton_step};
use super::peaks::for_each_peak;
use super::response::HessianFilter;
use rayon::prelude::*;
use std::cell::RefCell;
use std::cmp::Ordering;
use std::ops::Range;

/// Rows of samples that one task searches: the responses of five such bands stay in the cache of a core.
const BAND_ROWS: usize = 24;

/// One octave: its integral image and filters, smallest first.
struct Octave<'a> {
    index: u8,
    integral: &'a Integral,
    filters: Vec<HessianFilter>,
}

impl Octave<'_> {
    /// Rows of samples in the image.
    fn rows(&self) -> usize {
        self.integral.height / self.integral.step
    }

    /// Columns of samples in the image.
    fn columns(&self) -> usize {
        self.integral.width / self.integral.step
    }

    /// Samples from the image's edge to the first place of filter `layer`.
    fn margin(&self, layer: usize) -> usize {
        self.filters[layer].side / 2 / self.integral.step
    }

    /// Samples from the image's edge to the first with all 26 neighbours, when searching `layer`.
    fn search_margin(&self, layer: usize) -> usize {
        self.margin(layer + 1) + 1
    }
}

/// Unoriented keypoints of the image behind `integral`, from its top to its bottom: neighbours are worked on one after
/// the other, while their pixels are in the cache.
pub(super) fn find_maxima(integral: &Integral, params: &SurfParams) -> Vec<Keypoint> {
    let coarser = coarser_octaves(integral, params.octaves);
    let integrals = std::iter::once(integral).chain(&coarser).take(params.octaves);
    let octaves: Vec<Octave> = integrals
        .zip(0..)
        .map(|(integral, index)| {
            let side = |layer: usize| (9 + 6 * layer) * integral.step;
            let filters = (0..params.layers + 2).map(|layer| HessianFilter::new(side(layer))).collect();
            Octave { index, integral, filters }
        })
        .collect();
    let bands: Vec<(&Octave, Range<usize>)> = octaves.iter().flat_map(bands_of).collect();
    let found: Vec<Vec<Keypoint>> = bands
        .into_par_iter()
        .map(|(octave, rows)| {
            RESPONSES.with_borrow_mut(|responses| responses.search(octave, rows, params.hessian_threshold))
        })
        .collect();
    let mut keypoints = found.concat();
    keypoints.sort_by(|a, b| a.y_px.total_cmp(&b.y_px));
    keypoints
}

/// Integral images of the second and later octaves, as long as the smallest filter fits the image.
fn coarser_octaves(integral: &Integral, octaves: usize) -> Vec<Integral> {
    let smallest = integral.width.min(integral.height);
    let mut coarser: Vec<Integral> = Vec::new();
    for _ in 1..octaves.min(usize::from(u8::MAX)) {
        let last = coarser.last().unwrap_or(integral);
        if 9 * 2 * last.step > smallest {
            break;
        }
        coarser.push(last.halved());
    }
    coarser
}

fn bands_of<'a>(octave: &'a Octave<'a>) -> impl Iterator<Item = (&'a Octave<'a>, Range<usize>)> {
    let margin = if octave.filters.len() > 2 { octave.search_margin(1) } else { octave.rows() };
    let end = octave.rows().saturating_sub(margin);
    (margin..end).step_by(BAND_ROWS).map(move |first| (octave, first..(first + BAND_ROWS).min(end)))
}

/// The order in which OpenCV returns keypoints: a total order but for equal ones.
pub(super) fn strongest_first(a: &Keypoint, b: &Keypoint) -> Ordering {
    (b.response.total_cmp(&a.response))
        .then(b.size_px.total_cmp(&a.size_px))
        .then(b.octave.cmp(&a.octave))
        .then(b.y_px.total_cmp(&a.y_px))
        .then(a.x_px.total_cmp(&b.x_px))
}

thread_local! {
    /// Each thread's memory for a band.
    static RESPONSES: RefCell<Responses> = RefCell::default();
}

/// Determinants of all layers in one band and the row above and below it.
#[derive(Default)]
struct Responses {
    /// `[layer][row][column]`; samples where a filter leaves the image are never read.
    determinants: Vec<f32>,
    scratch: Vec<f32>,
    first_row: usize,
    rows: usize,
    columns: usize,
}

impl Responses {
    /// The keypoints among the samples of rows `searched`.
    fn search(&mut self, octave: &Octave, searched: Range<usize>, threshold: f32) -> Vec<Keypoint> {
        self.first_row = searched.start - 1;
        self.rows = searched.len() + 2;
        self.columns = octave.columns();
        self.determinants.resize(octave.filters.len() * self.rows * self.columns, 0.0);
        self.scratch.resize(2 * self.columns, 0.0);
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the processor has AVX2, as was just asked.
            return unsafe { self.search_avx2(octave, searched, threshold) };
        }
        self.search_plain(octave, searched, threshold)
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn search_avx2(&mut self, octave: &Octave, searched: Range<usize>, threshold: f32) -> Vec<Keypoint> {
        self.search_plain(octave, searched, threshold)
    }

    #[inline(always)]
    fn search_plain(&mut self, octave: &Octave, searched: Range<usize>, threshold: f32) -> Vec<Keypoint> {
        self.fill(octave);
        self.maxima(octave, searched, threshold)
    }

    #[inline(always)]
    fn fill(&mut self, octave: &Octave) {
        let integral = octave.integral;
        for (layer, filter) in octave.filters.iter().enumerate() {
            let margin = octave.margin(layer);
            let along_x = filter.samples_along(integral.width, integral.step);
            let along_y = filter.samples_along(integral.height, integral.step);
            if along_x == 0 {
                continue;
            }
            for row in 0..self.rows {
                let Some(sample) = (self.first_row + row).checked_sub(margin).filter(|&sample| sample < along_y) else {
                    continue;
                };
                let start = (layer * self.rows + row) * self.columns + margin;
                let out = &mut self.determinants[start..start + along_x];
                filter.determinants(integral, 0, sample * integral.step, &mut self.scratch[..2 * along_x], out);
            }
        }
    }

    #[inline(always)]
    fn maxima(&self, octave: &Octave, searched: Range<usize>, threshold: f32) -> Vec<Keypoint> {
        let mut found = Vec::new();
        for layer in 1..octave.filters.len() - 1 {
            let margin = octave.search_margin(layer);
            let last_row = searched.end.min(octave.rows().saturating_sub(margin));
            for row in searched.start.max(margin)..last_row {
                let line = |row: usize| {
                    let start = self.at(layer, row - self.first_row, 0);
                    &self.determinants[start..start + self.columns]
                };
                let lines = [row - 1, row, row + 1].map(line);
                for_each_peak(lines, margin..self.columns.saturating_sub(margin), threshold, |column| {
                    found.extend(self.keypoint(octave, layer, row, column));
                });
            }
        }
        found
    }

    #[inline(always)]
    fn at(&self, layer: usize, row: usize, column: usize) -> usize {
        (layer * self.rows + row) * self.columns + column
    }

    /// The keypoint at a sample, if its determinant is greater than those of all 26 neighbours and the refinement
    /// holds.
    fn keypoint(&self, octave: &Octave, layer: usize, row: usize, column: usize) -> Option<Keypoint> {
        let line = row - self.first_row;
        let response = self.determinants[self.at(layer, line, column)];
        let around: Neighbourhood = std::array::from_fn(|s| {
            std::array::from_fn(|y| {
                let start = self.at(layer + s - 1, line + y - 1, column - 1);
                std::array::from_fn(|x| self.determinants[start + x])
            })
        });
        let as_strong = around.as_flattened().as_flattened().iter().filter(|&&other| other >= response).count();
        if as_strong > 1 {
            return None;
        }
        let [dx, dy, ds] = newton_step(&around)?;
        let step = octave.integral.step;
        let side = octave.filters[layer].side;
        let [left, top] = [column, row].map(|sample| step * (sample - side / 2 / step));
        let middle = (side - 1) as f32 * 0.5;
        let side_step = (side - octave.filters[layer - 1].side) as f32;
        Some(Keypoint {
            x_px: left as f32 + middle + dx * step as f32,
            y_px: top as f32 + middle + dy * step as f32,
            size_px: (side as f32 + ds * side_step).round_ties_even(),
            angle_deg: -1.0,
            response,
            octave: octave.index,
            laplacian_sign: octave.filters[layer].trace_sign(octave.integral, left, top),
        })
    }
}
