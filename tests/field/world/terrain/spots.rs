//! The ground at many places at once.

use super::{BEND_M, CELL_M, PARTS, Terrain, bend, part};
use crate::lanes::{LANES, Lanes, Octets, Vectors};
use crate::vector::whole;

/// The ground at as many places as are worked on at once.
pub struct Spots {
    /// Shares of gravel, grass, mulch and tar.
    pub shares: [Lanes; 4],
    /// Brightness, about 1.
    pub tint: Lanes,
    /// Share of the sky's light that arrives.
    pub open: Lanes,
    /// Which part of the soils' textures is shown, from 0 to 27.
    pub part: Lanes,
    /// How far the soils' textures are pulled aside, in metres.
    pub bend_m: Lanes,
}

impl Terrain {
    /// The soil at the first `count` places, blended between cells; no soil at the others.
    #[inline(always)]
    pub fn spots(&self, places: &Vectors, count: usize) -> Spots {
        let zero = [0.0; LANES];
        let (mut fx, mut fy, mut inside, mut first) = (zero, zero, zero, [0_u32; LANES]);
        let (wide, tall, columns) = ((self.columns - 1) as f32, (self.rows - 1) as f32, self.columns as u32);
        for k in 0..LANES {
            let (u, v) = ((places.x[k] - self.low[0]) / CELL_M, (places.y[k] - self.low[1]) / CELL_M);
            let within = (u >= 0.0) & (v >= 0.0) & (u < wide) & (v < tall);
            let (u, v) = if within { (u, v) } else { (0.0, 0.0) };
            (fx[k], fy[k]) = (u - u.floor(), v - v.floor());
            inside[k] = if within { 1.0 } else { 0.0 };
            first[k] = whole(v) * columns + whole(u);
        }
        let mut corners = [Octets::ZERO, Octets::ZERO, Octets::ZERO, Octets::ZERO];
        for k in 0..count {
            let i = first[k] as usize;
            let below = i + self.columns;
            let four = if inside[k] > 0.0 {
                [i, i + 1, below, below + 1].map(|i| self.cells[i].bits())
            } else {
                [self.outside.bits(); 4]
            };
            four.into_iter().zip(&mut corners).for_each(|(cell, corner)| corner.set(k, cell));
        }
        let mut weights = [zero; 4];
        for k in 0..LANES {
            let (x, y) = (fx[k], fy[k]);
            (weights[0][k], weights[1][k]) = ((1.0 - x) * (1.0 - y), x * (1.0 - y));
            (weights[2][k], weights[3][k]) = ((1.0 - x) * y, x * y);
        }
        let blended = |byte: usize, unit: f32| {
            let mut blended = [0.0; LANES];
            for (k, blended) in blended.iter_mut().enumerate() {
                let corner = |corner: usize| corners[corner].at(byte, k) * weights[corner][k];
                *blended = (corner(0) + corner(1) + corner(2) + corner(3)) * unit;
            }
            blended
        };
        let byte = 1.0 / 255.0;
        let mut spots = Spots {
            shares: [blended(0, byte), blended(1, byte), blended(2, byte), blended(3, byte)],
            tint: blended(4, 1.0 / 128.0),
            open: blended(5, byte),
            part: blended(6, 1.0 / PARTS),
            bend_m: blended(7, BEND_M / 255.0),
        };
        for k in (0..count).filter(|&k| inside[k] == 0.0) {
            spots.part[k] = part(places.x[k], places.y[k]);
            spots.bend_m[k] = bend(places.x[k], places.y[k]) * BEND_M;
        }
        spots
    }
}
