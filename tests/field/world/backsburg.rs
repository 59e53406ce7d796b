//! Backsburg: straight rows of blueberry bushes 3 m apart under a net, grass between, a gravel road at the end; 104.7
//! m.

use super::layout::{Floor, on_ground, strew};
use super::plan::{Net, Plan};
use crate::chance::{fractal, noise};
use crate::texture::set::{BLUEBERRY_TWIG, BROADLEAF_TWIG, WOOD};
use crate::vector::{V3, smoothstep, v3};
use crate::world::plants::{TreeKind, bush, tree};
use crate::world::route::{Beside, RouteLine};
use crate::world::scene::Scene;
use crate::world::structures::{crate_box, hut, post, wire};
use crate::world::terrain::{Soil, Terrain};

/// Length of the route of the thesis (Church 2023, sections 7.2 and 7.4).
const LENGTH_M: f64 = 104.7;
const VOCABULARY_M: f64 = 260.0;
/// The robot drives between the rows at +-1.5 m.
const ROW_M: f32 = 3.0;
const BUSH_M: f32 = 0.9;
/// Rows end here before the end of the route; the road follows.
const ROAD_M: f32 = 3.0;

/// The farm: `longer` for the vocabulary route's own field.
pub fn plan(seed: u64, longer: bool) -> Plan {
    let length = if longer { VOCABULARY_M } else { LENGTH_M };
    // Rows run 25 degrees east of north: the sun crosses them from one side to the other during the day.
    let heading = 25.0_f64.to_radians();
    let end = [libm::sin(heading) * length, libm::cos(heading) * length];
    let route = RouteLine::through(&[[0.0, 0.0], end], false);
    let salt = seed as u32;
    let rows_end = length as f32 - ROAD_M;
    let terrain = Terrain::build(&route, 16.0, |x, y, beside| soil(x, y, beside, rows_end, salt));
    let mut scene = Scene::new(seed);
    for row in -4..4_i32 {
        plant_row(&mut scene, &route, &terrain, row, rows_end);
    }
    let floor = Floor { tufts: 9.0, weeds: 2.2, stones: 7.0, leaves: 16.0, tuft_m: (0.10, 0.34), dry: 0.22 };
    strew(&mut scene, &route, &terrain, (-2.6, 2.6), (-3.0, length as f32 + 6.0), &floor, 20);
    let beyond = Floor { tufts: 3.0, weeds: 0.4, stones: 0.5, leaves: 2.0, tuft_m: (0.15, 0.4), dry: 0.25 };
    strew(&mut scene, &route, &terrain, (2.6, 9.0), (-3.0, length as f32 + 14.0), &beyond, 21);
    strew(&mut scene, &route, &terrain, (-9.0, -2.6), (-3.0, length as f32 + 14.0), &beyond, 22);
    surround(&mut scene, &route, length as f32);
    let along = v3(end[0] as f32, end[1] as f32, 0.0).unit();
    let net = Net { height_m: 4.5, along, reach_m: (-30.0, rows_end + 1.0), half_width_m: 16.5 };
    Plan { route, terrain, scene, net: Some(net) }
}

fn soil(x: f32, y: f32, beside: Beside, rows_end: f32, salt: u32) -> Soil {
    let (along, across) = (beside.along_m, beside.across_m);
    let in_row = ((across + 0.5 * ROW_M).rem_euclid(ROW_M)).min(ROW_M - (across + 0.5 * ROW_M).rem_euclid(ROW_M));
    let wobble = 0.35 * (fractal(x * 0.9, y * 0.9, 3, salt) - 0.5);
    let farm = 1.0 - smoothstep(rows_end - 0.4, rows_end + 0.4, along + wobble);
    let berm = smoothstep(0.75, 0.35, in_row + wobble) * farm;
    let rut = |at: f32| smoothstep(0.27, 0.05, (across - at + 0.5 * wobble).abs());
    let ruts = (rut(0.42) + rut(-0.42)).min(1.0) * farm;
    let patches = smoothstep(0.42, 0.6, fractal(x * 0.55 + 7.0, y * 0.55, 4, salt ^ 5));
    let gravel = (0.25 + 0.9 * ruts + 0.75 * patches).min(1.2) * farm * (1.0 - berm) + 1.5 * (1.0 - farm);
    let grass = (1.0 - 0.85 * ruts) * (1.1 - 0.75 * patches) * farm * (1.0 - 0.9 * berm);
    let relief =
        0.07 * (fractal(x * 0.25, y * 0.25, 3, salt ^ 8) - 0.5) + 0.025 * (noise(x * 1.7, y * 1.7, salt ^ 2) - 0.5);
    Soil {
        height_m: relief + 0.14 * berm - 0.045 * ruts,
        shares: [gravel, grass, 1.3 * berm, 0.0],
        tint: 0.72 + 0.56 * fractal(x * 0.8, y * 0.8, 4, salt ^ 3),
    }
}

