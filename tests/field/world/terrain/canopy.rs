//! How much foliage stands over the ground, and the light that it takes.

use super::{CELL_M, Terrain};
use crate::vector::{V3, v3};

/// What still arrives under the thickest foliage.
const LEAST_OPEN: f32 = 0.025;

impl Terrain {
    /// Columns and rows of the canopy grid: cells of 0.2 m.
    pub fn canopy_grid(&self) -> Canopy {
        let (columns, rows) = (self.columns / 2 + 1, self.rows / 2 + 1);
        Canopy { low: self.low, columns, rows, depth: vec![0.0; columns * rows], top_m: vec![0.0; columns * rows] }
    }

    /// Darkens the ground under `canopy`.
    pub fn shelter(&mut self, canopy: &Canopy) {
        for (i, cell) in self.cells.iter_mut().enumerate() {
            let (x, y) =
                ((i % self.columns) as f32 * CELL_M + self.low[0], (i / self.columns) as f32 * CELL_M + self.low[1]);
            cell.open = (canopy.open(v3(x, y, 0.0)) * 255.0) as u8;
        }
    }
}

/// How much foliage stands over each spot.
pub struct Canopy {
    low: [f32; 2],
    columns: usize,
    rows: usize,
    depth: Vec<f32>,
    top_m: Vec<f32>,
}

impl Canopy {
    fn index(&self, p: V3) -> Option<usize> {
        let (c, r) = ((p.x - self.low[0]) / (2.0 * CELL_M), (p.y - self.low[1]) / (2.0 * CELL_M));
        let inside = c >= 0.0 && r >= 0.0 && c < self.columns as f32 && r < self.rows as f32;
        inside.then(|| r as usize * self.columns + c as usize)
    }

    /// Adds leaves of `area_m2` at `p`.
    pub fn add(&mut self, p: V3, area_m2: f32) {
        if let Some(i) = self.index(p) {
            self.depth[i] += area_m2 / (4.0 * CELL_M * CELL_M);
            self.top_m[i] = self.top_m[i].max(p.z);
        }
    }

    /// Spreads the foliage over its surroundings: three box means of 1 m.
    pub fn spread(&mut self) {
        for _ in 0..3 {
            self.depth = box_mean(&self.depth, self.columns, self.rows);
            self.top_m = box_mean(&self.top_m, self.columns, self.rows);
        }
    }

    /// The share of the sky's light that reaches `p` through the leaves above it: 0.025 under the thickest, 1 under
    /// none.
    pub fn open(&self, p: V3) -> f32 {
        self.index(p).map_or(1.0, |i| {
            let above = ((self.top_m[i] * 1.4 - p.z) / (self.top_m[i] * 1.4).max(0.2)).clamp(0.0, 1.0);
            LEAST_OPEN + (1.0 - LEAST_OPEN) * libm::expf(-0.75 * self.depth[i] * above)
        })
    }
}

fn box_mean(values: &[f32], columns: usize, rows: usize) -> Vec<f32> {
    const REACH: usize = 2;
    let along = |i: usize, position: usize, length: usize, stride: usize, source: &[f32]| {
        let (back, ahead) = (position.min(REACH), (length - 1 - position).min(REACH));
        (i - back * stride..=i + ahead * stride).step_by(stride).map(|k| source[k]).sum::<f32>()
            / (2 * REACH + 1) as f32
    };
    let wide: Vec<f32> = (0..values.len()).map(|i| along(i, i % columns, columns, 1, values)).collect();
    (0..values.len()).map(|i| along(i, i / columns, rows, columns, &wide)).collect()
}
