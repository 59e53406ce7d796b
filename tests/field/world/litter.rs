//! What covers the ground: tufts, weeds, fallen leaves, stones.

use crate::chance::{Dice, lattice};
use crate::texture::set::{FALLEN_LEAF, Look, ROSETTE, STONE};
use crate::vector::{V3, cos_sin, v3};
use crate::world::plants::direction;
use crate::world::scene::{Facet, LEAFY, SHADOWLESS, Scene, THINS, TRIANGLE};
use std::f32::consts::TAU;

/// A tuft of grass: upright cards through one foot.
pub fn tuft(scene: &mut Scene, dice: &mut Dice, look: Look, foot: V3, size_m: f32) {
    let turn = dice.unit() * TAU;
    let light = 1.0 + 0.15 * dice.normal();
    for k in 0..3 {
        let (cos, sin) = cos_sin(turn + k as f32 * TAU / 6.0 + 0.2 * dice.normal());
        let right = v3(cos, sin, 0.0);
        let up = (V3::UP + v3(-sin, cos, 0.0) * (0.22 * dice.normal())).unit();
        let (u, v) = (right * (size_m * dice.within(0.8, 1.1)), up * -size_m);
        let corner = foot - u * 0.5 - v - v3(0.0, 0.0, 0.015);
        let normal = (V3::UP * 0.9 + direction(dice) * 0.5).unit();
        let tint = v3(light, light, light * 0.95);
        scene.add(Facet {
            normal,
            tint,
            flags: THINS | LEAFY,
            sway_mm: (size_m * 40.0) as u8,
            ..Facet::solid(corner, u, v, look.pick(dice))
        });
    }
}

/// A flat card on the ground.
struct Lying {
    texture: u8,
    size_m: f32,
    /// How high it lies.
    lift_m: f32,
    /// How much it is tilted, as a slope.
    tilt: f32,
    flags: u8,
}

impl Lying {
    fn place(&self, scene: &mut Scene, dice: &mut Dice, at: V3) {
        let (cos, sin) = cos_sin(dice.unit() * TAU);
        let right = v3(cos, sin, self.tilt * dice.normal()).unit();
        let ahead = v3(-sin, cos, self.tilt * dice.normal()).unit();
        let (u, v) = (right * self.size_m, ahead * self.size_m);
        let lift_m = self.lift_m + 0.35 * self.size_m * (right.z.abs() + ahead.z.abs());
        let corner = at + v3(0.0, 0.0, lift_m) - (u + v) * 0.5;
        let tint = v3(1.0, 1.0, 1.0) * (1.0 + 0.15 * dice.normal());
        scene.add(Facet {
            normal: right.cross(ahead).unit(),
            tint,
            flags: self.flags,
            ..Facet::solid(corner, u, v, self.texture)
        });
    }
}

/// A low weed with leaves that lie on the ground.
pub fn weed(scene: &mut Scene, dice: &mut Dice, at: V3, size_m: f32) {
    for layer in 0..2 {
        let texture = ROSETTE.pick(dice);
        let lift_m = 0.015 + 0.02 * layer as f32;
        Lying { texture, size_m, lift_m, tilt: 0.18, flags: THINS | LEAFY }.place(scene, dice, at);
    }
}

/// A leaf that fell.
pub fn fallen_leaf(scene: &mut Scene, dice: &mut Dice, at: V3) {
    let size_m = dice.within(0.035, 0.085);
    let texture = FALLEN_LEAF.pick(dice);
    Lying { texture, size_m, lift_m: 0.006, tilt: 0.25, flags: THINS | SHADOWLESS }.place(scene, dice, at);
}

/// A stone: a small one is a domed card, a large one a body of facets half sunk in the ground.
pub fn stone(scene: &mut Scene, dice: &mut Dice, at: V3, size_m: f32) {
    if size_m < 0.09 {
        let texture = STONE.pick(dice);
        Lying { texture, size_m, lift_m: 0.012, tilt: 0.05, flags: SHADOWLESS }.place(scene, dice, at);
        return;
    }
    let texture = STONE.pick(dice);
    let (turn, squash) = (dice.unit() * TAU, dice.within(0.4, 0.7));
    let rim = |k: i32, ring: i32| {
        let polar = [0.08, 0.75, 1.75][ring as usize];
        let (cos, sin) = cos_sin(turn + (k as f32 + 0.5 * ring as f32) * TAU / 6.0);
        let bump = 1.0 + 0.25 * lattice(k.rem_euclid(6), ring, texture.into()) - 0.12;
        let (height, radius) = cos_sin(polar);
        at + v3(cos * radius, sin * radius * 0.8, height * squash) * (0.5 * size_m * bump)
    };
    let light = 1.0 + 0.15 * dice.normal();
    for k in 0..6 {
        for (a, b, c) in [
            (rim(k, 0), rim(k, 1), rim(k + 1, 1)),
            (rim(k, 0), rim(k + 1, 1), rim(k + 1, 0)),
            (rim(k, 1), rim(k, 2), rim(k + 1, 2)),
            (rim(k, 1), rim(k + 1, 2), rim(k + 1, 1)),
        ] {
            // The middle of a stone's texture, where it covers all.
            let facet = Facet {
                flags: TRIANGLE,
                uv: [0.35, 0.35, 0.3, 0.3],
                tint: v3(light, light, light),
                ..Facet::solid(a, b - a, c - a, texture)
            };
            let outward = (a + b + c) * (1.0 / 3.0) - at;
            let normal = if facet.normal.dot(outward) < 0.0 { -facet.normal } else { facet.normal };
            scene.add(Facet { normal, ..facet });
        }
    }
}
