//! The optional `shadow` stage: per cell, light and shadow as two Gaussians over (base, o2); shadows deepen or fade as
//! the target's do.

use crate::bands::{Blur, sigma_px};
use crate::cells::{CELLS, COLUMNS, ROWS, between};
use crate::colour::BLOWN_OUT;
use crate::lanes;
use crate::planes::Planes;
use furrow_model::ColourImage;
use furrow_model::widest;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Bins along base, which lies between ln 7.8e-4 and 0, and along o2.
const BASES: usize = 32;
const TINTS: usize = 16;
const BASE: [f64; 2] = [-7.2, 0.1];
const TINT: [f64; 2] = [-1.6, 1.6];
/// Rounds of the fit: the two separate long before.
const ROUNDS: usize = 30;
/// Least variance of a Gaussian: half a bin.
const LEAST: f64 = 0.01;

/// How often each (base, o2) occurred in each cell.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct ShadeCounts(Vec<[u32; BASES * TINTS]>);

impl ShadeCounts {
    pub fn count(&mut self, image: &ColourImage, planes: &Planes) {
        self.0.resize(CELLS, [0; BASES * TINTS]);
        let bin = |value: f32, range: [f64; 2], bins: usize| {
            let place = (f64::from(value) - range[0]) / (range[1] - range[0]) * bins as f64;
            (place.max(0.0) as usize).min(bins - 1)
        };
        let columns: Vec<usize> = (0..image.width).map(|x| x * COLUMNS / image.width).collect();
        for (at, pixel) in image.rgb.as_chunks::<3>().0.iter().enumerate() {
            if pixel.iter().any(|level| *level >= BLOWN_OUT) {
                continue;
            }
            let cell = at / image.width * ROWS / image.height * COLUMNS + columns[at % image.width];
            let base = bin(planes.pyramid.blurs[3][at], BASE, BASES);
            self.0[cell][base * TINTS + bin(planes.o2[at], TINT, TINTS)] += 1;
        }
    }

    pub fn merge(&mut self, other: &Self) {
        self.0.resize(CELLS, [0; BASES * TINTS]);
        for (counts, other) in self.0.iter_mut().zip(&other.0) {
            counts.iter_mut().zip(other).for_each(|(count, other)| *count = count.saturating_add(*other));
        }
    }
}

/// A Gaussian over (base, o2) and its share of a cell's pixels.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shade {
    /// Share of the pixels, 0 to 1.
    pub share: f64,
    /// Mean of (base, o2).
    pub mean: [f64; 2],
    /// Variances of base and o2, and their covariance.
    pub spread: [f64; 3],
}

/// Light and shadow of one cell in the source domain, and how much deeper the shadow is in the target.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CellShade {
    /// What is lit.
    pub lit: Shade,
    /// What lies in shadow: the darker one.
    pub shaded: Shade,
    /// What a shadow's base changes by at z = 1: the target's distance from light to shadow less the source's; negative
    /// deepens.
    pub change: f64,
}

impl CellShade {
    /// Everything that has to be finite.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = f64> + use<> {
        let of = |shade: Shade| {
            [shade.share, shade.mean[0], shade.mean[1], shade.spread[0], shade.spread[1], shade.spread[2]]
        };
        of(self.lit).into_iter().chain(of(self.shaded)).chain([self.change])
    }
}

/// Every cell's lit and shaded part in one domain.
pub(crate) struct Shades(Vec<[Shade; 2]>);

impl Shades {
    pub fn fit(counts: &ShadeCounts) -> Self {
        let empty = [0; BASES * TINTS];
        Self((0..CELLS).map(|cell| fit(counts.0.get(cell).unwrap_or(&empty))).collect())
    }
}

/// The source's shades, each with what changes towards the target.
pub(crate) fn changes(source: &Shades, target: &Shades) -> Vec<CellShade> {
    let depth = |pair: &[Shade; 2]| pair[1].mean[0] - pair[0].mean[0];
    let of = |(source, target): (&[Shade; 2], &[Shade; 2])| CellShade {
        lit: source[0],
        shaded: source[1],
        change: (depth(target) - depth(source)).clamp(-1.5, 1.5),
    };
    source.0.iter().zip(&target.0).map(of).collect()
}

