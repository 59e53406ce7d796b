//! The look of the ground: four soils blended by their heights, textures that never repeat in the same way.

use super::eye::Eye;
use super::light::Points;
use crate::lanes::{LANES, Lanes};
use crate::texture::set::Textures;
use crate::texture::soil::REPEAT_M;
use crate::texture::tiles::Tiles;
use crate::vector::v3;
use crate::world::terrain::{Spots, Terrain};

/// Texels per metre at the finest level.
const PER_M: f32 = 512.0 / REPEAT_M;
/// A soil with less than this share is not seen.
const LEAST_SHARE: f32 = 0.08;

/// Sets albedo, normal and openness of the first `count` points, which lie on the ground at their places and have its
/// normal already; `footprint` is the width of their pixels in fine ones.
#[inline(always)]
pub fn surface(
    terrain: &Terrain,
    textures: &Textures,
    eye: &Eye,
    points: &mut Points,
    footprint: &Lanes,
    count: usize,
) {
    let spots = terrain.spots(&points.place, count);
    let looks = Looks::of(eye, points, footprint);
    let mut sums = Sums::default();
    for tap in 0..2 {
        for (soil, texture) in textures.soils.iter().enumerate() {
            let mut share = [0.0; LANES];
            for (k, share) in share.iter_mut().enumerate() {
                let seen = (spots.shares[soil][k] >= LEAST_SHARE) & (tap == 0 || looks.taps[k] > 1.0);
                *share = if seen { spots.shares[soil][k] } else { 0.0 };
            }
            if share.iter().any(|&share| share > 0.0) {
                sums.add(texture, &share, &looks.taken(points, &spots, tap), soil == GRASS);
            }
        }
    }
    for k in 0..LANES {
        let scale = 1.0 / sums.weight[k].max(1e-6);
        let square = scale * spots.tint[k] * (1.0 / (255.0 * 255.0));
        points.albedo.set(k, v3(sums.squares[0][k], sums.squares[1][k], sums.squares[2][k]) * square);
        let slope = v3(sums.slope[0][k], sums.slope[1][k], 0.0) * (scale * (1.0 / 127.0));
        points.normal.set(k, points.normal.at(k) + slope);
        points.open[k] = spots.open[k];
        points.through[k] = sums.through[k] * scale;
        points.gloss[k] = 0.0;
    }
}

/// The number of the soil whose blades let light through.
const GRASS: usize = 1;

/// How the points are looked at.
struct Looks {
    /// A pixel's footprint is longer along the view than across it: two taps along it where it is much longer.
    taps: Lanes,
    /// From one tap to the next, metres east and north.
    stride: [Lanes; 2],
    level: [u32; LANES],
}

impl Looks {
    #[inline(always)]
    fn of(eye: &Eye, points: &Points, footprint: &Lanes) -> Looks {
        let zero = [0.0; LANES];
        let mut looks = Looks { taps: zero, stride: [zero; 2], level: [0; LANES] };
        for (k, footprint) in footprint.iter().enumerate() {
            let distance_m = points.distance_m[k];
            let across = footprint * distance_m / eye.focal * PER_M;
            let steep = (distance_m / (eye.position.z - points.place.z[k]).max(0.2)).max(1.0);
            let taps = if steep < 2.5 { 1.0 } else { 2.0 };
            looks.taps[k] = taps;
            looks.level[k] = level_of(across * (steep / taps).sqrt().max(1.0));
            let (x, y) = (points.place.x[k] - eye.position.x, points.place.y[k] - eye.position.y);
            let stride = across * steep / PER_M / taps / (x * x + y * y).sqrt().max(1e-3);
            (looks.stride[0][k], looks.stride[1][k]) = (x * stride, y * stride);
        }
        looks
    }

    /// Where a tap is taken.
    #[inline(always)]
    fn taken(&self, points: &Points, spots: &Spots, tap: usize) -> Taken {
        let zero = [0.0; LANES];
        let mut taken = Taken { x: zero, y: zero, which: zero, mix: zero, level: self.level };
        for k in 0..LANES {
            let back = tap as f32 - 0.5 * (self.taps[k] - 1.0);
            let bend_m = spots.bend_m[k];
            taken.x[k] = (points.place.x[k] + self.stride[0][k] * back + bend_m) * (1.0 / REPEAT_M);
            taken.y[k] = (points.place.y[k] + self.stride[1][k] * back - 0.7 * bend_m) * (1.0 / REPEAT_M);
            // Two places of the texture are blended where one patch of ground gives way to the next.
            let part = spots.part[k].floor();
            let mix = ((spots.part[k] - part - 0.42) * (1.0 / 0.16)).max(0.0);
            (taken.which[k], taken.mix[k]) = if mix < 1.0 { (part, mix) } else { (part + 1.0, 0.0) };
        }
        taken
    }
}

