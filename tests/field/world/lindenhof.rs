//! Lindenhof: 24 m of road, 110 m between two rows of nectarine trees that touch overhead, 23.8 m of road: 157.8 m.

use super::layout::{Floor, keep_clear, on_ground, strew};
use super::plan::{Net, Plan};
use crate::chance::{fractal, noise};
use crate::texture::set::{BLUEBERRY_TWIG, BROADLEAF_TWIG, CROWN_CLUMP, NECTARINE_TWIG, PLASTER};
use crate::vector::{smoothstep, v3};
use crate::world::plants::{TreeKind, bush, thicket, tree};
use crate::world::route::{Beside, RouteLine};
use crate::world::scene::Scene;
use crate::world::structures::{crate_box, hut, post, wall, wire};
use crate::world::terrain::{Soil, Terrain};

/// The stretches of the route (Church 2023, sections 7.2 and 7.4).
const ROAD_IN_M: f32 = 24.0;
const ROW_M: f32 = 110.0;
const ROAD_OUT_M: f32 = 23.8;
const VOCABULARY_ROW_M: f32 = 230.0;
/// Distance between rows of trees; the robot drives midway.
const SPACING_M: f32 = 4.0;
const TREE_M: f32 = 1.6;

/// The orchard: `longer` for the vocabulary route's own rows.
pub fn plan(seed: u64, longer: bool) -> Plan {
    let row_end = ROAD_IN_M + if longer { VOCABULARY_ROW_M } else { ROW_M };
    let length = row_end + ROAD_OUT_M;
    // Rows run 70 degrees east of north.
    let heading = 70.0_f64.to_radians();
    let (sin, cos) = (libm::sin(heading), libm::cos(heading));
    let point = |along: f32, left: f64| [sin * f64::from(along) - cos * left, cos * f64::from(along) + sin * left];
    // The roads lead in and out with a gentle bend; the row is straight.
    let corners = [
        point(0.0, 2.2),
        point(0.5 * ROAD_IN_M, 0.7),
        point(ROAD_IN_M, 0.0),
        point(ROAD_IN_M + 12.0, 0.0),
        point(row_end - 12.0, 0.0),
        point(row_end, 0.0),
        point(row_end + 0.5 * ROAD_OUT_M, -0.7),
        point(length, -2.4),
    ];
    let route = RouteLine::through(&corners, false);
    let salt = seed as u32;
    let terrain = Terrain::build(&route, 18.0, |x, y, beside| soil(x, y, beside, row_end, salt));
    let mut scene = Scene::new(seed);
    for row in -3..3_i32 {
        plant_row(&mut scene, &route, &terrain, row, row_end);
    }
    let mown = Floor { tufts: 3.5, weeds: 1.6, stones: 1.5, leaves: 22.0, tuft_m: (0.07, 0.2), dry: 0.2 };
    strew(&mut scene, &route, &terrain, (-2.8, 2.8), (ROAD_IN_M, row_end), &mown, 20);
    let verge = Floor { tufts: 6.0, weeds: 1.5, stones: 9.0, leaves: 7.0, tuft_m: (0.12, 0.4), dry: 0.4 };
    strew(&mut scene, &route, &terrain, (-5.0, 5.0), (-4.0, ROAD_IN_M), &verge, 21);
    strew(&mut scene, &route, &terrain, (-5.0, 5.0), (row_end, length + 10.0), &verge, 22);
    windbreaks(&mut scene, &route, &terrain, row_end);
    hedges(&mut scene, &route, &terrain, (-2.0, ROAD_IN_M - 2.0), 323);
    hedges(&mut scene, &route, &terrain, (row_end + 2.0, length + 14.0), 325);
    surround(&mut scene, &route, &terrain, row_end, length);
    keep_clear(&mut scene, &route, &terrain);
    let net = Net {
        height_m: 4.5,
        along: v3(sin as f32, cos as f32, 0.0),
        reach_m: (ROAD_IN_M, row_end),
        half_width_m: 12.5,
    };
    Plan { route, terrain, scene, net: Some(net) }
}