fn plant_row(scene: &mut Scene, route: &RouteLine, terrain: &Terrain, row: i32, rows_end: f32) {
    let across = (row as f32 + 0.5) * ROW_M;
    let inner = across.abs() < 2.0;
    let kind = 100 + (row + 50) as u64;
    let first = -8;
    let last = (rows_end / BUSH_M) as i32;
    for number in first..last {
        let mut dice = scene.dice(kind, (number + 1000) as u64);
        // Some bushes died and were not replaced, some are young.
        let fate = dice.unit();
        if fate < 0.045 {
            continue;
        }
        let age = if fate < 0.11 { 0.55 } else { 1.0 };
        let p = route.place(number as f32 * BUSH_M + 0.08 * dice.normal(), across + 0.07 * dice.normal());
        let height = (1.2 + 0.13 * dice.normal()) * age;
        let radius = (0.52 + 0.07 * dice.normal()) * age;
        let twigs = if inner { 150.0 } else { 85.0 } * age;
        bush(scene, &mut dice, BLUEBERRY_TWIG, on_ground(terrain, p), height, radius, twigs as usize);
    }
    let black = v3(0.10, 0.10, 0.10);
    for span in -1..(rows_end / 8.0) as i32 + 1 {
        let mut dice = scene.dice(kind + 1000, (span + 1000) as u64);
        // Farmers dig by eye: evenly spaced posts would make one place look like the next.
        let at = |span: i32| {
            let mut dice = scene.dice(kind + 2000, (span + 1000) as u64);
            let metre = span as f32 * 8.0 + 0.45 + 0.3 * dice.normal();
            let foot = on_ground(terrain, route.place(metre.min(rows_end), across + 0.05 * dice.normal()));
            (foot, v3(0.0, 0.0, 4.5 + 0.1 * dice.normal()))
        };
        let ((here, top), (next, next_top)) = (at(span), at(span + 1));
        post(scene, &mut dice, here, top.z, 0.06);
        if inner {
            let lift = |z: f32| v3(0.0, 0.0, z);
            wire(scene, &mut dice, here + lift(0.38), next + lift(0.38), 0.010, 0.05, black);
            wire(scene, &mut dice, here + lift(1.05), next + lift(1.05), 0.004, 0.02, v3(0.6, 0.6, 0.6));
        }
        wire(scene, &mut dice, here + top, next + next_top, 0.008, 0.05, black);
    }
}

/// What stands round the farm: a windbreak of trees behind the road and along the sides, a hut, crates in the lane.
fn surround(scene: &mut Scene, route: &RouteLine, length: f32) {
    let kind = TreeKind {
        look: BROADLEAF_TWIG,
        bark: 0,
        height_m: 9.0,
        stem_m: 2.2,
        crown_m: 2.6,
        girth_m: 0.17,
        twigs: 420,
        twig_m: 0.75,
        far: false,
    };
    for number in 0..14_u64 {
        let mut dice = scene.dice(300, number);
        let p = route.place(length + 13.0 + 2.0 * dice.normal(), (number as f32 - 6.5) * 4.2);
        tree(scene, &mut dice, &kind, p);
    }
    for number in 0..(length / 4.5) as u64 {
        for side in [-1.0, 1.0] {
            let mut dice = scene.dice(if side > 0.0 { 301 } else { 302 }, number);
            let p = route.place(number as f32 * 4.5 + 0.7 * dice.normal(), side * (22.0 + dice.normal()));
            let twigs = TreeKind { twigs: 200, twig_m: 1.0, height_m: dice.within(6.0, 10.0), ..kind };
            tree(scene, &mut dice, &twigs, p);
        }
    }
    hut(scene, route.place(length + 7.5, -6.5), 0.3, (4.2, 3.0, 2.3), WOOD.first(), 1.3);
    for number in 0..(length / 17.0) as u64 {
        let mut dice = scene.dice(303, number);
        let side = if dice.chance(0.5) { 1.0 } else { -1.0 };
        let p: V3 = route.place(6.0 + number as f32 * 17.0 + 5.0 * dice.unit(), side * dice.within(0.86, 0.98));
        let stack = 1 + dice.below(2);
        for level in 0..stack {
            crate_box(scene, &mut dice, p + v3(0.0, 0.0, 0.02 + 0.27 * level as f32), (0.5, 0.34, 0.25));
        }
    }
}
