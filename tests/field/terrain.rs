//! The ground: heights, which soil lies where, and how much of the sky it sees. World axes: x east, y north, z up, metres.

use crate::chance::noise;
use crate::route::{Beside, RouteLine};
use crate::vector::{V3, smoothstep, v3};
use rayon::prelude::*;

/// Side of a soil cell in metres.
const CELL_M: f32 = 0.1;
/// How far from the route the ground has relief; beyond, it is the plane z = 0.
pub const RELIEF_M: f32 = 9.0;

/// The ground at one spot.
#[derive(Debug, Clone, Copy)]
pub struct Soil {
    /// Height in metres.
    pub height_m: f32,
    /// Shares of gravel, grass, mulch and tar.
    pub shares: [f32; 4],
    /// Brightness, about 1.
    pub tint: f32,
}

/// What is stored of a soil cell for shading.
#[derive(Debug, Clone, Copy)]
#[repr(C)]
pub struct SoilCell {
    /// Shares of gravel, grass, mulch and tar; 255 for all.
    pub shares: [u8; 4],
    /// Brightness; 128 for 1.
    pub tint: u8,
    /// Share of the sky's light that arrives; 255 for all.
    pub open: u8,
    /// Which part of the soils' textures is shown, in 36 steps from one part to the next: patches of some metres that run into each other.
    pub part: u8,
    /// Unused: eight bytes are blended at once.
    spare: u8,
}

/// Steps of [`SoilCell::part`] from one part to the next.
const PARTS: f32 = 36.0;

/// The ground between the cells.
#[derive(Debug, Clone, Copy)]
pub struct Spot {
    /// Shares of gravel, grass, mulch and tar.
    pub shares: [f32; 4],
    /// Brightness, about 1.
    pub tint: f32,
    /// Share of the sky's light that arrives.
    pub open: f32,
    /// Which part of the soils' textures is shown, from 0 to 7.
    pub part: f32,
}

/// The part at (x, y): steady noise.
fn part(x: f32, y: f32) -> f32 {
    noise(x * 0.43, y * 0.43, 77) * 7.0
}

/// The ground of a world, in a box round its route.
#[derive(Debug, Clone)]
pub struct Terrain {
    low: [f32; 2],
    columns: usize,
    rows: usize,
    heights: Vec<f32>,
    cells: Vec<SoilCell>,
    outside: SoilCell,
}

impl Terrain {
    /// The ground that `soil` describes, from the place in the world and beside the route, up to `margin_m` round the route.
    pub fn build(route: &RouteLine, margin_m: f32, soil: impl Fn(f32, f32, Beside) -> Soil + Sync) -> Terrain {
        let (low, high) = route.extent(route.length_m());
        let low = low.map(|v| v - margin_m);
        let [columns, rows] = [0, 1].map(|k| ((high[k] + margin_m - low[k]) / CELL_M).ceil() as usize + 1);
        let block_columns = columns / 10 + 1;
        let row = |r: usize| {
            let y = low[1] + r as f32 * CELL_M;
            let y_near = low[1] + ((r / 10) as f32 + 0.5);
            let near: Vec<usize> =
                (0..block_columns).map(|b| route.nearest_metre(low[0] + b as f32 + 0.5, y_near)).collect();
            let cell = |c: usize| {
                let x = low[0] + c as f32 * CELL_M;
                let beside = route.beside(x, y, near[c / 10]);
                let soil = soil(x, y, beside);
                let level = 1.0 - smoothstep(RELIEF_M - 3.0, RELIEF_M - 0.5, beside.across_m.abs());
                (soil.height_m * level, stored(&soil, part(x, y)))
            };
            (0..columns).map(cell).collect::<Vec<_>>()
        };
        let all: Vec<(f32, SoilCell)> = (0..rows).into_par_iter().flat_map_iter(row).collect();
        let (heights, cells) = all.into_iter().unzip();
        let outside = SoilCell { shares: [40, 215, 0, 0], tint: 128, open: 235, part: 0, spare: 0 };
        Terrain { low, columns, rows, heights, cells, outside }
    }

    #[inline(always)]
    fn cell_of(&self, x: f32, y: f32) -> Option<(usize, f32, f32)> {
        let (u, v) = ((x - self.low[0]) / CELL_M, (y - self.low[1]) / CELL_M);
        let inside = u >= 0.0 && v >= 0.0 && u < (self.columns - 1) as f32 && v < (self.rows - 1) as f32;
        inside.then(|| (v as usize * self.columns + u as usize, u - u.floor(), v - v.floor()))
    }

    /// The height at (x, y).
    pub fn height_m(&self, x: f32, y: f32) -> f32 {
        self.cell_of(x, y).map_or(0.0, |(i, fx, fy)| {
            let h = |k: usize| self.heights[k];
            let top = h(i) + (h(i + 1) - h(i)) * fx;
            let bottom = h(i + self.columns) + (h(i + self.columns + 1) - h(i + self.columns)) * fx;
            top + (bottom - top) * fy
        })
    }

    /// The soil at (x, y), blended between cells.
    #[inline(always)]
    pub fn soil(&self, x: f32, y: f32) -> Spot {
        let Some((i, fx, fy)) = self.cell_of(x, y) else {
            let spot = Spot::of(self.outside.lanes());
            return Spot { part: part(x, y), ..spot };
        };
        let corners = [
            (i, (1.0 - fx) * (1.0 - fy)),
            (i + 1, fx * (1.0 - fy)),
            (i + self.columns, (1.0 - fx) * fy),
            (i + self.columns + 1, fx * fy),
        ];
        let mut sum = [0.0; 8];
        for (index, weight) in corners {
            let cell = self.cells[index].lanes();
            for k in 0..8 {
                sum[k] += cell[k] * weight;
            }
        }
        Spot::of(sum)
    }

    /// Upright direction of the ground at (x, y), over 0.2 m.
    pub fn normal(&self, x: f32, y: f32) -> V3 {
        let dx = self.height_m(x + 0.1, y) - self.height_m(x - 0.1, y);
        let dy = self.height_m(x, y + 0.1) - self.height_m(x, y - 0.1);
        v3(-dx, -dy, 0.2).unit()
    }

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

impl SoilCell {
    #[inline(always)]
    fn lanes(&self) -> [f32; 8] {
        let SoilCell { shares: [a, b, c, d], tint, open, part, spare } = *self;
        [a, b, c, d, tint, open, part, spare].map(f32::from)
    }
}

impl Spot {
    #[inline(always)]
    fn of([a, b, c, d, tint, open, part, _]: [f32; 8]) -> Spot {
        const BYTE: f32 = 1.0 / 255.0;
        Spot {
            shares: [a, b, c, d].map(|s| s * BYTE),
            tint: tint * (1.0 / 128.0),
            open: open * BYTE,
            part: part * (1.0 / PARTS),
        }
    }
}

fn stored(soil: &Soil, part: f32) -> SoilCell {
    let total: f32 = soil.shares.iter().sum::<f32>().max(1e-6);
    SoilCell {
        shares: soil.shares.map(|s| (s / total * 255.0) as u8),
        tint: (soil.tint * 128.0).clamp(0.0, 255.0) as u8,
        open: 255,
        part: (part * PARTS) as u8,
        spare: 0,
    }
}

/// What still arrives under the thickest foliage.
const LEAST_OPEN: f32 = 0.025;

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

    /// The share of the sky's light that reaches `p` through the leaves above it: 0.025 under the thickest, 1 under none.
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