/// Two Gaussians by expectation and maximisation, the brighter first.
fn fit(counts: &[u32; BASES * TINTS]) -> [Shade; 2] {
    let centre =
        |bin: usize, range: [f64; 2], bins: usize| range[0] + (bin as f64 + 0.5) / bins as f64 * (range[1] - range[0]);
    let points: Vec<([f64; 2], f64)> = (counts.iter().enumerate().filter(|(_, count)| **count > 0))
        .map(|(bin, count)| ([centre(bin / TINTS, BASE, BASES), centre(bin % TINTS, TINT, TINTS)], f64::from(*count)))
        .collect();
    let total: f64 = points.iter().map(|(_, count)| count).sum();
    // The quarters of the brightness: points come in rising order of base.
    let quantile = |share: f64| {
        let mut below = 0.0;
        let found = points.iter().find(|(_, count)| {
            below += count;
            below >= share * total
        });
        found.map_or([0.0; 2], |(point, _)| *point)
    };
    let start = |mean| Shade { share: 0.5, mean, spread: [0.5, 0.1, 0.0] };
    let mut shades = [start(quantile(0.75)), start(quantile(0.25))];
    for _ in 0..ROUNDS {
        let mut sums = [[0.0; 6]; 2];
        for (point, count) in &points {
            let shaded = f64::from(posterior(&shades[0], &shades[1], point.map(|v| v as f32)));
            for (sums, share) in sums.iter_mut().zip([1.0 - shaded, shaded]) {
                let of = [1.0, point[0], point[1], point[0] * point[0], point[1] * point[1], point[0] * point[1]];
                sums.iter_mut().zip(of).for_each(|(sum, value)| *sum += count * share * value);
            }
        }
        for (shade, s) in shades.iter_mut().zip(sums) {
            // A part without pixels stays where it is.
            if s[0] > 1e-6 * total {
                let mean = [s[1] / s[0], s[2] / s[0]];
                let spread = [
                    s[3] / s[0] - mean[0] * mean[0] + LEAST,
                    s[4] / s[0] - mean[1] * mean[1] + LEAST,
                    s[5] / s[0] - mean[0] * mean[1],
                ];
                *shade = Shade { share: s[0] / total, mean, spread };
            }
        }
    }
    shades.sort_by(|a, b| b.mean[0].total_cmp(&a.mean[0]));
    shades
}

/// The probability that a pixel lies in shadow.
fn posterior(lit: &Shade, shaded: &Shade, point: [f32; 2]) -> f32 {
    let log = |shade: &Shade| {
        let [xx, yy, xy] = shade.spread;
        let determinant = (xx * yy - xy * xy).max(1e-9);
        let (x, y) = (f64::from(point[0]) - shade.mean[0], f64::from(point[1]) - shade.mean[1]);
        let distance = (yy * x * x - 2.0 * xy * x * y + xx * y * y) / determinant;
        libm::log(shade.share.max(1e-9)) - 0.5 * (libm::log(determinant) + distance)
    };
    1.0 / (1.0 + lanes::exp((log(lit) - log(shaded)).clamp(-60.0, 60.0) as f32))
}

/// A cell's part in the lift: the logarithm of shadow's odds as a polynomial 1, x, y, x^2, x y, y^2 in (base, o2),
/// which the difference of two Gaussians' logarithms is, and what a shadow changes by.
fn polynomial(shade: &CellShade, reach: f64) -> [f32; 7] {
    let of = |shade: &Shade| {
        let ([xx, yy, xy], [x, y]) = (shade.spread, shade.mean);
        let determinant = (xx * yy - xy * xy).max(1e-9);
        let [a, b, c] = [yy / determinant, -xy / determinant, xx / determinant];
        let constant = libm::log(shade.share.max(1e-9)) - 0.5 * libm::log(determinant);
        [
            constant - 0.5 * (a * x * x + 2.0 * b * x * y + c * y * y),
            a * x + b * y,
            b * x + c * y,
            -0.5 * a,
            -b,
            -0.5 * c,
        ]
    };
    let (lit, shaded) = (of(&shade.lit), of(&shade.shaded));
    std::array::from_fn(|k| if k < 6 { (shaded[k] - lit[k]) as f32 } else { (reach * shade.change) as f32 })
}

