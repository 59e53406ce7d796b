//! Which facets an eye sees, and the linear forms that rasterise them.
//!
//! A parallelogram C + s A + t B (camera frame) meets the ray z d where (s/z, t/z, 1/z) = [A B C]^-1 d. The three rows of the
//! inverse are linear in the pixel, so edges (0 <= s <= 1, 0 <= t <= 1), depth and texture need no clipping and no corner order.

use super::{FINER, Stage, single};
use crate::scene::{Facet, LEAFY, SHADOWLESS, THINS, TRIANGLE};
use crate::texture::set::{GROUND, textures};
use crate::vector::{V3, v3};
use furrow_model::{Se3, StereoRig};
use rayon::prelude::*;

/// Nothing nearer than this is drawn.
pub const NEAR_M: f32 = 0.15;
/// Nothing farther than this is drawn, but the horizon.
const FAR_M: f32 = 95.0;
/// From here on foliage is thinned.
const THINNED_FROM_M: f32 = 8.0;

/// One camera of the pair, at the finer size at which it is rendered.
#[derive(Debug, Clone)]
pub struct Eye {
    /// Fine columns.
    pub width: u32,
    /// Fine rows.
    pub height: u32,
    /// Fine focal length in pixels.
    pub focal: f32,
    /// Position in the world.
    pub position: V3,
    /// The camera's axes in the world.
    pub right: V3,
    /// Down.
    pub down: V3,
    /// Forward.
    pub forward: V3,
    /// When.
    pub time_s: f32,
    /// d.x = x0 + column * step.
    pub x0: f32,
    /// d.y = y0 + row * step.
    pub y0: f32,
    /// Change of d per fine pixel.
    pub step: f32,
}

impl Eye {
    /// The camera `shift_m` to the right of the left one. Pixel centres are whole numbers at the finished size.
    pub fn new(rig: &StereoRig, world_from_left: &Se3, shift_m: f64, time_s: f32) -> Eye {
        let finer = f64::from(FINER.0) / f64::from(FINER.1);
        let r = &world_from_left.rotation;
        let axis = |k: usize| v3(r[0][k] as f32, r[1][k] as f32, r[2][k] as f32);
        // The centre of fine pixel j lies at (j + 0.5) / finer - 0.5.
        let first = 0.5 / finer - 0.5;
        Eye {
            width: rig.width * FINER.0 / FINER.1,
            height: rig.height * FINER.0 / FINER.1,
            focal: (rig.focal_px * finer) as f32,
            position: single(world_from_left.apply([shift_m, 0.0, 0.0])),
            right: axis(0),
            down: axis(1),
            forward: axis(2),
            time_s,
            x0: ((first - rig.cu_px) / rig.focal_px) as f32,
            y0: ((first - rig.cv_px) / rig.focal_px) as f32,
            step: (1.0 / (rig.focal_px * finer)) as f32,
        }
    }

    /// A world vector in camera axes.
    #[inline(always)]
    pub fn seen(&self, v: V3) -> V3 {
        v3(self.right.dot(v), self.down.dot(v), self.forward.dot(v))
    }

    /// The world direction of a camera vector.
    #[inline(always)]
    pub fn shown(&self, v: V3) -> V3 {
        self.right * v.x + self.down * v.y + self.forward * v.z
    }
}

/// A linear form over the fine pixels: constant, per column, per row.
#[derive(Debug, Clone, Copy)]
pub struct Form {
    /// At column 0, row 0.
    pub base: f32,
    /// Per column.
    pub dx: f32,
    /// Per row.
    pub dy: f32,
}

/// A facet ready to be filled.
#[derive(Debug, Clone, Copy)]
pub struct Prepared {
    /// s/z.
    pub s: Form,
    /// t/z.
    pub t: Form,
    /// 1/z.
    pub w: Form,
    /// How far its middle lies ahead, in metres.
    pub depth: f32,
    /// Fine columns from .. to, both included.
    pub columns: (i32, i32),
    /// Fine rows from .. to, both included.
    pub rows: (i32, i32),
    /// The direction that it faces for the light.
    pub normal: V3,
    /// Factor on the texture's albedo.
    pub tint: V3,
    /// Share of the sky's light that arrives.
    pub open: f32,
    /// Whether light passes through as through a leaf.
    pub leafy: bool,
    /// Its texture coordinates.
    pub uv: [f32; 4],
    /// Unit directions in the world along which its texture's u and v grow.
    pub tangents: [V3; 2],
    /// Its texture.
    pub texture: u8,
    /// Mip level.
    pub level: u8,
    /// Whether it is a triangle.
    pub triangle: bool,
    /// Whether the coverage of its texture has to be asked.
    pub pierced: bool,
    /// Whether a texel is so large that one look per finished pixel is enough.
    pub magnified: bool,
}

