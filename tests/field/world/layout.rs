//! Planting along a route: shared by the sites.

use crate::chance::Dice;
use crate::texture::set::{DRY_TUFT, GREEN_TUFT};
use crate::vector::{V3, v3};
use crate::world::litter::{fallen_leaf, stone, tuft, weed};
use crate::world::route::RouteLine;
use crate::world::scene::Scene;
use crate::world::terrain::Terrain;

/// The point of the ground at (x, y) of `p`.
pub fn on_ground(terrain: &Terrain, p: V3) -> V3 {
    v3(p.x, p.y, terrain.height_m(p.x, p.y))
}

/// Cuts away what hangs where the robot's cameras drive, as growers do for their tractors: a swaying branch that fills
/// both images moves a step by degrees.
pub fn keep_clear(scene: &mut Scene, route: &RouteLine, terrain: &Terrain) {
    const LANE_M: f32 = 0.65;
    const HEIGHTS_M: std::ops::Range<f32> = 0.5..1.1;
    let in_the_way =
        |p: V3| HEIGHTS_M.contains(&(p.z - terrain.height_m(p.x, p.y))) && route.distance_m(p.x, p.y) < LANE_M;
    let halves = [0.0, 0.5, 1.0];
    scene.facets.retain(|facet| {
        let at = |u: f32, v: f32| facet.corner + facet.u * u + facet.v * v;
        !halves.iter().any(|&u| halves.iter().any(|&v| in_the_way(at(u, v))))
    });
}

/// How thickly the floor of a stretch is covered: each per square metre where the ground is made for it.
#[derive(Debug, Clone, Copy)]
pub struct Floor {
    /// Tufts of grass, where grass or (a fifth) gravel or mulch lies.
    pub tufts: f32,
    /// Flat weeds.
    pub weeds: f32,
    /// Stones, on gravel.
    pub stones: f32,
    /// Fallen leaves, everywhere, thickest on mulch.
    pub leaves: f32,
    /// Height of a tuft in metres, least and greatest.
    pub tuft_m: (f32, f32),
    /// Share of dry tufts.
    pub dry: f32,
}

/// Strews plants and litter over the band `across_m` (from, to) beside the route, on the soils that bear them.
/// Every metre has its own chance, so that a longer route does not change a shorter one's floor.
pub fn strew(
    scene: &mut Scene,
    route: &RouteLine,
    terrain: &Terrain,
    across_m: (f32, f32),
    reach_m: (f32, f32),
    floor: &Floor,
    kind: u64,
) {
    let width = across_m.1 - across_m.0;
    for metre in reach_m.0.floor() as i64..reach_m.1.ceil() as i64 {
        let mut dice = scene.dice(kind, metre as u64);
        let spot = |dice: &mut Dice| {
            let p = route.place(metre as f32 + dice.unit(), dice.within(across_m.0, across_m.1));
            (on_ground(terrain, p), terrain.shares(p.x, p.y))
        };
        for _ in 0..count(&mut dice, floor.tufts * width) {
            let (at, [gravel, grass, mulch, _]) = spot(&mut dice);
            if dice.chance(grass + 0.10 * (gravel + mulch)) {
                let look = if dice.chance(floor.dry) { DRY_TUFT } else { GREEN_TUFT };
                let bare = 1.0 - 0.35 * gravel;
                let size_m = dice.within(floor.tuft_m.0, floor.tuft_m.1) * bare;
                tuft(scene, &mut dice, look, at, size_m);
            }
        }
        for _ in 0..count(&mut dice, floor.weeds * width) {
            let (at, [gravel, grass, mulch, _]) = spot(&mut dice);
            if dice.chance(0.7 * grass + 0.25 * gravel + 0.3 * mulch) {
                let size_m = dice.within(0.12, 0.34);
                weed(scene, &mut dice, at, size_m);
            }
        }
        for _ in 0..count(&mut dice, floor.stones * width) {
            let (at, [gravel, _, mulch, tar]) = spot(&mut dice);
            if dice.chance(gravel + 0.2 * mulch + 0.12 * tar) {
                let size_m = 0.025 + 0.15 * dice.unit() * dice.unit() * dice.unit() * dice.unit();
                stone(scene, &mut dice, at, size_m);
            }
        }
        for _ in 0..count(&mut dice, floor.leaves * width) {
            let (at, [gravel, grass, mulch, tar]) = spot(&mut dice);
            if dice.chance(0.5 * gravel + 0.35 * grass + mulch + 0.4 * tar) {
                fallen_leaf(scene, &mut dice, at);
            }
        }
    }
}

/// A random integer with this mean.
fn count(dice: &mut Dice, mean: f32) -> usize {
    (mean + dice.unit()).floor().max(0.0) as usize
}
