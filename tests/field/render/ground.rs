//! The look of the ground: four soils blended by their heights, textures that never repeat in the same way.

use super::eye::Eye;
use crate::terrain::{Spot, Terrain};
use crate::texture::Texture;
use crate::texture::set::Textures;
use crate::texture::soil::REPEAT_M;
use crate::vector::{V3, v3};

/// The ground's albedo, its small slopes (east, north) and the share of the sky's light at a point.
pub struct Surface {
    /// Albedo.
    pub albedo: V3,
    /// Tilt of the normal, east and north.
    pub slope: (f32, f32),
    /// Share of the sky's light.
    pub open: f32,
    /// Light that passes through the blades.
    pub through: f32,
}

/// Texels per metre at the finest level.
const PER_M: f32 = 512.0 / REPEAT_M;

/// The surface at `p`, seen by `eye` over the distance `distance_m` by a pixel `footprint` fine ones wide.
#[inline(always)]
pub fn surface(terrain: &Terrain, textures: &Textures, eye: &Eye, p: V3, distance_m: f32, footprint: f32) -> Surface {
    let spot = terrain.soil(p.x, p.y);
    // A pixel's footprint is longer along the view than across it: two taps along it where it is much longer.
    let across = footprint * distance_m / eye.focal * PER_M;
    let steep = (distance_m / (eye.position.z - p.z).max(0.2)).max(1.0);
    let taps = if steep < 2.5 { 1 } else { 2 };
    let level = level_of(across * (steep / taps as f32).sqrt().max(1.0));
    let stride = across * steep / PER_M / taps as f32;
    let away = v3(p.x - eye.position.x, p.y - eye.position.y, 0.0).unit();
    let mut sum = Sum::default();
    for tap in 0..taps {
        let back = (tap as f32 - 0.5 * (taps - 1) as f32) * stride;
        let (x, y) = (p.x + away.x * back, p.y + away.y * back);
        blend(textures, &spot, x, y, level, &mut sum);
    }
    let scale = 1.0 / sum.weight.max(1e-6);
    let [r, g, b, ..] = sum.squares;
    Surface {
        albedo: v3(r, g, b) * (scale * spot.tint),
        slope: (sum.lanes[4] * scale, sum.lanes[5] * scale),
        open: spot.open,
        through: sum.through * scale,
    }
}

/// Weighted sums over soils and taps of the lanes of [`Texel::lanes`](crate::texture::Texel::lanes).
#[derive(Default)]
struct Sum {
    lanes: [f32; 8],
    squares: [f32; 8],
    through: f32,
    weight: f32,
}

/// Adds the soils at one tap.
#[inline(always)]
fn blend(textures: &Textures, spot: &Spot, x: f32, y: f32, level: u32, sum: &mut Sum) {
    let which = spot.part.floor();
    let between = spot.part - which;
    for (k, &share) in spot.shares.iter().enumerate() {
        if share < 0.08 {
            continue;
        }
        let mut texel = tap(&textures.soils[k], x, y, which as i32, level);
        // Two places of the texture are blended where one patch of ground gives way to the next.
        let mix = ((between - 0.42) / 0.16).clamp(0.0, 1.0);
        if mix > 0.0 {
            let next = tap(&textures.soils[k], x, y, which as i32 + 1, level);
            texel = std::array::from_fn(|i| texel[i] + (next[i] - texel[i]) * mix);
        }
        // The higher soil covers the lower one, so that edges run round stones and blades.
        let height = 0.25 + texel[6];
        let weight = share * share * height * height * height;
        for (i, value) in texel.into_iter().enumerate() {
            sum.lanes[i] += weight * value;
            sum.squares[i] += weight * value * value;
        }
        sum.through += if k == 1 { weight * 0.35 } else { 0.0 };
        sum.weight += weight;
    }
}

/// The lanes of a soil's texel, its height among them as `through`; `which` shifts and swaps the texture.
#[inline(always)]
fn tap(texture: &Texture, x: f32, y: f32, which: i32, level: u32) -> [f32; 8] {
    let shift = which as f32 * 0.377;
    let (u, v) = (x * (1.0 / REPEAT_M) + shift, y * (1.0 / REPEAT_M) + shift * 1.7);
    if which & 1 == 0 {
        return texture.at(u, v, level).lanes();
    }
    let mut lanes = texture.at(v, u, level).lanes();
    lanes.swap(4, 5);
    lanes
}

#[inline(always)]
fn level_of(texels_per_pixel: f32) -> u32 {
    // The exponent of the float is the whole part of its logarithm.
    let bits = (texels_per_pixel * 1.2).max(1.0).to_bits();
    (bits >> 23) - 127
}
