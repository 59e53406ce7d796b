//! The light that leaves each pixel: sun through shadows, sky, headlights, haze.

use super::Stage;
use super::backdrop::{HILLTOPS, behind_all};
use super::ground::surface;
use super::prepare::{Eye, Prepared};
use super::raster::{NOTHING, Nearest};
use crate::texture::set::{GROUND, textures};
use crate::vector::{V3, smoothstep, v3};
use std::f32::consts::PI;

/// Luminous power of one headlight, in the units of the sun: W/sr in its middle.
const HEADLIGHT_W_SR: f32 = 45.0;

/// Width of a finished pixel in fine ones.
const COARSE: f32 = 1.5;

/// A lit point.
struct Point {
    place: V3,
    /// From the point to the eye.
    to_eye: V3,
    albedo: V3,
    normal: V3,
    open: f32,
    through: f32,
    gloss: f32,
}

/// The finished pixels of a band, and one over the depth of each. Three by three fine pixels make two by two finished ones by the area that they
/// share; where all nine show bare ground or open sky, the four are lit at their own centres, over a footprint that is as much wider.
#[inline(always)]
pub fn shade(stage: &Stage, eye: &Eye, prepared: &[Prepared], nearest: &Nearest) -> (Vec<[f32; 3]>, Vec<f32>) {
    let (blocks, rows) = (nearest.width / 3, nearest.index.len() / nearest.width / 3);
    let mut pixels = vec![[0.0; 3]; 4 * blocks * rows];
    let mut depths = vec![0.0; 4 * blocks * rows];
    for block_row in 0..rows {
        for block in 0..blocks {
            let corner = 3 * block_row * nearest.width + 3 * block;
            let square = Square { stage, eye, prepared, nearest, corner };
            let colours = if square.is_smooth() { square.coarse() } else { square.fine() };
            for (k, colour) in colours.into_iter().enumerate() {
                let i = (2 * block_row + k / 2) * 2 * blocks + 2 * block + k % 2;
                (pixels[i], depths[i]) = (colour.array(), square.inverse_depth(k / 2 * 2, k % 2 * 2));
            }
        }
    }
    (pixels, depths)
}

/// Three by three fine pixels, by the index of the first in the band.
struct Square<'a> {
    stage: &'a Stage<'a>,
    eye: &'a Eye,
    prepared: &'a [Prepared],
    nearest: &'a Nearest,
    corner: usize,
}

