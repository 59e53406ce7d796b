//! The finished world: the site's plan, the few things that a traversal finds changed, light under leaves, the ground.

use super::layout::on_ground;
use super::litter::{fallen_leaf, weed};
use super::plan::{Net, Plan};
use super::route::RouteLine;
use super::scene::{Facet, LEAFY, SHADOWLESS, Square, TRIANGLE};
use super::terrain::{Canopy, RELIEF_M, Terrain};
use super::{backsburg, lindenhof, old_zoo};
use crate::chance::{Dice, derive};
use crate::texture::set::GROUND;
use crate::traversal::{Site, Traversal};
use crate::vector::v3;

/// Everything that can be seen, but the sky.
pub struct World {
    /// The line that the robot follows.
    pub route: RouteLine,
    /// The ground.
    pub terrain: Terrain,
    /// What stands on it.
    pub facets: Vec<Facet>,
    /// The facets' squares.
    pub squares: Vec<Square>,
    /// The net overhead, on a farm.
    pub net: Option<Net>,
    /// Seed of the hills on the horizon.
    pub horizon_seed: u32,
}

/// The world that `traversal` leads through.
pub fn build(traversal: &Traversal) -> World {
    let seed = traversal.world_seed();
    let longer = traversal.route == "vocabulary";
    let mut plan = match traversal.site {
        Site::Backsburg => backsburg::plan(seed, longer),
        Site::Lindenhof => lindenhof::plan(seed, longer),
        Site::OldZoo => old_zoo::plan(seed, longer),
    };
    let canopy = shelter(&mut plan);
    drop_litter(&mut plan, Dice::of(traversal.traversal_seed(), 3));
    grow_weeds(&mut plan, traversal.date.days_since_epoch());
    darken(&mut plan.scene.facets, &canopy);
    lay_ground(&mut plan);
    let (facets, squares) = plan.scene.into_squares();
    World {
        route: plan.route,
        terrain: plan.terrain,
        facets,
        squares,
        net: plan.net,
        horizon_seed: derive(seed, 9) as u32,
    }
}

/// Takes light from the ground by how many leaves stand above it; how many do where.
fn shelter(plan: &mut Plan) -> Canopy {
    let mut canopy = plan.terrain.canopy_grid();
    for facet in &plan.scene.facets {
        if facet.flags & LEAFY != 0 {
            canopy.add(facet.centre(), 0.45 * facet.u.length() * facet.v.length());
        }
    }
    canopy.spread();
    plan.terrain.shelter(&canopy);
    canopy
}

/// Takes light from what lies under leaves and from the inside of the crowns.
fn darken(facets: &mut [Facet], canopy: &Canopy) {
    facets.iter_mut().for_each(|facet| facet.open = (canopy.open(facet.centre()) * 255.0) as u8);
}

/// The leaves that lie elsewhere in every traversal: about two per metre.
fn drop_litter(plan: &mut Plan, mut dice: Dice) {
    let length = plan.route.length_m() as f32;
    for _ in 0..(2.0 * length) as usize {
        let spot = plan.route.place(dice.unit() * length, 1.6 * dice.normal());
        let at = on_ground(&plan.terrain, spot);
        fallen_leaf(&mut plan.scene, &mut dice, at);
    }
}

/// The weeds that come and go: each spot's grows for a month of its own, then is mown. The same all day, others in
/// another week.
fn grow_weeds(plan: &mut Plan, day: i64) {
    const MONTH_DAYS: i64 = 30;
    let length = plan.route.length_m() as f32;
    for spot in 0..(0.8 * length) as u64 {
        let mut dice = plan.scene.dice(77, spot);
        let age = (day + dice.below(MONTH_DAYS as usize) as i64).rem_euclid(MONTH_DAYS) as f32 / MONTH_DAYS as f32;
        let p =
            plan.route.place(dice.unit() * length, dice.within(0.5, 2.4) * if dice.chance(0.5) { 1.0 } else { -1.0 });
        let at = on_ground(&plan.terrain, p);
        weed(&mut plan.scene, &mut dice, at, 0.04 + 0.32 * age);
    }
}

/// Covers the ground within reach of the route with triangles.
fn lay_ground(plan: &mut Plan) {
    const SIDE_M: f32 = 0.5;
    let (low, high) = plan.route.extent(plan.route.length_m());
    let [c0, r0] = low.map(|v| ((v - RELIEF_M) / SIDE_M).floor() as i32);
    let [c1, r1] = high.map(|v| ((v + RELIEF_M) / SIDE_M).ceil() as i32);
    let terrain = &plan.terrain;
    let point = |c: i32, r: i32| {
        let (x, y) = (c as f32 * SIDE_M, r as f32 * SIDE_M);
        v3(x, y, terrain.height_m(x, y))
    };
    let mut triangles = Vec::new();
    for r in r0..r1 {
        for c in c0..c1 {
            let [a, b, d, e] = [point(c, r), point(c + 1, r), point(c, r + 1), point(c + 1, r + 1)];
            if [a, b, d, e].iter().any(|p| p.z != 0.0) {
                triangles.push((a, b - a, d - a));
                triangles.push((e, d - e, b - e));
            }
        }
    }
    for (corner, u, v) in triangles {
        let flags = TRIANGLE | SHADOWLESS;
        plan.scene.add(Facet { flags, ..Facet::solid(corner, u, v, GROUND) });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::V3;

    /// 25 points of each facet, against the space that the two cameras, 0.75 m high, may drive through.
    #[test]
    fn nothing_hangs_where_the_cameras_drive() {
        for site in Site::ALL {
            let world = build(&Traversal::new(site, "10:00".parse().unwrap()));
            let in_the_way = |p: V3| {
                (0.6..0.95).contains(&(p.z - world.terrain.height_m(p.x, p.y)))
                    && world.route.distance_m(p.x, p.y) < 0.5
            };
            let shares = [0.0, 0.25, 0.5, 0.75, 1.0];
            let hits = |facet: &&Facet| {
                let points = shares.into_iter().flat_map(|u| shares.map(|v| facet.corner + facet.u * u + facet.v * v));
                points.into_iter().any(in_the_way)
            };
            assert_eq!(world.facets.iter().filter(hits).count(), 0, "{site}");
        }
    }
}
