//! From samples of the picture to points of the world with their looks, ready to be lit.

use super::eye::Eye;
use super::ground::surface;
use super::light::Points;
use super::prepare::Prepared;
use super::stage::Stage;
use crate::lanes::{LANES, Octets, Vectors};
use crate::texture::set::textures;
use crate::vector::{V3, v3};
use crate::world::scene::LEAFY;

/// What a byte of 1 stands for.
const UNIT: f32 = 1.0 / 255.0;

/// A sample that shows a facet.
pub struct OnFacet {
    /// The number of the facet prepared.
    pub index: u32,
    /// Where its colour belongs.
    pub slot: usize,
    /// Fine column.
    pub x: f32,
    /// Fine row.
    pub y: f32,
    /// One over its depth.
    pub inverse_depth: f32,
}

/// A sample that shows ground.
pub struct OnGround {
    /// Where its colour belongs.
    pub slot: usize,
    /// Where it lies in the world.
    pub place: V3,
    /// The ground's normal but for its texture.
    pub normal: V3,
    /// Unit vector from the eye.
    pub d: V3,
    /// Distance from the eye.
    pub distance_m: f32,
    /// Width of the pixel in fine ones.
    pub footprint: f32,
}

/// Sets `points` to what the samples of facets show.
#[inline(always)]
pub fn facet_points(eye: &Eye, prepared: &[Prepared], samples: &[OnFacet], points: &mut Points) {
    let zero = [0.0; LANES];
    let (mut x, mut y, mut inverse_depth, mut s, mut t) = (zero, zero, zero, zero, zero);
    let (mut u, mut v, mut wide, mut tall) = (zero, zero, zero, zero);
    let (mut along_u, mut along_v) = (Vectors::ZERO, Vectors::ZERO);
    for (k, sample) in samples.iter().enumerate() {
        let seen = &prepared[sample.index as usize];
        (x[k], y[k], inverse_depth[k]) = (sample.x, sample.y, sample.inverse_depth);
        (s[k], t[k]) = (seen.s.at(sample.x, sample.y), seen.t.at(sample.x, sample.y));
        [u[k], v[k], wide[k], tall[k]] = seen.facet.uv;
        along_u.set(k, seen.facet.u);
        along_v.set(k, seen.facet.v);
    }
    for k in 0..LANES {
        let z = 1.0 / inverse_depth[k];
        let away = eye.away(x[k], y[k]);
        let length = away.length();
        points.place.set(k, eye.position + away * z);
        points.to_eye.set(k, -(away * (1.0 / length)));
        points.distance_m[k] = z * length;
        along_u.set(k, along_u.at(k).unit());
        along_v.set(k, along_v.at(k).unit());
        u[k] += (s[k] * z).clamp(0.0, 1.0) * wide[k];
        v[k] += (t[k] * z).clamp(0.0, 1.0) * tall[k];
    }
    // Nothing but looking up: the machine waits for several texels at once.
    let mut texels = Octets::ZERO;
    for (k, sample) in samples.iter().enumerate() {
        let &Prepared { facet, level, .. } = &prepared[sample.index as usize];
        texels.set(k, textures().of(facet.texture).at(u[k], v[k], u32::from(level)).bits());
    }
    for (k, sample) in samples.iter().enumerate() {
        let facet = prepared[sample.index as usize].facet;
        points.albedo.set(k, facet.tint);
        points.normal.set(k, facet.normal);
        points.open[k] = f32::from(facet.open) * UNIT;
        points.through[k] = if facet.flags & LEAFY != 0 { UNIT } else { 0.0 };
    }
    for k in 0..LANES {
        let root = |channel: usize| texels.at(channel, k) * UNIT;
        let (r, g, b) = (root(0), root(1), root(2));
        points.albedo.set(k, v3(r * r, g * g, b * b).times(points.albedo.at(k)));
        let tilt = |channel: usize| (texels.at(channel, k) - 128.0) * (1.0 / 127.0);
        let (tilt_u, tilt_v) = (along_u.at(k) * tilt(4), along_v.at(k) * tilt(5));
        points.normal.set(k, points.normal.at(k) + tilt_u + tilt_v);
        points.through[k] *= texels.at(6, k);
        points.gloss[k] = texels.at(7, k) * UNIT;
    }
}

/// Sets `points` to what the samples of the ground show.
#[inline(always)]
pub fn ground_points(stage: &Stage, eye: &Eye, samples: &[OnGround], points: &mut Points) {
    let mut footprint = [1.0; LANES];
    for (k, sample) in samples.iter().enumerate() {
        points.place.set(k, sample.place);
        points.to_eye.set(k, -sample.d);
        points.normal.set(k, sample.normal);
        points.distance_m[k] = sample.distance_m;
        footprint[k] = sample.footprint;
    }
    surface(&stage.world.terrain, textures(), eye, points, &footprint, samples.len());
}
