//! Filling facets into a band: the nearest facet of every fine pixel.

use super::prepare::{Form, NEAR_M, Prepared};
use crate::texture::OPAQUE;
use crate::texture::set::textures;

/// No facet.
pub const NOTHING: u32 = u32::MAX;

/// The nearest facets of a band of fine rows.
pub struct Nearest {
    /// Fine columns.
    pub width: usize,
    /// The band's first fine row.
    pub first_row: usize,
    /// 1/z of the nearest facet; 0 for none.
    pub inverse_depth: Vec<f32>,
    /// Index of the nearest prepared facet; [`NOTHING`] for none.
    pub index: Vec<u32>,
}

impl Nearest {
    /// An empty band.
    pub fn new(width: usize, first_row: usize, rows: usize) -> Nearest {
        Nearest { width, first_row, inverse_depth: vec![0.0; width * rows], index: vec![NOTHING; width * rows] }
    }

    fn rows(&self) -> usize {
        self.index.len() / self.width
    }

    /// Draws a facet where it is nearer than what is there.
    #[inline(always)]
    pub fn fill(&mut self, facet: &Prepared, index: u32) {
        let from = facet.rows.0.max(self.first_row as i32);
        let to = facet.rows.1.min((self.first_row + self.rows()) as i32 - 1);
        if from > to {
            return;
        }
        let minus = |a: &Form, b: &Form| Form { base: a.base - b.base, dx: a.dx - b.dx, dy: a.dy - b.dy };
        let far_s = minus(&facet.w, &facet.s);
        let far_t = minus(&facet.w, &facet.t);
        let edges = if facet.triangle {
            [facet.s, facet.t, minus(&far_s, &facet.t), facet.w]
        } else {
            [facet.s, facet.t, far_s, far_t]
        };
        let slopes = edges.map(|edge| 1.0 / edge.dx);
        for row in from..=to {
            let y = row as f32;
            let (mut low, mut high) = (facet.columns.0 as f32, facet.columns.1 as f32);
            for (edge, slope) in edges.iter().zip(slopes) {
                let start = edge.base + edge.dy * y;
                if edge.dx > 0.0 {
                    low = low.max((-start * slope).ceil());
                } else if edge.dx < 0.0 {
                    high = high.min((-start * slope).floor());
                } else if start < 0.0 {
                    high = -1.0;
                }
            }
            if low <= high {
                let offset = (row as usize - self.first_row) * self.width;
                self.fill_row(facet, index, offset, y, low as usize, high as usize);
            }
        }
    }

    #[inline(always)]
    fn fill_row(&mut self, facet: &Prepared, index: u32, offset: usize, y: f32, low: usize, high: usize) {
        let w_start = facet.w.base + facet.w.dy * y;
        let depths = &mut self.inverse_depth[offset + low..=offset + high];
        let indices = &mut self.index[offset + low..=offset + high];
        if !facet.pierced {
            for (k, (depth, slot)) in depths.iter_mut().zip(indices).enumerate() {
                let w = w_start + facet.w.dx * (low + k) as f32;
                if w > *depth && w < 1.0 / NEAR_M {
                    (*depth, *slot) = (w, index);
                }
            }
            return;
        }
        let (coverage, log2) = textures().of(facet.texture).coverage(u32::from(facet.level));
        let size = 1_i32 << log2;
        let (scale_u, scale_v) = (facet.uv[2] * size as f32, facet.uv[3] * size as f32);
        let (start_u, start_v) = (facet.uv[0] * size as f32, facet.uv[1] * size as f32);
        let (s_start, t_start) = (facet.s.base + facet.s.dy * y, facet.t.base + facet.t.dy * y);
        for (k, (depth, slot)) in depths.iter_mut().zip(indices).enumerate() {
            let x = (low + k) as f32;
            let w = w_start + facet.w.dx * x;
            if w > *depth && w < 1.0 / NEAR_M {
                let z = 1.0 / w;
                let u = (start_u + (s_start + facet.s.dx * x) * z * scale_u).floor() as i32 & (size - 1);
                let v = (start_v + (t_start + facet.t.dx * x) * z * scale_v).floor() as i32 & (size - 1);
                if coverage[((v << log2) + u) as usize] >= OPAQUE {
                    (*depth, *slot) = (w, index);
                }
            }
        }
    }
}
