//! Textures, painted once per process from fixed seeds: leaves, grass, bark, stones, ground. Albedo is stored as its
//! square root.

pub mod canvas;
pub mod cards;
pub mod set;
pub mod soil;
pub mod surfaces;
pub mod tiles;

use crate::vector::whole;

/// One point of a texture.
#[derive(Debug, Clone, Copy, PartialEq)]
#[repr(C)]
pub struct Texel {
    /// Square roots of the albedo, red green blue, 255 for 1.
    pub rgb: [u8; 3],
    /// Coverage; a point is there from 110 on.
    pub alpha: u8,
    /// Slope of the surface along u and v, 128 for none, 255 for 1.
    pub slope: [u8; 2],
    /// How much light passes through, 255 for all; on the ground: the height.
    pub through: u8,
    /// Shine, 255 for a glossy leaf.
    pub gloss: u8,
}

impl Default for Texel {
    fn default() -> Self {
        Self { rgb: [0; 3], alpha: 0, slope: [128; 2], through: 0, gloss: 0 }
    }
}

impl Texel {
    /// A slope from -1 to 1 as it is stored.
    pub fn stored_slope(slope: f32) -> u8 {
        (slope.clamp(-1.0, 1.0) * 127.0 + 128.5) as u8
    }

    /// All eight bytes in their order, the first one lowest.
    #[inline(always)]
    pub fn bits(&self) -> u64 {
        let Texel { rgb: [r, g, b], alpha, slope: [su, sv], through, gloss } = *self;
        u64::from_le_bytes([r, g, b, alpha, su, sv, through, gloss])
    }
}

/// The coverage from which a texel is opaque.
pub const OPAQUE: u8 = 110;

/// A square texture with its mip levels; level 0 has `1 << log2` columns.
#[derive(Debug, Clone)]
pub struct Texture {
    log2: u32,
    levels: Vec<Vec<Texel>>,
    coverage: Vec<Vec<u8>>,
    solid: bool,
}

impl Texture {
    /// The texture of `1 << log2` rows and columns and all its coarser levels.
    pub fn new(log2: u32, finest: Vec<Texel>) -> Self {
        let solid = finest.iter().all(|texel| texel.alpha >= OPAQUE);
        let mut levels = vec![finest];
        for level in (0..log2).rev() {
            let coarser = halve(&levels[levels.len() - 1], 1 << level);
            levels.push(coarser);
        }
        let coverage = levels.iter().map(|level| level.iter().map(|texel| texel.alpha).collect()).collect();
        let levels = levels.iter().enumerate().map(|(level, texels)| in_tiles(texels, log2 - level as u32)).collect();
        Self { log2, levels, coverage, solid }
    }

    /// Whether no texel is see-through.
    pub fn solid(&self) -> bool {
        self.solid
    }

    /// log2 of the columns of level 0.
    pub fn log2(&self) -> u32 {
        self.log2
    }

    /// The coverage of a mip level row by row, and log2 of its columns.
    #[inline(always)]
    pub fn coverage(&self, level: u32) -> (&[u8], u32) {
        let level = level.min(self.log2);
        (&self.coverage[level as usize], self.log2 - level)
    }

    /// The texel at (u, v), which repeat every 1, on a mip level; levels beyond the coarsest mean the coarsest.
    #[inline(always)]
    pub fn at(&self, u: f32, v: f32, level: u32) -> &Texel {
        let level = level.min(self.log2);
        let log2 = self.log2 - level;
        let size = 1_u32 << log2;
        let (x, y) = (whole(u * size as f32) & (size - 1), whole(v * size as f32) & (size - 1));
        &self.levels[level as usize][tiled(x as usize, y as usize, log2)]
    }
}

/// Where the texel (x, y) of a level of `1 << log2` columns is kept: in tiles of 8x8, lines of the cache holding 4x2,
/// because views run across textures in all directions.
#[inline(always)]
fn tiled(x: usize, y: usize, log2: u32) -> usize {
    if log2 < 3 {
        return (y << log2) + x;
    }
    let tile = ((y >> 3) << (log2 - 3)) + (x >> 3);
    (tile << 6) + ((y & 6) << 3) + ((x & 4) << 1) + ((y & 1) << 2) + (x & 3)
}

fn in_tiles(rows: &[Texel], log2: u32) -> Vec<Texel> {
    let mut tiles = vec![Texel::default(); rows.len()];
    for (i, texel) in rows.iter().enumerate() {
        tiles[tiled(i & ((1 << log2) - 1), i >> log2, log2)] = *texel;
    }
    tiles
}

/// Half the rows and columns: colours weighted by coverage, coverage kept up so that foliage does not thin out with
/// distance.
fn halve(finer: &[Texel], size: usize) -> Vec<Texel> {
    let one = |i: usize| {
        let (x, y) = (2 * (i % size), 2 * (i / size));
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| finer[(y + dy) * 2 * size + x + dx]);
        let weights = four.map(|texel| u32::from(texel.alpha) + 1);
        let total: u32 = weights.iter().sum();
        let mean = |value: fn(&Texel) -> i32| {
            let sum: i32 = four.iter().zip(weights).map(|(texel, weight)| value(texel) * weight as i32).sum();
            (sum as f32 / total as f32).round() as i32
        };
        let alpha = (f32::from((total - 4) as u16) / 4.0 * 1.12).min(255.0) as u8;
        Texel {
            rgb: [
                mean(|t| i32::from(t.rgb[0])) as u8,
                mean(|t| i32::from(t.rgb[1])) as u8,
                mean(|t| i32::from(t.rgb[2])) as u8,
            ],
            alpha,
            slope: [mean(|t| i32::from(t.slope[0])) as u8, mean(|t| i32::from(t.slope[1])) as u8],
            through: mean(|t| i32::from(t.through)) as u8,
            gloss: mean(|t| i32::from(t.gloss)) as u8,
        }
    };
    (0..size * size).map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_texel_is_found_at_its_place_and_repeats() {
        let texel = |i: usize| Texel { rgb: [(i % 8) as u8, (i / 8) as u8, 0], alpha: 255, ..Texel::default() };
        let texture = Texture::new(3, (0..64).map(texel).collect());
        for y in 0..8_u8 {
            for x in 0..8_u8 {
                let (u, v) = ((f32::from(x) + 0.5) / 8.0, (f32::from(y) + 0.5) / 8.0);
                assert_eq!(texture.at(u, v, 0).rgb, [x, y, 0]);
                assert_eq!(texture.at(u - 1.0, v + 3.0, 0).rgb, [x, y, 0]);
            }
        }
        assert_eq!(texture.at(0.9, 0.1, 9).rgb, [4, 4, 0], "the coarsest level is the mean, rounded level by level");
    }
}
