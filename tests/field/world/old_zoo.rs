//! The Old Zoo: a loop of about 210 m on a tarred path, through tree tunnels and clearings, past walls, cages and façades.

use super::Plan;
use super::layout::{Floor, on_ground, strew};
use crate::chance::{Dice, derive, fractal, noise};
use crate::plants::{TreeKind, bush, tree};
use crate::route::{Beside, RouteLine};
use crate::scene::{Facet, Scene};
use crate::structures::{crate_box, hut, post, screen, wall, wire};
use crate::terrain::{Soil, Terrain};
use crate::texture::set::{BRICK, BROADLEAF_TWIG, IRON, NEEDLE_TWIG, PLASTER, WOOD};
use crate::vector::{V3, smoothstep, v3};

/// Length of the loop (SPEC 8.2); the vocabulary route's is longer.
const LENGTH_M: f64 = 210.0;
const VOCABULARY_M: f64 = 330.0;
/// Half the width of the tarred path.
const PATH_M: f32 = 1.5;

/// Corners of the loop before it is stretched to its length: straights, wide bends and two tight ones.
const CORNERS: [[f64; 2]; 16] = [
    [0.0, 0.0],
    [13.0, 3.0],
    [27.0, 1.0],
    [38.0, -6.0],
    [51.0, -6.0],
    [60.0, 2.0],
    [58.0, 14.0],
    [47.0, 18.0],
    [43.0, 28.0],
    [50.0, 38.0],
    [42.0, 48.0],
    [27.0, 46.0],
    [19.0, 37.0],
    [12.0, 25.0],
    [-2.0, 22.0],
    [-9.0, 9.0],
];

/// The zoo: `longer` for the vocabulary route's own part of it.
pub fn plan(seed: u64, longer: bool) -> Plan {
    let route = route(seed, longer);
    let length = route.length_m() as f32;
    let salt = seed as u32;
    let terrain = Terrain::build(&route, 14.0, |x, y, beside| soil(x, y, beside, salt));
    let mut scene = Scene::new(seed);
    plant_trees(&mut scene, &route, &terrain, salt);
    plant_shrubs(&mut scene, &route, &terrain, salt);
    build_edges(&mut scene, &route, &terrain);
    let floor = Floor { tufts: 5.0, weeds: 1.6, stones: 5.0, leaves: 26.0, tuft_m: (0.10, 0.34), dry: 0.3 };
    strew(&mut scene, &route, &terrain, (-3.4, 3.4), (0.0, length), &floor, 20);
    let beyond = Floor { tufts: 2.6, weeds: 0.3, stones: 0.3, leaves: 3.0, tuft_m: (0.15, 0.42), dry: 0.35 };
    strew(&mut scene, &route, &terrain, (3.4, 9.0), (0.0, length), &beyond, 21);
    strew(&mut scene, &route, &terrain, (-9.0, -3.4), (0.0, length), &beyond, 22);
    Plan { route, terrain, scene, net: None }
}

fn route(seed: u64, longer: bool) -> RouteLine {
    let mut dice = Dice::of(seed, 40);
    let mut jog = |amount: f64| f64::from(dice.normal()) * amount;
    let bent = CORNERS.map(|[x, y]| if longer { [-x + jog(2.0), y + jog(2.0)] } else { [x, y] });
    let wanted = if longer { VOCABULARY_M } else { LENGTH_M };
    let scale = wanted / RouteLine::through(&bent, true).length_m();
    RouteLine::through(&bent.map(|p| p.map(|v| v * scale)), true)
}

/// How much of a tree tunnel the path is in at `along`: 1 inside, 0 in a clearing.
fn tunnel(along: f32, salt: u32) -> f32 {
    smoothstep(0.42, 0.55, noise(along / 24.0, 3.3, salt ^ 91))
}

fn soil(x: f32, y: f32, beside: Beside, salt: u32) -> Soil {
    let across = beside.across_m.abs();
    let ragged = 0.5 * (fractal(x * 1.3, y * 1.3, 4, salt) - 0.5);
    let tarred = smoothstep(PATH_M + 0.10, PATH_M - 0.10, across + ragged);
    let broken = smoothstep(0.60, 0.68, fractal(x * 0.5, y * 0.5, 4, salt ^ 5));
    let drifts = smoothstep(0.5, 0.7, fractal(x * 0.8 + 9.0, y * 0.8, 4, salt ^ 6)) * smoothstep(0.3, PATH_M, across);
    let shade = tunnel(beside.along_m, salt);
    let bare = smoothstep(0.40, 0.62, fractal(x * 0.35, y * 0.35, 4, salt ^ 7));
    let tar = tarred * (1.0 - 0.85 * broken) * (1.0 - 0.75 * drifts);
    let leaves = (1.0 - tarred) * (0.25 + 0.75 * shade) * (0.4 + bare) + 0.8 * drifts * tarred;
    let grass = (1.0 - tarred) * (1.0 - 0.7 * shade) * (1.15 - bare);
    let gravel = 0.8 * tarred * broken
        + (1.0 - tarred) * smoothstep(0.5, 0.0, across - PATH_M) * 0.8
        + 0.15 * bare * (1.0 - tarred);
    let relief = 0.12 * (fractal(x * 0.16, y * 0.16, 3, salt ^ 8) - 0.5)
        + 0.03 * (1.0 - tarred) * (noise(x * 1.5, y * 1.5, salt ^ 2) - 0.5);
    Soil {
        height_m: relief + 0.03 * tarred * (1.0 - across / PATH_M).max(0.0),
        shares: [gravel, grass, leaves, tar],
        tint: 0.72 + 0.56 * fractal(x * 0.7, y * 0.7, 4, salt ^ 3),
    }
}

