//! All textures, by the number that a facet carries.

use super::Texture;
use super::cards::{BLUEBERRY, BROADLEAF, CROWN, NECTARINE, NEEDLES, fallen_leaf, rosette, stone, tuft, twig};
use super::soil::{grass, gravel, mulch, tar};
use super::surfaces::{bark, bars, brick, iron, mesh, plaster, wood};
use super::tiles::Tiles;
use crate::chance::Dice;
use crate::vector::v3;
use std::sync::OnceLock;

/// Textures that stand for the same kind of thing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    first: u8,
    count: u8,
}

impl Look {
    /// One of them by chance.
    pub fn pick(self, dice: &mut Dice) -> u8 {
        self.first + dice.below(usize::from(self.count)) as u8
    }

    /// The first of them.
    pub fn first(self) -> u8 {
        self.first
    }
}

/// Twigs of a blueberry bush.
pub const BLUEBERRY_TWIG: Look = Look { first: 0, count: 5 };
/// Twigs of a nectarine tree.
pub const NECTARINE_TWIG: Look = Look { first: 5, count: 4 };
/// Twigs of a park tree.
pub const BROADLEAF_TWIG: Look = Look { first: 9, count: 4 };
/// Bundles of pine needles.
pub const NEEDLE_TWIG: Look = Look { first: 13, count: 2 };
/// Green tufts.
pub const GREEN_TUFT: Look = Look { first: 15, count: 5 };
/// Half dry tufts.
pub const DRY_TUFT: Look = Look { first: 20, count: 3 };
/// Flat weeds.
pub const ROSETTE: Look = Look { first: 23, count: 4 };
/// Leaves on the ground.
pub const FALLEN_LEAF: Look = Look { first: 27, count: 10 };
/// Stones on the ground.
pub const STONE: Look = Look { first: 37, count: 8 };
/// Bark, grey and brown.
pub const BARK: Look = Look { first: 45, count: 2 };
/// Weathered wood.
pub const WOOD: Look = Look { first: 47, count: 2 };
/// Brick wall.
pub const BRICK: Look = Look { first: 49, count: 1 };
/// Plaster, cream, ochre and whitewash.
pub const PLASTER: Look = Look { first: 50, count: 3 };
/// Iron bars of a cage.
pub const BARS: Look = Look { first: 53, count: 1 };
/// Wire mesh.
pub const MESH: Look = Look { first: 54, count: 1 };
/// Corrugated iron.
pub const IRON: Look = Look { first: 55, count: 1 };
/// Clumps of a park tree far off: many small leaves.
pub const CROWN_CLUMP: Look = Look { first: 56, count: 3 };
const COUNT: u8 = 59;
/// Not a texture: the ground, shaded from its place in the world.
pub const GROUND: u8 = 255;

/// Every texture.
pub struct Textures {
    facets: Vec<Texture>,
    /// Gravel, grass, mulch, tar.
    pub soils: [Tiles; 4],
}

impl Textures {
    /// The texture of a facet.
    #[inline(always)]
    pub fn of(&self, number: u8) -> &Texture {
        &self.facets[usize::from(number)]
    }
}

/// The textures, painted at the first call.
pub fn textures() -> &'static Textures {
    static PAINTED: OnceLock<Textures> = OnceLock::new();
    PAINTED.get_or_init(|| {
        // Threads of its own: a worker of a shared pool that waited in here could be handed a job that asks for the
        // textures again.
        std::thread::scope(|scope| {
            let soils = [(gravel as fn(u64) -> Texture, 1), (grass, 2), (mulch, 3), (tar, 4)];
            let soils = soils.map(|(paint, seed)| scope.spawn(move || Tiles::of(&paint(seed))));
            let facets = (0..COUNT).map(paint).collect();
            Textures {
                facets,
                soils: soils.map(|soil| soil.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))),
            }
        })
    })
}

fn paint(number: u8) -> Texture {
    let seed = 1000 + u64::from(number);
    let salt = seed as u32;
    match number {
        0..5 => twig(&BLUEBERRY, seed),
        5..9 => twig(&NECTARINE, seed),
        9..13 => twig(&BROADLEAF, seed),
        13..15 => twig(&NEEDLES, seed),
        15..20 => tuft(seed, 46, 0.16),
        20..23 => tuft(seed, 42, 0.65),
        23..27 => rosette(seed),
        27..37 => fallen_leaf(seed),
        37..45 => stone(seed),
        45 => bark(v3(0.21, 0.185, 0.16), salt),
        46 => bark(v3(0.17, 0.115, 0.075), salt),
        47..49 => wood(salt),
        49 => brick(salt),
        50 => plaster(v3(0.50, 0.45, 0.34), salt),
        51 => plaster(v3(0.45, 0.31, 0.18), salt),
        52 => plaster(v3(0.62, 0.61, 0.57), salt),
        53 => bars(seed),
        54 => mesh(),
        55 => iron(salt),
        _ => twig(&CROWN, seed),
    }
}