fn soil(x: f32, y: f32, beside: Beside, row_end: f32, salt: u32) -> Soil {
    let (along, across) = (beside.along_m, beside.across_m);
    let wobble = 0.5 * (fractal(x * 0.9, y * 0.9, 3, salt) - 0.5);
    let orchard = smoothstep(ROAD_IN_M - 0.5, ROAD_IN_M + 0.8, along + wobble)
        * smoothstep(row_end + 0.5, row_end - 0.8, along + wobble);
    let in_row = (across + 0.5 * SPACING_M).rem_euclid(SPACING_M);
    let in_row = in_row.min(SPACING_M - in_row);
    let strip = smoothstep(0.75, 0.4, in_row + wobble) * orchard;
    let road = smoothstep(2.3, 1.9, across.abs() + wobble) * (1.0 - orchard);
    let rut = (smoothstep(0.3, 0.05, (across - 0.55).abs()) + smoothstep(0.3, 0.05, (across + 0.55).abs())).min(1.0);
    let patches = smoothstep(0.45, 0.62, fractal(x * 0.5 + 3.0, y * 0.5, 4, salt ^ 5));
    let gravel = 1.2 * road + 0.25 * orchard * (rut + patches) + 0.35 * (1.0 - orchard) * patches;
    let grass = (1.0 - road) * (1.1 - 0.45 * patches) * (1.0 - 0.85 * strip);
    let relief =
        0.09 * (fractal(x * 0.22, y * 0.22, 3, salt ^ 8) - 0.5) + 0.02 * (noise(x * 1.6, y * 1.6, salt ^ 2) - 0.5);
    Soil {
        height_m: relief + 0.08 * strip - 0.03 * rut,
        shares: [gravel, grass, 1.1 * strip + 0.25 * patches * orchard, 0.35 * road * (1.0 - patches)],
        tint: 0.72 + 0.56 * fractal(x * 0.8, y * 0.8, 4, salt ^ 3),
    }
}

fn plant_row(scene: &mut Scene, route: &RouteLine, terrain: &Terrain, row: i32, row_end: f32) {
    let across = (row as f32 + 0.5) * SPACING_M;
    let inner = across.abs() < SPACING_M;
    let kind = 100 + (row + 50) as u64;
    let nectarine = TreeKind {
        look: NECTARINE_TWIG,
        bark: 1,
        height_m: 3.9,
        stem_m: 0.8,
        crown_m: 2.75,
        girth_m: 0.085,
        twigs: if inner { 840 } else { 240 },
        twig_m: if inner { 0.48 } else { 0.66 },
        far: false,
    };
    for number in 0..((row_end - ROAD_IN_M) / TREE_M) as u64 {
        let mut dice = scene.dice(kind, number);
        if dice.chance(0.03) {
            continue;
        }
        let along = ROAD_IN_M + 0.8 + number as f32 * TREE_M + 0.12 * dice.normal();
        let p = route.place(along, across + 0.1 * dice.normal());
        tree(scene, &mut dice, &nectarine, on_ground(terrain, p));
    }
    for span in 0..((row_end - ROAD_IN_M) / 8.0) as u64 + 1 {
        let mut dice = scene.dice(kind + 1000, span);
        let at = |span: u64| {
            let along = ROAD_IN_M + 8.0 * span as f32 + 0.3 * scene.dice(kind + 2000, span).normal();
            on_ground(terrain, route.place(along.min(row_end), across))
        };
        let (here, next) = (at(span), at(span + 1));
        post(scene, &mut dice, here, 4.5, 0.07);
        if inner {
            let lift = v3(0.0, 0.0, 0.3);
            wire(scene, &mut dice, here + lift, next + lift, 0.011, 0.04, v3(0.1, 0.1, 0.1));
        }
    }
}