fn plant_trees(scene: &mut Scene, route: &RouteLine, terrain: &Terrain, salt: u32) {
    let plane = TreeKind {
        look: BROADLEAF_TWIG,
        bark: 0,
        height_m: 7.5,
        stem_m: 2.6,
        crown_m: 2.9,
        girth_m: 0.19,
        twigs: 330,
        twig_m: 0.62,
    };
    let pine = TreeKind {
        look: NEEDLE_TWIG,
        bark: 1,
        height_m: 9.5,
        stem_m: 4.6,
        crown_m: 2.8,
        girth_m: 0.24,
        twigs: 240,
        twig_m: 0.8,
    };
    let steps = (route.length_m() / 3.6) as u64;
    for number in 0..steps {
        for side in [-1.0_f32, 1.0] {
            let mut dice = scene.dice(if side > 0.0 { 301 } else { 302 }, number);
            let along = number as f32 * 3.6 + dice.within(-1.2, 1.2);
            let dense = tunnel(along, salt);
            if dice.chance(0.12 + 0.78 * dense) {
                let p = route.place(along, side * dice.within(2.5, 3.9));
                plant(scene, &mut dice, route, terrain, if pines(along, salt) { &pine } else { &plane }, p, 2.2);
            }
            if dice.chance(0.45) {
                let p = route.place(along, side * dice.within(7.0, 15.0));
                let far = TreeKind { twigs: 150, twig_m: 0.95, ..plane };
                let kind = if dice.chance(0.3) { &pine } else { &far };
                plant(scene, &mut dice, route, terrain, kind, p, 4.5);
            }
        }
    }
}

/// Pines stand together in stretches.
fn pines(along: f32, salt: u32) -> bool {
    noise(along / 31.0, 8.1, salt ^ 17) > 0.62
}

fn plant(
    scene: &mut Scene,
    dice: &mut Dice,
    route: &RouteLine,
    terrain: &Terrain,
    kind: &TreeKind,
    p: V3,
    clear_m: f32,
) {
    if route.distance_m(p.x, p.y) >= clear_m {
        tree(scene, dice, kind, on_ground(terrain, p));
    }
}

/// Undergrowth: a hedge beside the path that thins out here and there, and thickets behind it that close the view.
fn plant_shrubs(scene: &mut Scene, route: &RouteLine, terrain: &Terrain, salt: u32) {
    for number in 0..(route.length_m() / 1.1) as u64 {
        for side in [-1.0_f32, 1.0] {
            let mut dice = scene.dice(if side > 0.0 { 311 } else { 312 }, number);
            let along = number as f32 * 1.1;
            let hedge = smoothstep(0.36, 0.46, noise(along / 9.0, side * 5.0, salt ^ 23));
            if dice.chance(0.10 + 0.85 * hedge) {
                let p = route.place(along + 0.2 * dice.normal(), side * (2.6 + 0.35 * dice.normal().abs()));
                let height = dice.within(0.7, 1.6);
                if route.distance_m(p.x, p.y) > 2.1 {
                    bush(scene, &mut dice, BROADLEAF_TWIG, on_ground(terrain, p), height, 0.55 * height + 0.1, 75);
                }
            }
            if number % 2 == 0 && dice.chance(0.8) {
                let p = route.place(along + 0.5 * dice.normal(), side * dice.within(4.6, 8.0));
                let height = dice.within(1.5, 2.6);
                if route.distance_m(p.x, p.y) > 4.0 {
                    bush(scene, &mut dice, BROADLEAF_TWIG, on_ground(terrain, p), height, 0.5 * height + 0.2, 70);
                }
            }
        }
    }
}

