//! Which facets an eye sees, and the linear forms that rasterise them.
//!
//! A parallelogram C + s A + t B (camera frame) meets the ray z d where (s/z, t/z, 1/z) = [A B C]^-1 d. The three rows
//! of the inverse are linear in the pixel, so edges (0 <= s <= 1, 0 <= t <= 1), depth and texture need no clipping and
//! no corner order.

use super::eye::{Eye, Form};
use super::stage::Stage;
use crate::texture::set::{GROUND, textures};
use crate::vector::{V3, v3};
use crate::world::scene::{Facet, SHADOWLESS, THINS, TRIANGLE};
use furrow_model::widest;
use rayon::prelude::*;

/// Nothing nearer than this is drawn.
pub const NEAR_M: f32 = 0.15;
/// Nothing farther than this is drawn, but the horizon.
const FAR_M: f32 = 95.0;
/// From here on foliage is thinned.
const THINNED_FROM_M: f32 = 8.0;

/// What a facet can cover at most.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    /// Fine columns from .. to, both included.
    pub columns: (u16, u16),
    /// Fine rows from .. to, both included.
    pub rows: (u16, u16),
    /// One over the depth of the nearest point, or a little more.
    pub nearest: f32,
}

/// A facet ready to be filled.
#[derive(Debug, Clone, Copy)]
pub struct Prepared<'a> {
    /// What it looks like.
    pub facet: &'a Facet,
    /// s/z.
    pub s: Form,
    /// t/z.
    pub t: Form,
    /// 1/z.
    pub w: Form,
    /// How far its middle lies ahead, in metres.
    pub depth: f32,
    /// What it can cover at most.
    pub bounds: Bounds,
    /// Mip level.
    pub level: u8,
    /// Whether it is a piece of the ground.
    pub ground: bool,
    /// Whether it is a triangle.
    pub triangle: bool,
    /// Whether the coverage of its texture has to be asked.
    pub pierced: bool,
    /// Whether a texel is so large that one look per finished pixel is enough.
    pub magnified: bool,
}

/// The facets that `eye` sees, roughly from near to far, always in the same order.
pub fn prepare<'a>(stage: &Stage<'a>, eye: &Eye) -> Vec<Prepared<'a>> {
    let world = stage.world;
    let mut squares: Vec<(f32, usize)> = Vec::new();
    let side = eye.x0.abs().max((eye.x0 + eye.step * eye.width as f32).abs());
    let spread = (1.0 + side * side).sqrt();
    for (index, square) in world.squares.iter().enumerate() {
        let c = eye.seen(square.centre - eye.position);
        let aside = (c.x.abs() - side * c.z) / spread;
        if c.z > -square.radius_m && aside < square.radius_m && c.length() - square.radius_m < FAR_M {
            squares.push((c.length(), index));
        }
    }
    squares.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    let lists: Vec<Vec<Prepared>> = squares.par_iter().map(|&(_, index)| of_square(stage, eye, index)).collect();
    lists.concat()
}

widest!(fn of_square<'a>(stage: &Stage<'a>, eye: &Eye, index: usize) -> Vec<Prepared<'a>> = of_square_anywhere);

/// The facets of a square that `eye` sees, from near to far: what is near hides what is behind it before its texture is
/// asked.
#[inline(always)]
fn of_square_anywhere<'a>(stage: &Stage<'a>, eye: &Eye, index: usize) -> Vec<Prepared<'a>> {
    let square = &stage.world.squares[index];
    let facets = &stage.world.facets[square.first..square.first + square.count];
    let (mut found, mut order): (Vec<Prepared>, Vec<u64>) = (Vec::new(), Vec::new());
    // A loop and no closure: closures are not compiled for the widest instructions.
    for facet in facets {
        if let Some(facet) = seen(stage, eye, facet) {
            // Depths in front of the eye sort as their bits do.
            order.push(u64::from(facet.depth.max(0.0).to_bits()) << 32 | found.len() as u64);
            found.push(facet);
        }
    }
    order.sort_unstable();
    order.into_iter().map(|key| found[key as u32 as usize]).collect()
}