/// Tall hedges on both sides of the orchard: little light comes in under the crowns.
fn windbreaks(scene: &mut Scene, route: &RouteLine, terrain: &Terrain, row_end: f32) {
    for number in 0..((row_end - ROAD_IN_M) / 1.4) as u64 {
        for side in [-1.0_f32, 1.0] {
            let mut dice = scene.dice(if side > 0.0 { 321 } else { 322 }, number);
            let p = route.place(ROAD_IN_M + 1.4 * number as f32 + 0.2 * dice.normal(), side * 12.6);
            let height = dice.within(3.0, 3.8);
            bush(scene, &mut dice, BROADLEAF_TWIG, on_ground(terrain, p), height, 1.1, 80);
        }
    }
}

/// Tall hedges along both roads, as on farms in the wind of the Cape: what the robot sees there is sunlit leaves more
/// than skyline.
fn hedges(scene: &mut Scene, route: &RouteLine, terrain: &Terrain, (from, to): (f32, f32), kind: u64) {
    for number in 0..((to - from) / 0.9) as u64 {
        for side in [-1.0_f32, 1.0] {
            let mut dice = scene.dice(if side > 0.0 { kind } else { kind + 1 }, number);
            let along = from + 0.9 * number as f32 + 0.1 * dice.normal();
            let p = route.place(along, side * (4.5 + 0.2 * dice.normal()));
            let height = dice.within(3.8, 4.8);
            bush(scene, &mut dice, BLUEBERRY_TWIG, on_ground(terrain, p), height, 1.0, 150);
            // What grows at its feet hides the horizon, whose outline would be the same at every hour.
            let p = route.place(along, side * dice.within(5.6, 6.6));
            let height = dice.within(1.6, 2.6);
            thicket(scene, &mut dice, CROWN_CLUMP, on_ground(terrain, p), height, 0.7, 12);
        }
    }
}

/// The roads' sides: trees, a wall, a packing shed, crates.
fn surround(scene: &mut Scene, route: &RouteLine, terrain: &Terrain, row_end: f32, length: f32) {
    let kind = TreeKind {
        look: BROADLEAF_TWIG,
        bark: 0,
        height_m: 8.0,
        stem_m: 2.3,
        crown_m: 2.6,
        girth_m: 0.18,
        twigs: 300,
        twig_m: 0.72,
        far: false,
    };
    for number in 0..22_u64 {
        for side in [-1.0_f32, 1.0] {
            let mut dice = scene.dice(if side > 0.0 { 301 } else { 302 }, number);
            // Half of the trees stand along the way in, half along the way out.
            let start = if number < 11 { -14.0 } else { row_end + 3.0 };
            let along = start + (number % 11) as f32 * 3.8 + dice.normal();
            let p = route.place(along, side * dice.within(5.5, 17.0));
            if dice.chance(0.75) {
                tree(scene, &mut dice, &kind, on_ground(terrain, p));
            }
        }
    }
    for piece in 0..6 {
        let at = |k: i32| on_ground(terrain, route.place(3.0 + 2.0 * k as f32, 3.2));
        wall(scene, at(piece), at(piece + 1), 1.1, 0.22, PLASTER.first(), 2.4);
    }
    hut(scene, route.place(12.0, -9.5), 1.2, (7.0, 5.0, 3.0), PLASTER.first() + 1, 2.4);
    hut(scene, route.place(length - 6.0, 9.0), 0.4, (6.0, 4.0, 2.8), PLASTER.first(), 2.4);
    for number in 0..10_u64 {
        let mut dice = scene.dice(303, number);
        let along = if number < 5 { 4.0 + 4.0 * number as f32 } else { row_end + 2.0 + 4.0 * (number - 5) as f32 };
        let side = if dice.chance(0.5) { 1.0 } else { -1.0 };
        let p = on_ground(terrain, route.place(along, side * dice.within(2.4, 3.4)));
        for level in 0..1 + dice.below(4) {
            crate_box(scene, &mut dice, p + v3(0.0, 0.0, 0.27 * level as f32), (0.55, 0.36, 0.25));
        }
        post(scene, &mut dice, on_ground(terrain, route.place(along + 2.0, -side * 2.7)), 1.3, 0.06);
    }
}
