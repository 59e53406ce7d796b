//! Training, one image at a time: sums over the pixels of every cell, from which means and covariances follow.
//!
//! Sums of several images are merged in a fixed order, so that the same images give the same bits on any number of
//! threads.

use crate::GenerateError;
use crate::bands::BANDS;
use crate::cells::{CELLS, COLUMNS, ROWS, between};
use crate::colour::BLOWN_OUT;
use crate::planes::{Planes, Workspace};
use crate::sensor::NoiseCounts;
use crate::shadow::ShadeCounts;
use furrow_model::ColourImage;
use furrow_model::widest;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Sums of one cell, each pixel with its weight.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct CellSums {
    /// Weights.
    pub weight: f64,
    /// Of v = (base, o1, o2).
    pub first: [f64; 3],
    /// Of the products v0 v0, v0 v1, v0 v2, v1 v1, v1 v2, v2 v2.
    pub second: [f64; 6],
    /// Of the squares of the four bands.
    pub bands: [f64; BANDS],
}

/// Numbers of a pixel that are summed.
const SUMS: usize = 1 + 3 + 6 + BANDS;

impl CellSums {
    fn add(&mut self, sums: &[f64; SUMS], share: f64) {
        self.weight += share * sums[0];
        (0..3).for_each(|i| self.first[i] += share * sums[1 + i]);
        (0..6).for_each(|i| self.second[i] += share * sums[4 + i]);
        (0..BANDS).for_each(|i| self.bands[i] += share * sums[10 + i]);
    }

    /// Adds another cell's sums.
    pub fn merge(&mut self, other: &Self) {
        self.weight += other.weight;
        (0..3).for_each(|i| self.first[i] += other.first[i]);
        (0..6).for_each(|i| self.second[i] += other.second[i]);
        (0..BANDS).for_each(|i| self.bands[i] += other.bands[i]);
    }

    /// The mean of v; `None` without weight.
    pub fn mean(&self) -> Option<[f64; 3]> {
        (self.weight > 0.0).then(|| self.first.map(|sum| sum / self.weight))
    }

    /// The covariance of v; `None` without weight.
    pub fn covariance(&self) -> Option<[[f64; 3]; 3]> {
        const PRODUCT: [[usize; 3]; 3] = [[0, 1, 2], [1, 3, 4], [2, 4, 5]];
        let mean = self.mean()?;
        let of = |i: usize, j: usize| self.second[PRODUCT[i][j]] / self.weight - mean[i] * mean[j];
        Some(std::array::from_fn(|i| std::array::from_fn(|j| of(i, j))))
    }

    /// The mean square of each band; `None` without weight.
    pub fn band_energy(&self) -> Option<[f64; BANDS]> {
        (self.weight > 0.0).then(|| self.bands.map(|sum| sum / self.weight))
    }
}

/// What is known of one domain's images.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Moments {
    /// The cells, row by row; empty before the first image.
    pub cells: Vec<CellSums>,
    /// Counts that tell light from shadow.
    pub(crate) shades: ShadeCounts,
    /// Counts that tell the camera's noise.
    pub(crate) noise: NoiseCounts,
}

impl Moments {
    /// The sums of one image.
    ///
    /// # Errors
    /// [`GenerateError::Size`] where the pixels do not fill the image.
    pub fn of(image: &ColourImage, workspace: &mut Workspace) -> Result<Self, GenerateError> {
        let planes = workspace.planes_of(image)?;
        let mut moments = Self { cells: vec![CellSums::default(); CELLS], ..Self::default() };
        for y in 0..image.height {
            let (row, down) = between(y, image.height, ROWS);
            for (columns, column) in &planes.stretches.stretches {
                let [all, right] = sum_stretch(planes, &image.rgb, columns.clone(), y);
                let left: [f64; SUMS] = std::array::from_fn(|k| all[k] - right[k]);
                for (sums, column) in [(&left, *column), (&right, column + 1)] {
                    moments.cells[row * COLUMNS + column].add(sums, 1.0 - f64::from(down));
                    moments.cells[(row + 1) * COLUMNS + column].add(sums, f64::from(down));
                }
            }
        }
        moments.shades.count(image, planes);
        moments.noise.count(image);
        Ok(moments)
    }

    /// Adds another image's or several images' sums. The order of merging decides the last bits: keep it fixed.
    pub fn merge(&mut self, other: &Self) {
        self.cells.resize(CELLS, CellSums::default());
        self.cells.iter_mut().zip(&other.cells).for_each(|(cell, other)| cell.merge(other));
        self.shades.merge(&other.shades);
        self.noise.merge(&other.noise);
    }

    /// The sums of the whole image.
    pub fn global(&self) -> CellSums {
        let mut sums = CellSums::default();
        self.cells.iter().for_each(|cell| sums.merge(cell));
        sums
    }
}

widest!(fn sum_stretch(planes: &Planes, rgb: &[u8], columns: Range<usize>, y: usize) -> [[f64; SUMS]; 2] = sum_stretch_anywhere);

/// Sums over the columns of a row, and the same with each pixel's share of the right cell.
#[inline(always)]
fn sum_stretch_anywhere(planes: &Planes, rgb: &[u8], columns: Range<usize>, y: usize) -> [[f64; SUMS]; 2] {
    let (mut all, mut right) = ([0.0; SUMS], [0.0; SUMS]);
    for x in columns {
        let at = y * planes.width + x;
        let blown = rgb[3 * at..3 * at + 3].iter().any(|level| *level >= BLOWN_OUT);
        let (valid, share) = (if blown { 0.0 } else { 1.0 }, f64::from(planes.stretches.share[x]));
        let b = |k: usize| f64::from(planes.pyramid.blurs[k][at]);
        let (l, v0, v1, v2) = (f64::from(planes.l[at]), b(3), f64::from(planes.o1[at]), f64::from(planes.o2[at]));
        let d = [l - b(0), b(0) - b(1), b(1) - b(2), b(2) - b(3)];
        let of = [
            1.0,
            v0,
            v1,
            v2,
            v0 * v0,
            v0 * v1,
            v0 * v2,
            v1 * v1,
            v1 * v2,
            v2 * v2,
            d[0] * d[0],
            d[1] * d[1],
            d[2] * d[2],
            d[3] * d[3],
        ];
        let shared = valid * share;
        for k in 0..SUMS {
            all[k] += valid * of[k];
            right[k] += shared * of[k];
        }
    }
    [all, right]
}
