//! The look of the ground: four soils blended by their heights, textures that never repeat in the same way.

use super::prepare::Eye;
use crate::chance::noise;
use crate::terrain::Terrain;
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

/// The surface at `p`, seen by `eye` over the distance `distance_m`.
#[inline(always)]
pub fn surface(terrain: &Terrain, textures: &Textures, eye: &Eye, p: V3, distance_m: f32) -> Surface {
    let (shares, tint, open) = terrain.soil(p.x, p.y);
    // A pixel's footprint is longer along the view than across it: several taps along it, each as fine as the width.
    let across = distance_m / eye.focal * PER_M;
    let steep = (distance_m / (eye.position.z - p.z).max(0.2)).max(1.0);
    let taps = if steep < 2.0 {
        1
    } else if steep < 6.0 {
        2
    } else {
        3
    };
    let level = level_of(across * (steep / taps as f32).sqrt().max(1.0));
    let stride = across * steep / PER_M / taps as f32;
    let away = v3(p.x - eye.position.x, p.y - eye.position.y, 0.0).unit();
    let kind = noise(p.x * 0.43, p.y * 0.43, 77) * 7.0;
    let mut sum = [0.0_f32; 7];
    for tap in 0..taps {
        let back = (tap as f32 - 0.5 * (taps - 1) as f32) * stride;
        let (x, y) = (p.x + away.x * back, p.y + away.y * back);
        blend(textures, &shares, x, y, kind, level, &mut sum);
    }
    let scale = 1.0 / sum[6].max(1e-6);
    let albedo = v3(sum[0], sum[1], sum[2]) * (scale * tint);
    Surface { albedo, slope: (sum[3] * scale, sum[4] * scale), open, through: sum[5] * scale }
}

/// Adds the soils at one tap: red, green, blue, slopes, translucency, weight.
#[inline(always)]
fn blend(textures: &Textures, shares: &[f32; 4], x: f32, y: f32, kind: f32, level: u32, sum: &mut [f32; 7]) {
    let (which, between) = (kind.floor(), kind - kind.floor());
    for (k, &share) in shares.iter().enumerate() {
        if share < 0.08 {
            continue;
        }
        let one = tap(&textures.soils[k], x, y, which as i32, level);
        // Two places of the texture are blended where one patch of ground gives way to the next.
        let mix = ((between - 0.42) / 0.16).clamp(0.0, 1.0);
        let texel = if mix <= 0.0 {
            one
        } else {
            let two = tap(&textures.soils[k], x, y, which as i32 + 1, level);
            if mix >= 1.0 { two } else { std::array::from_fn(|i| one[i] + (two[i] - one[i]) * mix) }
        };
        // The higher soil covers the lower one, so that edges run round stones and blades.
        let height = 0.25 + texel[5];
        let weight = share * share * height * height * height;
        for i in 0..3 {
            sum[i] += weight * texel[i] * texel[i];
        }
        sum[3] += weight * texel[3];
        sum[4] += weight * texel[4];
        sum[5] += if k == 1 { weight * 0.35 } else { 0.0 };
        sum[6] += weight;
    }
}

/// Root albedo, slopes and height of a soil; `which` shifts and swaps the texture.
#[inline(always)]
fn tap(texture: &Texture, x: f32, y: f32, which: i32, level: u32) -> [f32; 6] {
    let shift = which as f32 * 0.377;
    let (u, v) = (x * (1.0 / REPEAT_M) + shift, y * (1.0 / REPEAT_M) + shift * 1.7);
    let swapped = which & 1 == 1;
    let texel = if swapped { texture.at(v, u, level) } else { texture.at(u, v, level) };
    let [a, b] = texel.slope.map(|s| f32::from(s) * (1.0 / 127.0));
    let slope = if swapped { (b, a) } else { (a, b) };
    let [r, g, bl] = texel.rgb.map(|c| f32::from(c) * (1.0 / 255.0));
    [r, g, bl, slope.0, slope.1, f32::from(texel.through) * (1.0 / 255.0)]
}

#[inline(always)]
fn level_of(texels_per_pixel: f32) -> u32 {
    // The exponent of the float is the whole part of its logarithm.
    let bits = (texels_per_pixel * 1.2).max(1.0).to_bits();
    (bits >> 23) - 127
}
