//! The ground: heights, which soil lies where, and how much of the sky it sees. World axes: x east, y north, z up,
//! metres.

mod canopy;
mod spots;

use crate::chance::noise;
use crate::vector::{V3, smoothstep, v3};
use crate::world::route::{Beside, RouteLine};
pub use canopy::Canopy;
use rayon::prelude::*;
pub use spots::Spots;

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
    /// Which part of the soils' textures is shown, in nine steps from one part to the next: patches of some metres that
    /// run into each other.
    pub part: u8,
    /// How far the soils' textures are pulled aside, 255 for [`BEND_M`]: no two places then show the same piece of
    /// them.
    bend: u8,
}

/// Steps of [`SoilCell::part`] from one part to the next.
const PARTS: f32 = 9.0;

/// The part at (x, y), from 0 to 27: steady noise, on slower noise so that other places show other parts.
fn part(x: f32, y: f32) -> f32 {
    noise(x * 0.43, y * 0.43, 77) * 7.0 + noise(x * 0.07, y * 0.07, 79) * 20.0
}

/// The most that textures are pulled aside, in metres.
const BEND_M: f32 = 3.0;

/// How far textures are pulled aside at (x, y), from 0 to 1: noise so slow that they are stretched by a tenth.
fn bend(x: f32, y: f32) -> f32 {
    noise(x * 0.09, y * 0.09, 78)
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
    /// The ground that `soil` describes, from the place in the world and beside the route, up to `margin_m` round the
    /// route.
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
                (soil.height_m * level, stored(&soil, part(x, y), bend(x, y)))
            };
            (0..columns).map(cell).collect::<Vec<_>>()
        };
        let all: Vec<(f32, SoilCell)> = (0..rows).into_par_iter().flat_map_iter(row).collect();
        let (heights, cells) = all.into_iter().unzip();
        let outside = SoilCell { shares: [40, 215, 0, 0], tint: 128, open: 235, part: 0, bend: 0 };
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

    /// The shares of gravel, grass, mulch and tar at (x, y), blended between cells.
    pub fn shares(&self, x: f32, y: f32) -> [f32; 4] {
        let Some((i, fx, fy)) = self.cell_of(x, y) else {
            return self.outside.shares.map(|share| f32::from(share) * (1.0 / 255.0));
        };
        let corners = [
            (i, (1.0 - fx) * (1.0 - fy)),
            (i + 1, fx * (1.0 - fy)),
            (i + self.columns, (1.0 - fx) * fy),
            (i + self.columns + 1, fx * fy),
        ];
        std::array::from_fn(|soil| {
            let part = |(i, weight): (usize, f32)| f32::from(self.cells[i].shares[soil]) * weight;
            corners.into_iter().map(part).sum::<f32>() * (1.0 / 255.0)
        })
    }

    /// Upright direction of the ground at (x, y), over 0.2 m.
    pub fn normal(&self, x: f32, y: f32) -> V3 {
        let dx = self.height_m(x + 0.1, y) - self.height_m(x - 0.1, y);
        let dy = self.height_m(x, y + 0.1) - self.height_m(x, y - 0.1);
        v3(-dx, -dy, 0.2).unit()
    }
}

impl SoilCell {
    #[inline(always)]
    fn bits(&self) -> u64 {
        let SoilCell { shares: [a, b, c, d], tint, open, part, bend } = *self;
        u64::from_le_bytes([a, b, c, d, tint, open, part, bend])
    }
}

fn stored(soil: &Soil, part: f32, bend: f32) -> SoilCell {
    let total: f32 = soil.shares.iter().sum::<f32>().max(1e-6);
    SoilCell {
        shares: soil.shares.map(|s| (s / total * 255.0) as u8),
        tint: (soil.tint * 128.0).clamp(0.0, 255.0) as u8,
        open: 255,
        part: (part * PARTS) as u8,
        bend: (bend * 255.0) as u8,
    }
}
