//! The sun's shadows: an orthographic map of the facets nearest to the sun, made once per traversal because the sun
//! stands still for minutes.

use crate::lanes::{LANES, Lanes, Vectors};
use crate::texture::OPAQUE;
use crate::texture::set::{GROUND, textures};
use crate::vector::{V3, v3, whole};
use crate::world::World;
use crate::world::scene::{SHADOWLESS, TRIANGLE};
use rayon::prelude::*;

/// Cells along a side at most.
const CELLS: f32 = 4096.0;
/// Cells are no smaller than this.
const FINEST_M: f32 = 0.02;
/// A point must lie this much behind another one to be in its shadow.
const BIAS_M: f32 = 0.035;
/// Cells are kept in tiles of this side, because views run across the map in all directions.
const TILE: usize = 8;

/// Which points the sun reaches. Without a sun, none.
pub struct ShadowMap {
    across: V3,
    upward: V3,
    to_sun: V3,
    low: (f32, f32),
    per_m: (f32, f32),
    columns: usize,
    rows: usize,
    heights: Vec<f32>,
}

impl ShadowMap {
    /// The shadows in the box `low` to `high` (east, north) and 7 m up, with the sun in the direction `to_sun`.
    pub fn bake(world: &World, to_sun: V3, low: [f32; 2], high: [f32; 2]) -> ShadowMap {
        let across = v3(-to_sun.y, to_sun.x, 0.0).unit();
        let upward = to_sun.cross(across).unit();
        let (mut least, mut most) = ((f32::INFINITY, f32::INFINITY), (f32::NEG_INFINITY, f32::NEG_INFINITY));
        for corner in 0..8 {
            let pick = |bit: usize, a: f32, b: f32| if corner >> bit & 1 == 0 { a } else { b };
            let p = v3(pick(0, low[0], high[0]), pick(1, low[1], high[1]), pick(2, -0.5, 7.0));
            let (x, y) = (p.dot(across), p.dot(upward));
            least = (least.0.min(x), least.1.min(y));
            most = (most.0.max(x), most.1.max(y));
        }
        let cell = |extent: f32| (extent / CELLS).max(FINEST_M);
        let per_m = (1.0 / cell(most.0 - least.0), 1.0 / cell(most.1 - least.1));
        let whole_tiles = |cells: f32| (cells.ceil() as usize + 2).next_multiple_of(TILE);
        let columns = whole_tiles((most.0 - least.0) * per_m.0);
        let rows = whole_tiles((most.1 - least.1) * per_m.1);
        let mut map = ShadowMap {
            across,
            upward,
            to_sun,
            low: least,
            per_m,
            columns,
            rows,
            heights: vec![f32::NEG_INFINITY; columns * rows],
        };
        if to_sun.z > 0.0 {
            map.draw(world);
        }
        map
    }

    fn draw(&mut self, world: &World) {
        const BAND: usize = 128;
        let mut heights = std::mem::take(&mut self.heights);
        let map = &*self;
        heights.par_chunks_mut(BAND * map.columns).enumerate().for_each(|(band, chunk)| {
            for square in &world.squares {
                let v = (square.centre.dot(map.upward) - map.low.1) * map.per_m.1;
                let reach = square.radius_m * map.per_m.1;
                if v + reach >= (band * BAND) as f32 && v - reach <= ((band + 1) * BAND) as f32 {
                    for index in square.first..square.first + square.count {
                        map.draw_facet(world, index, band * BAND, chunk);
                    }
                }
            }
        });
        self.heights = heights;
    }

    /// Where the cell (x, y) is kept.
    #[inline(always)]
    fn index(&self, x: usize, y: usize) -> usize {
        (y / TILE) * (self.columns * TILE) + (x / TILE) * (TILE * TILE) + (y % TILE) * TILE + x % TILE
    }