/// The facets that `eye` sees, roughly from near to far, always in the same order.
pub fn prepare(stage: &Stage, eye: &Eye) -> Vec<Prepared> {
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
    let of_square = |&(_, index): &(f32, usize)| {
        let square = &world.squares[index];
        let facets = &world.facets[square.first..square.first + square.count];
        let mut seen: Vec<Prepared> = facets.iter().filter_map(|facet| seen(stage, eye, facet)).collect();
        // What is near hides what is behind it before its texture is asked.
        seen.sort_by(|a, b| a.depth.total_cmp(&b.depth));
        seen
    };
    let lists: Vec<Vec<Prepared>> = squares.par_iter().map(of_square).collect();
    lists.concat()
}

fn seen(stage: &Stage, eye: &Eye, facet: &Facet) -> Option<Prepared> {
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
    let (columns, rows) = bounds(eye, a, b, c, facet.flags & TRIANGLE != 0)?;
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
        s: form(bc),
        t: form(ca),
        w: form(ab),
        depth,
        columns,
        rows,
        normal: facet.normal,
        tint: facet.tint,
        open: f32::from(facet.open) * (1.0 / 255.0),
        leafy: facet.flags & LEAFY != 0,
        uv: facet.uv,
        tangents: [facet.u.unit(), facet.v.unit()],
        texture: facet.texture,
        level,
        triangle: facet.flags & TRIANGLE != 0,
        pierced,
        magnified,
    })
}

/// The fine pixels that a facet can cover; `None` where it covers no pixel's centre.
fn bounds(eye: &Eye, a: V3, b: V3, c: V3, triangle: bool) -> Option<((i32, i32), (i32, i32))> {
    let corners = [c, c + a, c + b, c + a + b];
    let corners = if triangle { &corners[..3] } else { &corners[..] };
    let (width, height) = (eye.width as i32, eye.height as i32);
    let behind = corners.iter().filter(|p| p.z < NEAR_M).count();
    if behind == corners.len() {
        return None;
    }
    if behind > 0 {
        return Some(((0, width - 1), (0, height - 1)));
    }
    let (mut low, mut high) = ((f32::INFINITY, f32::INFINITY), (f32::NEG_INFINITY, f32::NEG_INFINITY));
    for p in corners {
        let inverse = 1.0 / (p.z * eye.step);
        let (x, y) = (p.x * inverse - eye.x0 / eye.step, p.y * inverse - eye.y0 / eye.step);
        low = (low.0.min(x), low.1.min(y));
        high = (high.0.max(x), high.1.max(y));
    }
    let columns = (low.0.ceil().max(0.0) as i32, high.0.floor().min((width - 1) as f32) as i32);
    let rows = (low.1.ceil().max(0.0) as i32, high.1.floor().min((height - 1) as f32) as i32);
    (columns.0 <= columns.1 && rows.0 <= rows.1).then_some((columns, rows))
}

/// The mip level at which a texel is about a pixel, whether the texture has holes, and whether a texel is wider than a finished pixel.
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
fn sway(facet: &Facet, time_s: f32, wind: f32) -> V3 {
    let place = facet.corner.x * 0.55 + facet.corner.y * 0.4;
    let own = (facet.hash & 255) as f32 * (1.0 / 256.0);
    let gust = wave(0.31 * time_s - 0.11 * place) + 0.5 * wave(0.83 * time_s - 0.23 * place + 0.3);
    let flutter = 0.35 * wave(1.7 * time_s + own);
    let amount = f32::from(facet.sway_mm) * 0.0005 * wind;
    v3(gust + flutter, 0.6 * gust - flutter, 0.25 * flutter) * amount
}

/// A smooth wave of period 1 between -1 and 1.
fn wave(x: f32) -> f32 {
    let t = x - x.floor();
    let half = if t < 0.5 { t * 2.0 } else { t * 2.0 - 1.0 };
    let bow = 4.0 * half * (1.0 - half);
    if t < 0.5 { bow } else { -bow }
}
