//! Filling facets into a band: the nearest facet of every fine pixel.

use super::eye::Form;
use super::prepare::{Bounds, NEAR_M, Prepared};
use crate::texture::OPAQUE;
use crate::texture::set::textures;
use crate::vector::whole;

/// No facet.
pub const NOTHING: u32 = u32::MAX;

/// Fine columns and rows of a cell of the band: facets hidden behind whole cells are not drawn.
const CELL: (usize, usize) = (16, 6);
/// Rows or columns that are worked on at once.
const LANES: usize = 8;
/// In place of a cell's farthest depth: something was drawn there since it was found.
const STALE: f32 = -1.0;

/// The nearest facets of a band of fine rows.
pub struct Nearest {
    /// Fine columns.
    pub width: usize,
    /// Fine rows.
    pub rows: usize,
    /// The band's first fine row.
    pub first_row: usize,
    /// 1/z of the nearest facet; 0 for none.
    pub inverse_depth: Vec<f32>,
    /// Index of the nearest prepared facet; [`NOTHING`] for none.
    pub index: Vec<u32>,
    /// The least of `inverse_depth` in each cell, or [`STALE`].
    farthest: Vec<f32>,
    /// Cells side by side.
    cells: usize,
}

impl Nearest {
    /// An empty band.
    pub fn new(width: usize, first_row: usize, rows: usize) -> Nearest {
        let cells = width.div_ceil(CELL.0);
        Nearest {
            width,
            first_row,
            // The last lanes may reach beyond the last row.
            inverse_depth: vec![0.0; width * rows + LANES],
            index: vec![NOTHING; width * rows + LANES],
            rows,
            farthest: vec![0.0; cells * rows.div_ceil(CELL.1)],
            cells,
        }
    }

    /// Whether all that a facet can cover of these rows of the band is nearer already.
    #[inline(always)]
    fn hides(&mut self, bounds: &Bounds, (from, to): (usize, usize)) -> bool {
        let (left, right) = (usize::from(bounds.columns.0) / CELL.0, usize::from(bounds.columns.1) / CELL.0);
        for line in from / CELL.1..=to / CELL.1 {
            for column in left..=right {
                let cell = line * self.cells + column;
                if self.farthest[cell] == STALE {
                    self.farthest[cell] = self.farthest_in(line, column);
                }
                if bounds.nearest > self.farthest[cell] {
                    return false;
                }
            }
        }
        true
    }

    /// The least inverse depth in a cell.
    #[inline(always)]
    fn farthest_in(&self, line: usize, column: usize) -> f32 {
        let columns = column * CELL.0..self.width.min((column + 1) * CELL.0);
        let lines = self.inverse_depth.chunks_exact(self.width).skip(line * CELL.1).take(CELL.1);
        lines.fold(f32::INFINITY, |least, line| line[columns.clone()].iter().fold(least, |least, &w| least.min(w)))
    }

    /// Draws facet number `index`, whose bounds are given, where it is nearer than what is there.
    #[inline(always)]
    pub fn fill(&mut self, facets: &[Prepared], index: u32, bounds: &Bounds) {
        let from = usize::from(bounds.rows.0).max(self.first_row);
        let to = usize::from(bounds.rows.1).min(self.first_row + self.rows - 1);
        if from > to || self.hides(bounds, (from - self.first_row, to - self.first_row)) {
            return;
        }
        let facet = &facets[index as usize];
        let (from, to) = (from as i32, to as i32);
        let minus = |a: &Form, b: &Form| Form { base: a.base - b.base, dx: a.dx - b.dx, dy: a.dy - b.dy };
        let far_s = minus(&facet.w, &facet.s);
        let far_t = minus(&facet.w, &facet.t);
        let edges = if facet.triangle {
            [facet.s, facet.t, minus(&far_s, &facet.t), facet.w]
        } else {
            [facet.s, facet.t, far_s, far_t]
        };
        let mut holes = None;
        for first in (from..to + 1).step_by(LANES) {
            let (low, high) = spans(&edges, bounds.columns, first);
            for row in first..(to + 1).min(first + LANES as i32) {
                let lane = (row - first) as usize;
                if low[lane] <= high[lane] {
                    let (line, span) = (row as usize - self.first_row, (whole(low[lane]), whole(high[lane])));
                    if self.fill_row(facet, &mut holes, index, (line, row as f32), span) {
                        let cells = line / CELL.1 * self.cells;
                        let (left, right) = (span.0 as usize / CELL.0, span.1 as usize / CELL.0);
                        self.farthest[cells + left..=cells + right].fill(STALE);
                    }
                }
            }
        }
    }

