//! Walls, cages, fences and façades beside the zoo's path.

use crate::chance::{Dice, derive};
use crate::texture::set::{BRICK, IRON, PLASTER, WOOD};
use crate::vector::{V3, v3};
use crate::world::layout::on_ground;
use crate::world::route::RouteLine;
use crate::world::scene::{Facet, Scene};
use crate::world::structures::{crate_box, hut, post, screen, wall, wire};
use crate::world::terrain::Terrain;

/// What the zoo left beside its paths: every 13 m something else, on one side or the other.
pub fn build(scene: &mut Scene, route: &RouteLine, terrain: &Terrain) {
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