/// Fills `planes.lift` with what is added to each pixel's brightness: `reach` times the change, weighted by how likely
/// the pixel is shaded, smoothed along the image's edges.
pub(crate) fn lift(shades: &[CellShade], reach: f64, planes: &mut Planes, height: usize) {
    let width = planes.width;
    let cells: Vec<[f32; 7]> = shades.iter().map(|shade| polynomial(shade, reach)).collect();
    let mut lift = vec![0.0; width * height];
    for (y, line) in lift.chunks_exact_mut(width).enumerate() {
        let (row, down) = between(y, height, ROWS);
        let column = |i: usize| -> [f32; 7] {
            let (above, below) = (&cells[row * COLUMNS + i], &cells[(row + 1) * COLUMNS + i]);
            std::array::from_fn(|k| above[k] + down * (below[k] - above[k]))
        };
        for (columns, first) in &planes.stretches.stretches {
            lift_stretch(planes, (&column(*first), &column(first + 1)), columns.clone(), y, &mut line[columns.clone()]);
        }
    }
    planes.lift = guided(&planes.l, &lift, width);
}

widest!(fn lift_stretch(planes: &Planes, ends: (&[f32; 7], &[f32; 7]), columns: Range<usize>, y: usize, line: &mut [f32]) -> () = lift_stretch_anywhere);

#[inline(always)]
fn lift_stretch_anywhere(
    planes: &Planes,
    (left, right): (&[f32; 7], &[f32; 7]),
    columns: Range<usize>,
    y: usize,
    line: &mut [f32],
) {
    let at = y * planes.width + columns.start..y * planes.width + columns.end;
    let pixels = planes.pyramid.blurs[3][at.clone()].iter().zip(&planes.o2[at]).zip(&planes.stretches.share[columns]);
    for (lift, ((x, y), share)) in line.iter_mut().zip(pixels) {
        let p = |k: usize| left[k] + share * (right[k] - left[k]);
        let odds = p(0) + x * (p(1) + x * p(3) + y * p(4)) + y * (p(2) + y * p(5));
        *lift = p(6) / (1.0 + lanes::exp((-odds).clamp(-60.0, 60.0)));
    }
}

/// The guided filter (He, Sun and Tang 2010): `plane` as a locally linear function of `guide`.
fn guided(guide: &[f32], plane: &[f32], width: usize) -> Vec<f32> {
    /// Variance of the guide below which it says nothing.
    const FLAT: f32 = 0.04;
    let mut blur = Blur::default();
    let sigma = sigma_px(2, width);
    let mut mean = |of: &dyn Fn(usize) -> f32| {
        let (values, mut blurred) = ((0..guide.len()).map(of).collect::<Vec<f32>>(), Vec::new());
        blur.blur(&values, width, sigma, &mut blurred);
        blurred
    };
    let (g, p) = (mean(&|i| guide[i]), mean(&|i| plane[i]));
    let (gg, gp) = (mean(&|i| guide[i] * guide[i]), mean(&|i| guide[i] * plane[i]));
    let slope: Vec<f32> =
        (0..guide.len()).map(|i| (gp[i] - g[i] * p[i]) / ((gg[i] - g[i] * g[i]).max(0.0) + FLAT)).collect();
    let (slopes, offsets) = (mean(&|i| slope[i]), mean(&|i| p[i] - slope[i] * g[i]));
    (0..guide.len()).map(|i| slopes[i] * guide[i] + offsets[i]).collect()
}
