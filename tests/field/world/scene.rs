//! What stands in a world: textured facets, sorted into squares of the map.

use crate::chance::{Dice, derive, mix};
use crate::vector::{V3, v3};

/// The facet is a triangle (corner, corner + u, corner + v) instead of a parallelogram.
pub const TRIANGLE: u8 = 1;
/// The facet may be left out in the distance, the rest growing in its stead.
pub const THINS: u8 = 2;
/// The facet casts no shadow that would be seen.
pub const SHADOWLESS: u8 = 4;
/// Light passes through as through a leaf.
pub const LEAFY: u8 = 8;

/// A flat piece of the world.
#[derive(Debug, Clone, Copy)]
pub struct Facet {
    /// A corner.
    pub corner: V3,
    /// The edge along which the texture's u grows.
    pub u: V3,
    /// The edge along which v grows.
    pub v: V3,
    /// The direction that it faces for the light: of a leaf card, mostly that of the crown's surface.
    pub normal: V3,
    /// Texture coordinates: start and extent along u and v.
    pub uv: [f32; 4],
    /// Factor on the texture's albedo.
    pub tint: V3,
    /// Number of the texture.
    pub texture: u8,
    /// The flags above.
    pub flags: u8,
    /// Share of the sky's light that arrives; 255 for all.
    pub open: u8,
    /// How far wind moves it, in millimetres.
    pub sway_mm: u8,
    /// Decides at which distance it is left out.
    pub hash: u32,
}

impl Facet {
    /// A plain facet of a made thing.
    pub fn solid(corner: V3, u: V3, v: V3, texture: u8) -> Facet {
        Facet {
            corner,
            u,
            v,
            normal: u.cross(v).unit(),
            uv: [0.0, 0.0, 1.0, 1.0],
            tint: v3(1.0, 1.0, 1.0),
            texture,
            flags: 0,
            open: 255,
            sway_mm: 0,
            hash: 0,
        }
    }

    /// The centre.
    pub fn centre(&self) -> V3 {
        let share = if self.flags & TRIANGLE != 0 { 1.0 / 3.0 } else { 0.5 };
        self.corner + (self.u + self.v) * share
    }
}

/// The facets of a square of the map.
#[derive(Debug, Clone, Copy)]
pub struct Square {
    /// Centre of the ball round its facets.
    pub centre: V3,
    /// Radius of that ball.
    pub radius_m: f32,
    /// Its first facet.
    pub first: usize,
    /// Its number of facets.
    pub count: usize,
}

/// Facets while a world is being made.
#[derive(Debug, Clone, Default)]
pub struct Scene {
    /// All facets so far.
    pub facets: Vec<Facet>,
    seed: u64,
}

impl Scene {
    /// An empty scene of the world `seed`.
    pub fn new(seed: u64) -> Scene {
        Scene { facets: Vec::new(), seed }
    }

    /// The chance of the thing number `thing` among those of `kind`: the same however many others there are.
    pub fn dice(&self, kind: u64, thing: u64) -> Dice {
        Dice::of(derive(self.seed, kind), thing)
    }

    /// Adds a facet.
    pub fn add(&mut self, facet: Facet) {
        let hash = mix(self.facets.len() as u64 ^ self.seed) as u32;
        self.facets.push(Facet { hash, ..facet });
    }

    /// Sorts the facets into squares of 5 m, in a fixed order.
    pub fn into_squares(mut self) -> (Vec<Facet>, Vec<Square>) {
        const SIDE_M: f32 = 5.0;
        let key = |facet: &Facet| {
            let c = facet.centre();
            ((c.y / SIDE_M).floor() as i32, (c.x / SIDE_M).floor() as i32)
        };
        self.facets.sort_by_key(key);
        let mut squares = Vec::new();
        let mut first = 0;
        for group in self.facets.chunk_by(|a, b| key(a) == key(b)) {
            squares.push(ball(group, first));
            first += group.len();
        }
        (self.facets, squares)
    }
}

fn ball(group: &[Facet], first: usize) -> Square {
    let (mut low, mut high) = (v3(1e9, 1e9, 1e9), v3(-1e9, -1e9, -1e9));
    for facet in group {
        for p in [facet.corner, facet.corner + facet.u, facet.corner + facet.v, facet.corner + facet.u + facet.v] {
            low = v3(low.x.min(p.x), low.y.min(p.y), low.z.min(p.z));
            high = v3(high.x.max(p.x), high.y.max(p.y), high.z.max(p.z));
        }
    }
    // Thinned cards grow up to threefold, and wind moves them.
    Square { centre: (low + high) * 0.5, radius_m: (high - low).length() * 0.5 + 0.6, first, count: group.len() }
}