    fn draw_facet(&self, world: &World, index: usize, first_row: usize, chunk: &mut [f32]) {
        let facet = &world.facets[index];
        if facet.flags & SHADOWLESS != 0 || facet.texture == GROUND {
            return;
        }
        let flat = |v: V3| (v.dot(self.across) * self.per_m.0, v.dot(self.upward) * self.per_m.1);
        let (a, b) = (flat(facet.u), flat(facet.v));
        let c = (facet.corner.dot(self.across), facet.corner.dot(self.upward));
        let c = ((c.0 - self.low.0) * self.per_m.0, (c.1 - self.low.1) * self.per_m.1);
        let determinant = a.0 * b.1 - a.1 * b.0;
        if determinant.abs() < 1e-4 {
            return;
        }
        let inverse = 1.0 / determinant;
        let (rows, columns) = (chunk.len() / self.columns, self.columns as f32);
        let reach = |k: f32, a: f32, b: f32| (k + a.min(0.0) + b.min(0.0), k + a.max(0.0) + b.max(0.0));
        let (x0, x1) = reach(c.0, a.0, b.0);
        let (y0, y1) = reach(c.1, a.1, b.1);
        let (x0, x1) = (x0.ceil().max(0.0), x1.floor().min(columns - 1.0));
        let (y0, y1) = (y0.ceil().max(first_row as f32), y1.floor().min((first_row + rows) as f32 - 1.0));
        if x0 > x1 || y0 > y1 {
            return;
        }
        let texture = textures().of(facet.texture);
        let size = (1 << texture.log2()) as f32;
        let texels = size * facet.uv[2].abs() / (a.0 * a.0 + a.1 * a.1).sqrt().max(1e-3);
        let level = (0..8).find(|&level| texels <= 1.5 * (1 << level) as f32).unwrap_or(8);
        let (base, du, dv) = (facet.corner.dot(self.to_sun), facet.u.dot(self.to_sun), facet.v.dot(self.to_sun));
        for y in y0 as usize..=y1 as usize {
            for x in x0 as usize..=x1 as usize {
                let (px, py) = (x as f32 - c.0, y as f32 - c.1);
                let s = (px * b.1 - py * b.0) * inverse;
                let t = (py * a.0 - px * a.1) * inverse;
                let beyond = if facet.flags & TRIANGLE != 0 { s + t > 1.0 } else { s > 1.0 || t > 1.0 };
                if s < 0.0 || t < 0.0 || beyond {
                    continue;
                }
                let (u, v) = (facet.uv[0] + s * facet.uv[2], facet.uv[1] + t * facet.uv[3]);
                let height = base + s * du + t * dv;
                let cell = &mut chunk[self.index(x, y - first_row)];
                if height > *cell && (texture.solid() || texture.at(u, v, level).alpha >= OPAQUE) {
                    *cell = height;
                }
            }
        }
    }

    /// The share of the sun's disc seen from the first `count` places, four cells blended: all of it outside the map,
    /// and nothing where it is not `wanted`.
    #[inline(always)]
    pub fn lit(&self, places: &Vectors, wanted: &Lanes, count: usize) -> Lanes {
        let zero = [0.0; LANES];
        let (mut height, mut fx, mut fy, mut cells) = (zero, zero, zero, [[0_u32; LANES]; 4]);
        let mut beyond = zero;
        let (wide, tall) = ((self.columns - 1) as f32, (self.rows - 1) as f32);
        let line = (self.columns * TILE) as u32;
        for k in 0..LANES {
            let p = places.at(k);
            let x = (p.dot(self.across) - self.low.0) * self.per_m.0;
            let y = (p.dot(self.upward) - self.low.1) * self.per_m.1;
            let inside = (x >= 0.0) & (y >= 0.0) & (x < wide) & (y < tall);
            let (x, y) = if inside { (x, y) } else { (0.0, 0.0) };
            beyond[k] = if inside { 0.0 } else { 1.0 };
            let (column, row) = (whole(x), whole(y));
            (fx[k], fy[k]) = (x - x.floor(), y - y.floor());
            height[k] = p.dot(self.to_sun) + BIAS_M;
            let tile = TILE as u32;
            let across = |column: u32| column / tile * (tile * tile) + column % tile;
            let upward = |row: u32| row / tile * line + row % tile * tile;
            let (left, right, low, high) = (across(column), across(column + 1), upward(row), upward(row + 1));
            (cells[0][k], cells[1][k], cells[2][k], cells[3][k]) = (left + low, right + low, left + high, right + high);
        }
        let mut heights = [zero; 4];
        for k in (0..count).filter(|&k| wanted[k] > 0.0) {
            (0..4).for_each(|corner| heights[corner][k] = self.heights[cells[corner][k] as usize]);
        }
        let mut lit = zero;
        for k in 0..LANES {
            let clear = |corner: usize| if heights[corner][k] > height[k] { 0.0 } else { 1.0 };
            let top = clear(0) * (1.0 - fx[k]) + clear(1) * fx[k];
            let bottom = clear(2) * (1.0 - fx[k]) + clear(3) * fx[k];
            let share = top * (1.0 - fy[k]) + bottom * fy[k];
            let share = if beyond[k] > 0.0 { 1.0 } else { share };
            lit[k] = if wanted[k] > 0.0 { share } else { 0.0 };
        }
        lit
    }
}