impl Square<'_> {
    fn index(&self, row: usize, column: usize) -> u32 {
        self.nearest.index[self.corner + row * self.nearest.width + column]
    }

    /// The place of the first pixel: fine column and row.
    #[inline(always)]
    fn place(&self) -> (f32, f32) {
        let width = self.nearest.width;
        ((self.corner % width) as f32, (self.corner / width + self.nearest.first_row) as f32)
    }

    /// From the eye through a place in fine pixels.
    #[inline(always)]
    fn away(&self, x: f32, y: f32) -> V3 {
        self.eye.shown(v3(self.eye.x0 + self.eye.step * x, self.eye.y0 + self.eye.step * y, 1.0))
    }

    /// One over the depth of what a fine pixel shows, 0 for the sky.
    #[inline(always)]
    fn inverse_depth(&self, row: usize, column: usize) -> f32 {
        if self.index(row, column) != NOTHING {
            return self.nearest.inverse_depth[self.corner + row * self.nearest.width + column];
        }
        let (x, y) = self.place();
        // The plane of the ground, where the ray goes down.
        (-self.away(x + column as f32, y + row as f32).z / self.eye.position.z).max(0.0)
    }

    /// Whether nothing but ground, one facet of coarse texture, or the sky above the hills is seen.
    #[inline(always)]
    fn is_smooth(&self) -> bool {
        let first = self.index(0, 0);
        let all = |wanted: &dyn Fn(u32) -> bool| (0..9).all(|k| wanted(self.index(k / 3, k % 3)));
        if first == NOTHING {
            let (x, y) = self.place();
            let away = self.away(x + 1.0, y + 2.0);
            return away.z > HILLTOPS * away.length() && all(&|index| index == NOTHING);
        }
        let facet = &self.prepared[first as usize];
        if facet.texture == GROUND {
            all(&|index| index != NOTHING && self.prepared[index as usize].texture == GROUND)
        } else {
            facet.magnified && all(&|index| index == first)
        }
    }

    /// Four finished pixels, lit once each.
    #[inline(always)]
    fn coarse(&self) -> [V3; 4] {
        let (x0, y0) = self.place();
        [(0, 0), (0, 2), (2, 0), (2, 2)].map(|(row, column)| {
            // The centre of a finished pixel lies a quarter of a fine one inside the middle of its outer fine pixel.
            let inside = |k: usize| if k == 0 { 0.25 } else { 1.75 };
            let (x, y) = (x0 + inside(column), y0 + inside(row));
            let away = self.away(x, y);
            match self.index(row, column) {
                NOTHING => open_ray(self.stage, self.eye, away, COARSE),
                index => {
                    let seen = &self.prepared[index as usize];
                    let inverse_depth = (seen.w.base + seen.w.dx * x + seen.w.dy * y).max(1e-4);
                    facet_pixel(self.stage, self.eye, seen, (x, y), away, inverse_depth, COARSE)
                }
            }
        })
    }

    /// Four finished pixels from nine fine ones.
    #[inline(always)]
    fn fine(&self) -> [V3; 4] {
        let (x0, y0) = self.place();
        let mut colours = [V3::default(); 9];
        for (k, colour) in colours.iter_mut().enumerate() {
            let (row, column) = (k / 3, k % 3);
            let (x, y) = (x0 + column as f32, y0 + row as f32);
            let away = self.away(x, y);
            *colour = match self.index(row, column) {
                NOTHING => open_ray(self.stage, self.eye, away, 1.0),
                index => {
                    let seen = &self.prepared[index as usize];
                    let inverse_depth = self.nearest.inverse_depth[self.corner + row * self.nearest.width + column];
                    facet_pixel(self.stage, self.eye, seen, (x, y), away, inverse_depth, 1.0)
                }
            };
        }
        [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(lower, right)| {
            let at = |row: usize, column: usize| colours[3 * row + column];
            let (wt, wb) = if lower == 0 { (2.0, 1.0) } else { (1.0, 2.0) };
            let (wl, wr) = if right == 0 { (2.0, 1.0) } else { (1.0, 2.0) };
            let upper = at(lower, right) * wl + at(lower, right + 1) * wr;
            let below = at(lower + 1, right) * wl + at(lower + 1, right + 1) * wr;
            (upper * wt + below * wb) * (1.0 / 9.0)
        })
    }
}

/// A ray that met no facet: the plane of the ground, or the sky. `footprint` is the width of the pixel in fine ones.
#[inline(always)]
fn open_ray(stage: &Stage, eye: &Eye, away: V3, footprint: f32) -> V3 {
    let length = away.length();
    let d = away * (1.0 / length);
    let z = -eye.position.z / away.z;
    if away.z < 0.0 && z * length < 400.0 {
        let place = eye.position + away * z;
        return ground_pixel(stage, eye, place, V3::UP, (z * length, footprint), d);
    }
    behind_all(stage, eye.position, d, footprint)
}

#[inline(always)]
fn facet_pixel(
    stage: &Stage,
    eye: &Eye,
    seen: &Prepared,
    (x, y): (f32, f32),
    away: V3,
    inverse_depth: f32,
    footprint: f32,
) -> V3 {
    let z = 1.0 / inverse_depth;
    let place = eye.position + away * z;
    let length = away.length();
    let d = away * (1.0 / length);
    if seen.texture == GROUND {
        return ground_pixel(stage, eye, place, seen.normal, (z * length, footprint), d);
    }
    let s = ((seen.s.base + seen.s.dx * x + seen.s.dy * y) * z).clamp(0.0, 1.0);
    let t = ((seen.t.base + seen.t.dx * x + seen.t.dy * y) * z).clamp(0.0, 1.0);
    let texel =
        textures().of(seen.texture).at(seen.uv[0] + s * seen.uv[2], seen.uv[1] + t * seen.uv[3], u32::from(seen.level));
    let [r, g, b, _, tilt_u, tilt_v, through, gloss] = texel.lanes();
    let point = Point {
        place,
        to_eye: -d,
        albedo: v3(r * r, g * g, b * b).times(seen.tint),
        normal: (seen.normal + seen.tangents[0] * tilt_u + seen.tangents[1] * tilt_v).unit(),
        open: seen.open,
        through: if seen.leafy { through } else { 0.0 },
        gloss,
    };
    light(stage, eye, &point, z * length)
}