#[inline(always)]
fn seen<'a>(stage: &Stage, eye: &Eye, facet: &'a Facet) -> Option<Prepared<'a>> {
    let mut corner = facet.corner - eye.position;
    let (mut u, mut v) = (facet.u, facet.v);
    let centre = facet.centre() - eye.position;
    let depth = eye.forward.dot(centre);
    let size = (u.dot(u) + v.dot(v)).sqrt();
    if depth < -size {
        return None;
    }
    let distance = centre.length();
    if facet.flags & THINS != 0 && distance > THINNED_FROM_M {
        // Litter and weeds vanish first: their share falls with the square of the distance.
        let flat = facet.flags & SHADOWLESS != 0;
        let ratio = THINNED_FROM_M / distance;
        let keep = if flat { ratio * ratio } else { ratio };
        if (facet.hash >> 8) as f32 * (1.0 / 16_777_216.0) > keep {
            return None;
        }
        let grow = if flat { 1.0 } else { (1.0 / keep.sqrt()).min(2.5) };
        corner = corner - (u + v) * (0.5 * (grow - 1.0));
        (u, v) = (u * grow, v * grow);
    }
    if facet.sway_mm > 0 {
        corner += sway(facet, eye.time_s, stage.wind);
    }
    let (a, b, c) = (eye.seen(u), eye.seen(v), eye.seen(corner));
    let bounds = bounds(eye, a, b, c, facet.flags & TRIANGLE != 0)?;
    let (bc, ca, ab) = (b.cross(c), c.cross(a), a.cross(b));
    let determinant = a.dot(bc);
    if determinant.abs() < 1e-12 {
        return None;
    }
    let inverse = 1.0 / determinant;
    let form = |row: V3| Form {
        base: (row.x * eye.x0 + row.y * eye.y0 + row.z) * inverse,
        dx: row.x * eye.step * inverse,
        dy: row.y * eye.step * inverse,
    };
    let (level, pierced, magnified) =
        if facet.texture == GROUND { (0, false, false) } else { detail(eye, facet, a, b, depth.max(NEAR_M)) };
    Some(Prepared {
        facet,
        s: form(bc),
        t: form(ca),
        w: form(ab),
        depth,
        bounds,
        level,
        ground: facet.texture == GROUND,
        triangle: facet.flags & TRIANGLE != 0,
        pierced,
        magnified,
    })
}

/// The fine pixels and depths that a facet can cover; `None` where it covers no pixel's centre.
#[inline(always)]
fn bounds(eye: &Eye, a: V3, b: V3, c: V3, triangle: bool) -> Option<Bounds> {
    let corners = [c, c + a, c + b, c + a + b];
    let corners = if triangle { &corners[..3] } else { &corners[..] };
    let (width, height) = (eye.width as u16, eye.height as u16);
    let behind = corners.iter().filter(|p| p.z < NEAR_M).count();
    if behind == corners.len() {
        return None;
    }
    if behind > 0 {
        return Some(Bounds { columns: (0, width - 1), rows: (0, height - 1), nearest: f32::INFINITY });
    }
    let (mut low, mut high) = ((f32::INFINITY, f32::INFINITY), (f32::NEG_INFINITY, f32::NEG_INFINITY));
    let mut nearest_m = f32::INFINITY;
    for p in corners {
        nearest_m = nearest_m.min(p.z);
        let inverse = 1.0 / (p.z * eye.step);
        let (x, y) = (p.x * inverse - eye.x0 / eye.step, p.y * inverse - eye.y0 / eye.step);
        low = (low.0.min(x), low.1.min(y));
        high = (high.0.max(x), high.1.max(y));
    }
    let columns = (low.0.ceil().max(0.0), high.0.floor().min(f32::from(width - 1)));
    let rows = (low.1.ceil().max(0.0), high.1.floor().min(f32::from(height - 1)));
    // What the linear form of the depth gives is rounded.
    let nearest = 1.0001 / nearest_m;
    let whole = |(from, to): (f32, f32)| (from as u16, to as u16);
    (columns.0 <= columns.1 && rows.0 <= rows.1).then(|| Bounds { columns: whole(columns), rows: whole(rows), nearest })
}

/// The mip level at which a texel is about a pixel, whether the texture has holes, and whether a texel is wider than a
/// finished pixel.
#[inline(always)]
fn detail(eye: &Eye, facet: &Facet, a: V3, b: V3, depth: f32) -> (u8, bool, bool) {
    let texture = textures().of(facet.texture);
    let size = (1_u32 << texture.log2()) as f32;
    let texels_per_m =
        (size * facet.uv[2].abs() / a.length().max(1e-4)).max(size * facet.uv[3].abs() / b.length().max(1e-4));
    let texels_per_pixel = texels_per_m * depth / eye.focal;
    let mut level = 0;
    while level < 8 && texels_per_pixel > 1.5 * (1 << level) as f32 {
        level += 1;
    }
    (level, !texture.solid(), 1.25 * texels_per_pixel < (1 << level) as f32)
}

/// Where the wind has moved a facet: gusts that travel over the field, and a flutter of its own.
#[inline(always)]
fn sway(facet: &Facet, time_s: f32, wind: f32) -> V3 {
    let place = facet.corner.x * 0.55 + facet.corner.y * 0.4;
    let own = (facet.hash & 255) as f32 * (1.0 / 256.0);
    let gust = wave(0.31 * time_s - 0.11 * place) + 0.5 * wave(0.83 * time_s - 0.23 * place + 0.3);
    let flutter = 0.35 * wave(1.7 * time_s + own);
    let amount = f32::from(facet.sway_mm) * 0.0005 * wind;
    v3(gust + flutter, 0.6 * gust - flutter, 0.25 * flutter) * amount
}

/// A smooth wave of period 1 between -1 and 1.
#[inline(always)]
fn wave(x: f32) -> f32 {
    let t = x - x.floor();
    let half = if t < 0.5 { t * 2.0 } else { t * 2.0 - 1.0 };
    let bow = 4.0 * half * (1.0 - half);
    if t < 0.5 { bow } else { -bow }
}