/// What the zoo left beside its paths: every 13 m something else, on one side or the other.
fn build_edges(scene: &mut Scene, route: &RouteLine, terrain: &Terrain) {
    for number in 0..(route.length_m() / 13.0) as u64 {
        let mut dice = scene.dice(330, number);
        let along = number as f32 * 13.0 + 2.0;
        let side = if dice.chance(0.5) { 1.0 } else { -1.0 };
        // Every kind comes round, in an order that no stretch repeats.
        let kind = (number + derive(number / 6, 5)) % 6;
        edge(scene, &mut dice, route, terrain, kind, along, side);
        if dice.chance(0.6) {
            let p = on_ground(terrain, route.place(along + 6.5, -side * 1.95));
            post(scene, &mut dice, p, 3.6, 0.05);
            crate_box(scene, &mut dice, on_ground(terrain, route.place(along + 8.0, -side * 2.1)), (1.3, 0.4, 0.42));
        }
    }
}

fn edge(scene: &mut Scene, dice: &mut Dice, route: &RouteLine, terrain: &Terrain, kind: u64, along: f32, side: f32) {
    let spot = |metre: f32, across: f32| on_ground(terrain, route.place(metre, side * across));
    let clear = |p: V3, m: f32| route.distance_m(p.x, p.y) > m;
    // Walls follow the path in pieces of 2 m.
    let pieces = |count: usize| (0..count).map(|k| (along + 2.0 * k as f32, along + 2.0 * (k + 1) as f32));
    match kind {
        0 => pieces(5).for_each(|(a, b)| wall(scene, spot(a, 2.3), spot(b, 2.3), 0.95, 0.24, BRICK.first(), 1.0)),
        1 => {
            let texture = PLASTER.pick(dice);
            pieces(5).for_each(|(a, b)| wall(scene, spot(a, 2.6), spot(b, 2.6), 2.3, 0.2, texture, 2.2));
        }
        2 => {
            let back = PLASTER.pick(dice);
            for (a, b) in pieces(4) {
                screen(scene, spot(a, 2.4), spot(b, 2.4), 2.8, true);
                wall(scene, spot(a, 2.35), spot(b, 2.35), 0.4, 0.2, PLASTER.first(), 2.0);
                if clear(spot(a, 5.6), 3.5) && clear(spot(b, 5.6), 3.5) {
                    wall(scene, spot(a, 5.6), spot(b, 5.6), 3.0, 0.2, back, 2.6);
                }
                let (roof, out) = (spot(a, 2.2) + v3(0.0, 0.0, 2.9), spot(a, 5.8) - spot(a, 2.2));
                let facet = Facet {
                    uv: [0.0, 0.0, 2.0, 3.6],
                    ..Facet::solid(roof, spot(b, 2.2) - spot(a, 2.2), out, IRON.first())
                };
                scene.add(Facet { normal: V3::UP, ..facet });
                post(scene, dice, spot(a, 2.4), 2.85, 0.06);
            }
        }
        3 => {
            for (a, b) in pieces(5) {
                screen(scene, spot(a, 2.3), spot(b, 2.3), 1.9, false);
                post(scene, dice, spot(a, 2.3), 2.0, 0.045);
                wire(
                    scene,
                    dice,
                    spot(a, 2.3) + v3(0.0, 0.0, 1.9),
                    spot(b, 2.3) + v3(0.0, 0.0, 1.9),
                    0.012,
                    0.02,
                    v3(0.8, 0.8, 0.8),
                );
            }
        }
        4 => {
            let (_, ahead) = route.at(f64::from(along + 4.0));
            let turn =
                libm::atan2f(ahead[1] as f32, ahead[0] as f32) + if side < 0.0 { std::f32::consts::PI } else { 0.0 };
            let centre = spot(along + 4.0, 6.0);
            if clear(centre, 5.0) {
                let texture = PLASTER.pick(dice);
                hut(scene, centre, turn, (8.5, 5.0, 3.3), texture, 2.6);
            }
        }
        _ => {
            for (a, b) in pieces(5) {
                post(scene, dice, spot(a, 2.1), 1.1, 0.06);
                for height in [0.5, 0.95] {
                    let lift = v3(0.0, 0.0, height);
                    wire(scene, dice, spot(a, 2.1) + lift, spot(b, 2.1) + lift, 0.035, 0.0, v3(0.9, 0.75, 0.6));
                }
            }
            if clear(spot(along + 5.0, 4.5), 3.0) {
                crate_box(scene, dice, spot(along + 5.0, 4.5), (1.6, 1.0, 0.8));
                post(scene, dice, spot(along + 6.0, 4.0), 2.4, 0.07);
                let board = spot(along + 3.0, 2.2) + v3(0.0, 0.0, 0.9);
                scene.add(Facet {
                    tint: v3(0.9, 1.1, 0.8),
                    ..Facet::solid(
                        board,
                        spot(along + 3.9, 2.2) - spot(along + 3.0, 2.2),
                        v3(0.0, 0.0, 0.6),
                        WOOD.first(),
                    )
                });
            }
        }
    }
}
