//! Things that were made: posts, wires, drip lines, walls, cages, huts, crates.

use crate::chance::Dice;
use crate::texture::set::{BARS, IRON, MESH, WOOD};
use crate::vector::{V3, cos_sin, v3};
use crate::world::plants::limb;
use crate::world::scene::{Facet, Scene};

/// A round wooden post.
pub fn post(scene: &mut Scene, dice: &mut Dice, foot: V3, height_m: f32, radius_m: f32) {
    let lean = v3(dice.normal(), dice.normal(), 0.0) * (0.015 * height_m);
    let texture = WOOD.pick(dice);
    limb(
        scene,
        dice,
        foot - v3(0.0, 0.0, 0.2),
        foot + lean + v3(0.0, 0.0, height_m),
        (radius_m, radius_m * 0.9),
        7,
        texture,
    );
}

/// A wire, hose or cable from one point to another; `sag_m` deep in its middle.
pub fn wire(scene: &mut Scene, dice: &mut Dice, from: V3, to: V3, radius_m: f32, sag_m: f32, tint: V3) {
    const PIECES: i32 = 4;
    let point = |i: i32| {
        let t = i as f32 / PIECES as f32;
        from.mix(to, t) - v3(0.0, 0.0, 4.0 * sag_m * t * (1.0 - t))
    };
    let before = scene.facets.len();
    for i in 0..PIECES {
        limb(scene, dice, point(i), point(i + 1), (radius_m, radius_m), 3, IRON.first());
    }
    for facet in &mut scene.facets[before..] {
        facet.tint = tint;
    }
}

/// An upright wall from one foot point to another; the texture repeats every `repeat_m`.
pub fn wall(scene: &mut Scene, from: V3, to: V3, height_m: f32, thick_m: f32, texture: u8, repeat_m: f32) {
    let along = to - from;
    let side = v3(-along.y, along.x, 0.0).unit() * thick_m;
    let up = v3(0.0, 0.0, height_m);
    let uv = [0.0, 0.0, along.length() / repeat_m, height_m / repeat_m];
    let ends = [0.0, 0.0, thick_m / repeat_m, height_m / repeat_m];
    let low = from - v3(0.0, 0.0, 0.1);
    scene.add(Facet { uv, normal: -side.unit(), ..Facet::solid(low, along, up, texture) });
    scene.add(Facet { uv, normal: side.unit(), ..Facet::solid(low + side, along, up, texture) });
    scene.add(Facet { uv: ends, normal: -along.unit(), ..Facet::solid(low, side, up, texture) });
    scene.add(Facet { uv: ends, normal: along.unit(), ..Facet::solid(low + along, side, up, texture) });
    let cap = [0.0, 0.0, along.length() / repeat_m, thick_m / repeat_m];
    scene.add(Facet { uv: cap, normal: V3::UP, ..Facet::solid(low + up, along, side, texture) });
}

/// A hut on a turned rectangle: four walls, a leaning iron roof that juts out, a door and windows.
pub fn hut(scene: &mut Scene, centre: V3, turn_rad: f32, size_m: (f32, f32, f32), texture: u8, repeat_m: f32) {
    let (long, wide, high) = size_m;
    let turn = cos_sin(turn_rad);
    let corner = |x: f32, y: f32| centre + v3(0.5 * long * x, 0.5 * wide * y, 0.0).turned(turn);
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    for k in 0..4 {
        wall(scene, corners[k], corners[(k + 1) % 4], high, 0.12, texture, repeat_m);
    }
    let roof = |x: f32, y: f32| centre + v3(0.5 * long * x, 0.5 * wide * y, high + 0.25 + 0.22 * y).turned(turn);
    let (a, b, c) = (roof(-1.12, -1.15), roof(1.12, -1.15), roof(-1.12, 1.15));
    let facet = Facet { uv: [0.0, 0.0, long, wide], ..Facet::solid(a, b - a, c - a, IRON.first()) };
    let normal = if facet.normal.z < 0.0 { -facet.normal } else { facet.normal };
    scene.add(Facet { normal, ..facet });
    let edge = v3(0.0, 0.0, -0.1);
    scene.add(Facet { tint: v3(0.5, 0.4, 0.35), ..Facet::solid(a, b - a, edge, WOOD.first()) });
    for k in 0..4 {
        let (from, to) = (corners[k], corners[(k + 1) % 4]);
        let along = (to - from).unit();
        let out = v3(along.y, -along.x, 0.0) * 0.02;
        let middle = from.mix(to, 0.5);
        let (width, height, sill) = if k == 0 { (0.9, 2.0, 0.0) } else { (0.8, 0.7, 1.0) };
        if height + sill < high {
            let low = middle - along * (0.5 * width) + out + v3(0.0, 0.0, sill);
            let tint = if k == 0 { v3(0.75, 0.85, 0.75) } else { v3(0.12, 0.14, 0.16) };
            scene.add(Facet {
                tint,
                normal: out.unit(),
                ..Facet::solid(low, along * width, v3(0.0, 0.0, height), WOOD.first())
            });
        }
    }
}

/// A slatted crate.
pub fn crate_box(scene: &mut Scene, dice: &mut Dice, foot: V3, size_m: (f32, f32, f32)) {
    let turn = cos_sin(dice.unit() * 6.0);
    let (long, wide, high) = size_m;
    let corner = |x: f32, y: f32| foot + v3(0.5 * long * x, 0.5 * wide * y, 0.0).turned(turn);
    let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let slats = 3;
    let slat = high / (slats as f32 * 1.25);
    for k in 0..4 {
        for row in 0..slats {
            let (from, to) = (corners[k], corners[(k + 1) % 4]);
            let low = from + v3(0.0, 0.0, row as f32 * slat * 1.25);
            let tint = v3(1.25, 1.1, 0.85) * (1.0 + 0.15 * dice.normal());
            let along = to - from;
            let normal = v3(along.y, -along.x, 0.0).unit();
            let uv = [dice.unit(), dice.unit(), 0.15, long];
            let texture = WOOD.pick(dice);
            scene.add(Facet { tint, normal, uv, ..Facet::solid(low, v3(0.0, 0.0, slat), along, texture) });
        }
    }
}

/// An open screen of bars (or mesh) from one foot point to another.
pub fn screen(scene: &mut Scene, from: V3, to: V3, height_m: f32, barred: bool) {
    let along = to - from;
    let (texture, repeat) = if barred { (BARS.first(), 1.2) } else { (MESH.first(), 0.4) };
    let uv = [0.0, 0.0, along.length() / repeat, height_m / if barred { height_m } else { repeat }];
    scene.add(Facet { uv, ..Facet::solid(from, along, v3(0.0, 0.0, height_m), texture) });
}
