//! The light that leaves each fine pixel: sun through shadows, sky, headlights, haze.

use super::Stage;
use super::backdrop::behind_all;
use super::ground::surface;
use super::prepare::{Eye, Prepared};
use super::raster::{NOTHING, Nearest};
use crate::scene::{Facet, LEAFY};
use crate::texture::set::{GROUND, textures};
use crate::vector::{V3, smoothstep, v3};
use std::f32::consts::PI;

/// Luminous power of one headlight, in the units of the sun: W/sr in its middle.
const HEADLIGHT_W_SR: f32 = 45.0;

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

/// The radiance of every fine pixel of a band.
#[inline(always)]
pub fn shade(stage: &Stage, eye: &Eye, prepared: &[Prepared], nearest: &Nearest) -> Vec<V3> {
    let mut pixels = Vec::with_capacity(nearest.index.len());
    for (i, &index) in nearest.index.iter().enumerate() {
        let (column, row) = (i % nearest.width, i / nearest.width + nearest.first_row);
        let ray = v3(eye.x0 + eye.step * column as f32, eye.y0 + eye.step * row as f32, 1.0);
        let away = eye.shown(ray);
        pixels.push(if index == NOTHING {
            open_ray(stage, eye, away)
        } else {
            let facet = &prepared[index as usize];
            facet_pixel(stage, eye, facet, (column as f32, row as f32), away, nearest.inverse_depth[i])
        });
    }
    pixels
}

/// A ray that met no facet: the plane of the ground, or the sky.
#[inline(always)]
fn open_ray(stage: &Stage, eye: &Eye, away: V3) -> V3 {
    let length = away.length();
    let d = away * (1.0 / length);
    let z = -eye.position.z / away.z;
    if away.z < 0.0 && z * length < 400.0 {
        let place = eye.position + away * z;
        return ground_pixel(stage, eye, place, V3::UP, z * length, d);
    }
    behind_all(stage, eye.position, d)
}

#[inline(always)]
fn facet_pixel(stage: &Stage, eye: &Eye, seen: &Prepared, (x, y): (f32, f32), away: V3, inverse_depth: f32) -> V3 {
    let z = 1.0 / inverse_depth;
    let place = eye.position + away * z;
    let length = away.length();
    let d = away * (1.0 / length);
    let facet = &stage.world.facets[seen.facet as usize];
    if seen.texture == GROUND {
        return ground_pixel(stage, eye, place, facet.normal, z * length, d);
    }
    let s = ((seen.s.base + seen.s.dx * x + seen.s.dy * y) * z).clamp(0.0, 1.0);
    let t = ((seen.t.base + seen.t.dx * x + seen.t.dy * y) * z).clamp(0.0, 1.0);
    let texel =
        textures().of(seen.texture).at(seen.uv[0] + s * seen.uv[2], seen.uv[1] + t * seen.uv[3], u32::from(seen.level));
    let [r, g, b] = texel.rgb.map(|c| f32::from(c) * (1.0 / 255.0));
    let point = Point {
        place,
        to_eye: -d,
        albedo: v3(r * r, g * g, b * b).times(facet.tint),
        normal: tilted(facet, texel.slope),
        open: f32::from(facet.open) * (1.0 / 255.0),
        through: if facet.flags & LEAFY != 0 { f32::from(texel.through) * (1.0 / 255.0) } else { 0.0 },
        gloss: f32::from(texel.gloss) * (1.0 / 255.0),
    };
    light(stage, eye, &point, z * length)
}

#[inline(always)]
fn ground_pixel(stage: &Stage, eye: &Eye, place: V3, normal: V3, distance_m: f32, d: V3) -> V3 {
    let under = surface(&stage.world.terrain, textures(), eye, place, distance_m);
    let normal = (normal + v3(under.slope.0, under.slope.1, 0.0)).unit();
    let point =
        Point { place, to_eye: -d, albedo: under.albedo, normal, open: under.open, through: under.through, gloss: 0.0 };
    light(stage, eye, &point, distance_m)
}

/// The facet's normal, tilted by the slopes of its texture.
#[inline(always)]
fn tilted(facet: &Facet, slope: [i8; 2]) -> V3 {
    let [a, b] = slope.map(|s| f32::from(s) * (1.0 / 127.0));
    (facet.normal + facet.u.unit() * a + facet.v.unit() * b).unit()
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
    leaving.mix(sky.ambient(V3::UP) * (point.open / PI), haze)
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