#[inline(always)]
fn ground_pixel(stage: &Stage, eye: &Eye, place: V3, normal: V3, (distance_m, footprint): (f32, f32), d: V3) -> V3 {
    let under = surface(&stage.world.terrain, textures(), eye, place, distance_m, footprint);
    let normal = (normal + v3(under.slope.0, under.slope.1, 0.0)).unit();
    let point =
        Point { place, to_eye: -d, albedo: under.albedo, normal, open: under.open, through: under.through, gloss: 0.0 };
    light(stage, eye, &point, distance_m)
}

#[inline(always)]
fn light(stage: &Stage, eye: &Eye, point: &Point, distance_m: f32) -> V3 {
    let sky = stage.sky;
    let n = point.normal;
    let netted = stage.world.net.as_ref().is_some_and(|net| {
        let along = point.place.dot(net.along);
        point.place.z < net.height_m && along > net.reach_m.0 && along < net.reach_m.1
    });
    let mut arriving = sky.ambient(n) * point.open;
    let mut shine = V3::default();
    if sky.to_sun.z > 0.0 {
        let facing = n.dot(sky.to_sun);
        let cosine = facing.max(0.0) + 0.55 * point.through * (-facing).max(0.0) + 0.12 * point.through;
        if cosine > 0.0 {
            let lit = stage.shadows.lit(point.place + n * 0.02);
            let sun = sky.sun * if netted { 0.75 * lit } else { lit };
            arriving += sun * cosine;
            if point.gloss > 0.0 && lit > 0.0 {
                shine = sun * (point.gloss * sheen(n, sky.to_sun, point.to_eye));
            }
        }
        if netted {
            // The net scatters part of the sun's light it takes.
            arriving += sky.sun * (0.10 * sky.to_sun.z * point.open * (0.5 + 0.5 * n.z));
        }
    }
    if sky.headlights {
        let (lamps, gleam) = headlights(eye, point);
        arriving += lamps;
        shine += gleam;
    }
    let leaving = point.albedo.times(arriving) * (1.0 / PI) + shine;
    // Haze: half the light is scattered away over 2 km; under a canopy little light scatters in.
    let haze = 1.0 - 1.0 / (1.0 + distance_m * (1.0 / 2000.0));
    leaving.mix(sky.overhead * (point.open / PI), haze)
}

/// A soft highlight round the mirror direction.
#[inline(always)]
fn sheen(n: V3, to_light: V3, to_eye: V3) -> f32 {
    let half = (to_light + to_eye).unit();
    let c = n.dot(half).max(0.0);
    let c4 = c * c * c * c;
    let c16 = c4 * c4 * c4 * c4;
    0.055 * c16 * c4
}

/// The robot's two lamps, a quarter of a metre to either side of the camera, with a lobe of cos^8 and 1/r^2: white irradiance and shine.
#[inline(always)]
fn headlights(eye: &Eye, point: &Point) -> (V3, V3) {
    let (mut sum, mut shine) = (0.0, 0.0);
    for side in [-0.25, 0.25] {
        let lamp = eye.position + eye.right * side + eye.down * 0.12;
        let axis = (eye.forward + eye.down * 0.09 + eye.right * (side * 0.25)).unit();
        let ray = point.place - lamp;
        let square = ray.dot(ray).max(0.09);
        let d = ray * (1.0 / square.sqrt());
        let c = d.dot(axis).max(0.0);
        let c2 = c * c;
        let c8 = c2 * c2 * c2 * c2;
        // A weak even part keeps what lies beside the lobe from vanishing.
        let strength = HEADLIGHT_W_SR * (c8 + 0.02 * smoothstep(0.0, 0.5, c)) / square;
        let facing = -d.dot(point.normal);
        sum += strength * (facing.max(0.0) + 0.3 * point.through + 0.06);
        shine += strength * point.gloss * sheen(point.normal, -d, point.to_eye);
    }
    let white = v3(1.0, 0.98, 0.92);
    (white * sum, white * shine)
}