/// Places in the soils' textures.
struct Taken {
    /// Repeats of the texture east and north.
    x: Lanes,
    y: Lanes,
    /// Which shift of the texture is shown, and how much of the next one.
    which: Lanes,
    mix: Lanes,
    level: [u32; LANES],
}

impl Taken {
    /// Red, green, blue, slopes east and north as they are stored, and the height from 0 to 1, in the shift `next`
    /// after the first.
    #[inline(always)]
    fn texels(&self, texture: &Tiles, next: f32) -> [Lanes; 6] {
        let mut texels = [[0.0; LANES]; 6];
        let (mut u, mut v, mut swapped) = ([0.0; LANES], [0.0; LANES], [0.0; LANES]);
        let (mut cosine, mut sine) = ([0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            let which = self.which[k] + next;
            let shift = which * 0.377;
            let (x, y) = (self.x[k] + shift, self.y[k] + shift * 1.7);
            // Each shift is turned by an angle of its own, up to 77 degrees: by the tangent of its half.
            let share = which * 0.618;
            let tangent = (share - share.floor()) * 1.6 - 0.8;
            let scale = 1.0 / (1.0 + tangent * tangent);
            (cosine[k], sine[k]) = ((1.0 - tangent * tangent) * scale, 2.0 * tangent * scale);
            let (x, y) = (cosine[k] * x - sine[k] * y, sine[k] * x + cosine[k] * y);
            // Every other shift is mirrored.
            let even = which * 0.5 == (which * 0.5).floor();
            (u[k], v[k]) = if even { (x, y) } else { (y, x) };
            swapped[k] = if even { 0.0 } else { 1.0 };
        }
        let found = texture.at(&u, &v, &self.level);
        for k in 0..LANES {
            let (along, across) = (found.at(4, k) - 128.0, found.at(5, k) - 128.0);
            let (along, across) = if swapped[k] > 0.0 { (across, along) } else { (along, across) };
            let (east, north) = (cosine[k] * along + sine[k] * across, cosine[k] * across - sine[k] * along);
            (texels[0][k], texels[1][k], texels[2][k]) = (found.at(0, k), found.at(1, k), found.at(2, k));
            (texels[3][k], texels[4][k], texels[5][k]) = (east, north, found.at(6, k) * (1.0 / 255.0));
        }
        texels
    }
}

/// Weighted sums over soils and taps.
struct Sums {
    squares: [Lanes; 3],
    slope: [Lanes; 2],
    through: Lanes,
    weight: Lanes,
}

impl Default for Sums {
    fn default() -> Sums {
        let zero = [0.0; LANES];
        Sums { squares: [zero; 3], slope: [zero; 2], through: zero, weight: zero }
    }
}

impl Sums {
    /// Adds a soil at one tap.
    #[inline(always)]
    fn add(&mut self, texture: &Tiles, share: &Lanes, taken: &Taken, through: bool) {
        let mut texels = taken.texels(texture, 0.0);
        if (0..LANES).any(|k| share[k] > 0.0 && taken.mix[k] > 0.0) {
            let next = taken.texels(texture, 1.0);
            for (texels, next) in texels.iter_mut().zip(&next) {
                for (k, texel) in texels.iter_mut().enumerate() {
                    *texel += (next[k] - *texel) * taken.mix[k];
                }
            }
        }
        for k in 0..LANES {
            // The higher soil covers the lower one, so that edges run round stones and blades.
            let height = 0.25 + texels[5][k];
            let weight = share[k] * share[k] * height * height * height;
            for (square, texel) in self.squares.iter_mut().zip(&texels) {
                square[k] += weight * texel[k] * texel[k];
            }
            self.slope[0][k] += weight * texels[3][k];
            self.slope[1][k] += weight * texels[4][k];
            self.through[k] += if through { weight * 0.35 } else { 0.0 };
            self.weight[k] += weight;
        }
    }
}

/// The whole part of the logarithm to base 2, which is the float's exponent; 0 below 1.
#[inline(always)]
fn level_of(texels_per_pixel: f32) -> u32 {
    let bits = (texels_per_pixel * 1.2).max(1.0).to_bits();
    (bits >> 23) - 127
}
