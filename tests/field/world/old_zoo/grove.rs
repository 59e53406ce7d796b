//! What grows in the zoo: trees over the path, shrubs beside it, and the wood round it that closes the view. A line of
//! sight that ends at the sky shows the same outline at every hour; one that ends in leaves shows sun and shade, which
//! move on.

use super::tunnel::tunnel;
use crate::chance::{Dice, noise};
use crate::texture::set::{BROADLEAF_TWIG, CROWN_CLUMP, NEEDLE_TWIG};
use crate::vector::{V3, smoothstep};
use crate::world::layout::on_ground;
use crate::world::plants::{TreeKind, bush, thicket, tree};
use crate::world::route::RouteLine;
use crate::world::scene::Scene;
use crate::world::terrain::Terrain;

const PLANE: TreeKind = TreeKind {
    look: BROADLEAF_TWIG,
    bark: 0,
    height_m: 7.5,
    stem_m: 2.6,
    crown_m: 2.9,
    girth_m: 0.19,
    twigs: 330,
    twig_m: 0.62,
    far: false,
};
const PINE: TreeKind = TreeKind {
    look: NEEDLE_TWIG,
    bark: 1,
    height_m: 9.5,
    stem_m: 4.6,
    crown_m: 2.8,
    girth_m: 0.24,
    twigs: 240,
    twig_m: 0.8,
    far: false,
};
/// A tree some metres off the path, leafy from the ground on.
const BEHIND: TreeKind = TreeKind { look: CROWN_CLUMP, stem_m: 0.8, twigs: 110, twig_m: 1.4, far: true, ..PLANE };
/// A tree of the wood round the zoo.
const WOOD: TreeKind = TreeKind {
    look: CROWN_CLUMP,
    bark: 1,
    height_m: 13.0,
    stem_m: 2.0,
    crown_m: 3.4,
    girth_m: 0.3,
    twigs: 110,
    twig_m: 2.2,
    far: true,
};

/// Plants the zoo.
pub fn plant(scene: &mut Scene, route: &RouteLine, terrain: &Terrain, salt: u32) {
    let mut ground = Ground { scene, route, terrain };
    plant_trees(&mut ground, salt);
    plant_shrubs(&mut ground, salt);
    plant_wood(&mut ground);
}

/// Where it grows.
struct Ground<'a> {
    scene: &'a mut Scene,
    route: &'a RouteLine,
    terrain: &'a Terrain,
}

impl Ground<'_> {
    /// Visits both sides of the route every `every_m`, each place with a chance of its own, that of `kinds` on the
    /// right and on the left.
    fn along(&mut self, every_m: f32, kinds: [u64; 2], mut grow: impl FnMut(&mut Self, &mut Dice, u64, f32)) {
        for number in 0..(self.route.length_m() as f32 / every_m) as u64 {
            for (side, kind) in [-1.0, 1.0].into_iter().zip(kinds) {
                let mut dice = self.scene.dice(kind, number);
                grow(self, &mut dice, number, side);
            }
        }
    }

    /// Whether no part of the route is nearer to `p`.
    fn clear(&self, p: V3, metres: f32) -> bool {
        self.route.distance_m(p.x, p.y) >= metres
    }

    fn tree(&mut self, dice: &mut Dice, kind: &TreeKind, p: V3, clear_m: f32) {
        if self.clear(p, clear_m) {
            tree(self.scene, dice, kind, on_ground(self.terrain, p));
        }
    }

    fn bush(&mut self, dice: &mut Dice, p: V3, height_m: f32, radius_m: f32, twigs: usize, clear_m: f32) {
        if self.clear(p, clear_m) {
            bush(self.scene, dice, BROADLEAF_TWIG, on_ground(self.terrain, p), height_m, radius_m, twigs);
        }
    }
}

fn plant_trees(ground: &mut Ground, salt: u32) {
    const EVERY_M: f32 = 3.6;
    ground.along(EVERY_M, [302, 301], |ground, dice, number, side| {
        let along = number as f32 * EVERY_M + dice.within(-1.2, 1.2);
        if dice.chance(0.12 + 0.78 * tunnel(along, salt)) {
            let p = ground.route.place(along, side * dice.within(2.5, 3.9));
            ground.tree(dice, if pines(along, salt) { &PINE } else { &PLANE }, p, 2.2);
        }
        if dice.chance(0.95) {
            let p = ground.route.place(along, side * dice.within(7.0, 15.0));
            let kind = if dice.chance(0.3) { &PINE } else { &BEHIND };
            ground.tree(dice, kind, p, 4.5);
        }
    });
}

/// Pines stand together in stretches.
fn pines(along: f32, salt: u32) -> bool {
    noise(along / 31.0, 8.1, salt ^ 17) > 0.62
}

/// Undergrowth: a hedge beside the path that thins out here and there, and bushes behind it.
fn plant_shrubs(ground: &mut Ground, salt: u32) {
    const EVERY_M: f32 = 1.1;
    ground.along(EVERY_M, [312, 311], |ground, dice, number, side| {
        let along = number as f32 * EVERY_M;
        let hedge = smoothstep(0.36, 0.46, noise(along / 9.0, side * 5.0, salt ^ 23));
        if dice.chance(0.10 + 0.85 * hedge) {
            let p = ground.route.place(along + 0.2 * dice.normal(), side * (2.6 + 0.35 * dice.normal().abs()));
            let height = dice.within(0.7, 1.6);
            ground.bush(dice, p, height, 0.55 * height + 0.1, 75, 2.1);
        }
        if number % 2 == 0 && dice.chance(0.8) {
            let p = ground.route.place(along + 0.5 * dice.normal(), side * dice.within(4.6, 8.0));
            let height = dice.within(2.0, 3.4);
            ground.bush(dice, p, height, 0.5 * height + 0.2, 70, 4.0);
        }
    });
}

/// The wood round the zoo, and thickets at its edge.
fn plant_wood(ground: &mut Ground) {
    const THICKETS_M: f32 = 1.0;
    ground.along(THICKETS_M, [306, 305], |ground, dice, number, side| {
        let along = number as f32 * THICKETS_M + dice.within(-0.6, 0.6);
        let p = ground.route.place(along, side * dice.within(7.5, 11.0));
        let height = dice.within(2.0, 3.6);
        if ground.clear(p, 6.5) {
            thicket(ground.scene, dice, CROWN_CLUMP, on_ground(ground.terrain, p), height, 1.1, 22);
        }
    });
    const TREES_M: f32 = 3.2;
    ground.along(TREES_M, [304, 303], |ground, dice, number, side| {
        let along = number as f32 * TREES_M + dice.within(-1.2, 1.2);
        let p = ground.route.place(along, side * dice.within(13.0, 22.0));
        ground.tree(dice, &WOOD, p, 12.0);
    });
}
