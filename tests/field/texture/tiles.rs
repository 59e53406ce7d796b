//! A texture as many of its points are looked up at once: all levels in one piece, lines of the cache unbroken.

use super::{Texel, Texture};
use crate::lanes::{LANES, Lanes, Octets};
use crate::vector::whole;

/// log2 of the columns of the coarsest level that is kept: one tile.
const COARSEST: u32 = 3;

/// A line of the cache: 4 by 2 texels.
#[repr(align(64))]
#[derive(Debug, Clone, Copy)]
struct Line([u64; 8]);

/// A square texture of at least eight texels a side that covers all.
#[derive(Debug, Clone)]
pub struct Tiles {
    log2: u32,
    /// The coarsest level first.
    lines: Vec<Line>,
}

impl Tiles {
    /// The levels of `texture`.
    pub fn of(texture: &Texture) -> Tiles {
        let kept = &texture.levels[..=(texture.log2 - COARSEST) as usize];
        let line = |texels: &[Texel]| Line(std::array::from_fn(|k| texels[k].bits()));
        Tiles {
            log2: texture.log2,
            lines: kept.iter().rev().flat_map(|level| level.chunks_exact(8).map(line)).collect(),
        }
    }

    /// The texels at (u, v), which repeat every 1, each on its own level.
    #[inline(always)]
    pub fn at(&self, u: &Lanes, v: &Lanes, level: &[u32; LANES]) -> Octets {
        let mut places = [0_u32; LANES];
        for k in 0..LANES {
            let log2 = self.log2 - level[k].min(self.log2 - COARSEST);
            let size = 1_u32 << log2;
            let columns = size as i32 as f32;
            let (x, y) = (whole(u[k] * columns) & (size - 1), whole(v[k] * columns) & (size - 1));
            let tile = ((y >> 3) << (log2 - 3)) + (x >> 3);
            // Coarser levels have 4^3 + 4^4 + .. texels.
            let before = (0x5555_5555 & (size * size - 1)) - 21;
            places[k] = before + (tile << 6) + ((y & 6) << 3) + ((x & 4) << 1) + ((y & 1) << 2) + (x & 3);
        }
        let mut found = Octets::ZERO;
        for (k, place) in places.into_iter().enumerate() {
            let Line(texels) = &self.lines[place as usize >> 3];
            found.set(k, texels[place as usize & 7]);
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_levels_are_found_where_the_texture_has_them() {
        let texel = |i: usize| Texel { rgb: [(i % 32) as u8, (i / 32) as u8, 7], alpha: 255, ..Texel::default() };
        let texture = Texture::new(5, (0..32 * 32).map(texel).collect());
        let tiles = Tiles::of(&texture);
        let u: Lanes = std::array::from_fn(|k| k as f32 * 0.173 - 4.0);
        let v: Lanes = std::array::from_fn(|k| k as f32 * 0.291 - 7.0);
        for level in 0..5 {
            let found = tiles.at(&u, &v, &[level; LANES]);
            for k in 0..LANES {
                let expected = texture.at(u[k], v[k], level.min(2));
                assert_eq!(
                    [0, 1, 3].map(|byte| found.at(byte, k) as u8),
                    [expected.rgb[0], expected.rgb[1], expected.alpha]
                );
            }
        }
    }
}