    /// Draws the columns `low` to `high` of a facet's row, and says whether any of them was nearer than what was there.
    /// Lanes beyond the span keep what they have.
    #[inline(always)]
    fn fill_row(
        &mut self,
        facet: &Prepared,
        holes: &mut Option<Holes<'static>>,
        index: u32,
        (line, y): (usize, f32),
        (low, high): (u32, u32),
    ) -> bool {
        let offset = line * self.width;
        let w_start = facet.w.base + facet.w.dy * y;
        let last = high as i32 as f32;
        let mut drawn = false;
        for left in (low..high + 1).step_by(LANES) {
            let place = offset + left as usize..offset + left as usize + LANES;
            let depths: &mut [f32; LANES] = (&mut self.inverse_depth[place.clone()]).try_into().expect("as many");
            let (mut x, mut w, mut nearer) = ([left as i32 as f32; LANES], [0.0; LANES], [0_u32; LANES]);
            for k in 0..LANES {
                x[k] += k as f32;
                w[k] = w_start + facet.w.dx * x[k];
                nearer[k] = mask((w[k] > depths[k]) & (w[k] < 1.0 / NEAR_M) & (x[k] <= last));
            }
            if nearer == [0; LANES] {
                continue;
            }
            if facet.pierced {
                let there = holes.get_or_insert_with(|| Holes::of(facet)).closed(facet, y, &x, &w);
                for k in 0..LANES {
                    nearer[k] &= there[k];
                }
                if nearer == [0; LANES] {
                    continue;
                }
            }
            drawn = true;
            let indices: &mut [u32; LANES] = (&mut self.index[place]).try_into().expect("as many");
            for k in 0..LANES {
                depths[k] = f32::from_bits(w[k].to_bits() & nearer[k] | depths[k].to_bits() & !nearer[k]);
                indices[k] = index & nearer[k] | indices[k] & !nearer[k];
            }
        }
        drawn
    }
}

/// Where a facet has holes, and where in texels it starts and ends.
struct Holes<'a> {
    coverage: &'a [u8],
    log2: u32,
    start: [f32; 2],
    scale: [f32; 2],
}

impl Holes<'static> {
    #[inline(always)]
    fn of(facet: &Prepared) -> Self {
        let (coverage, log2) = textures().of(facet.facet.texture).coverage(u32::from(facet.level));
        let size = (1_u32 << log2) as f32;
        let [u, v, wide, tall] = facet.facet.uv.map(|uv| uv * size);
        Holes { coverage, log2, start: [u, v], scale: [wide, tall] }
    }

    /// All bits where the facet is opaque in the columns `x`, at the inverse depths `w`.
    #[inline(always)]
    fn closed(&self, facet: &Prepared, y: f32, x: &[f32; LANES], w: &[f32; LANES]) -> [u32; LANES] {
        let (s_start, t_start) = (facet.s.base + facet.s.dy * y, facet.t.base + facet.t.dy * y);
        let inside = (1_u32 << self.log2) - 1;
        let (mut z, mut u, mut v, mut closed) = ([0.0; LANES], [0; LANES], [0; LANES], [0; LANES]);
        for k in 0..LANES {
            z[k] = 1.0 / w[k];
        }
        for k in 0..LANES {
            u[k] = whole(self.start[0] + (s_start + facet.s.dx * x[k]) * z[k] * self.scale[0]) & inside;
        }
        for k in 0..LANES {
            v[k] = whole(self.start[1] + (t_start + facet.t.dx * x[k]) * z[k] * self.scale[1]) & inside;
        }
        for k in 0..LANES {
            closed[k] = mask(self.coverage[((v[k] << self.log2) + u[k]) as usize] >= OPAQUE);
        }
        closed
    }
}

/// All bits or none: choices made by masks become vector instructions without branches.
#[inline(always)]
fn mask(choice: bool) -> u32 {
    u32::from(choice).wrapping_neg()
}

/// The columns from .. to that lie within all edges, in [`LANES`] rows from `first` on; none where from is beyond to.
#[inline(always)]
fn spans(edges: &[Form; 4], columns: (u16, u16), first: i32) -> ([f32; LANES], [f32; LANES]) {
    let (mut low, mut high) = ([f32::from(columns.0); LANES], [f32::from(columns.1); LANES]);
    for edge in edges {
        let slope = 1.0 / edge.dx;
        let mut start = [0.0; LANES];
        for (k, start) in start.iter_mut().enumerate() {
            *start = edge.base + edge.dy * (first as f32 + k as f32);
        }
        if edge.dx > 0.0 {
            for k in 0..LANES {
                low[k] = low[k].max((-start[k] * slope).ceil());
            }
        } else if edge.dx < 0.0 {
            for k in 0..LANES {
                high[k] = high[k].min((-start[k] * slope).floor());
            }
        } else {
            for k in 0..LANES {
                high[k] = if start[k] < 0.0 { -1.0 } else { high[k] };
            }
        }
    }
    (low, high)
}
