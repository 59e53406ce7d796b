//! Things that grow: bushes, trees, tufts, weeds; and what falls from them.

use crate::chance::Dice;
use crate::scene::{Facet, LEAFY, SHADOWLESS, Scene, THINS};
use crate::texture::set::{BARK, FALLEN_LEAF, Look, ROSETTE, STONE};
use crate::vector::{V3, cos_sin, v3};
use std::f32::consts::TAU;

/// A direction at random, evenly over the sphere.
pub fn direction(dice: &mut Dice) -> V3 {
    let z = dice.within(-1.0, 1.0);
    let (cos, sin) = cos_sin(dice.unit() * TAU);
    let r = (1.0 - z * z).max(0.0).sqrt();
    v3(r * cos, r * sin, z)
}

/// A twig of leaves: its foot, where it points, its size, the crown's outward direction there.
pub fn twig(scene: &mut Scene, dice: &mut Dice, look: Look, foot: V3, points: V3, size_m: f32, outward: V3, sway_mm: f32) {
    let right = points.cross(direction(dice)).unit();
    let (u, v) = (right * size_m, points * -size_m);
    // Leaf normals follow the crown (SPEC 8.5), so that a crown is lit as one body with a rough surface.
    let normal = (outward * 0.75 + direction(dice) * 0.45).unit();
    let light = 1.0 + 0.16 * dice.normal();
    let warm = 1.0 + 0.10 * dice.normal();
    scene.add(Facet {
        normal,
        tint: v3(light * warm, light, light * (2.0 - warm)),
        flags: THINS | LEAFY,
        sway_mm: sway_mm.clamp(0.0, 250.0) as u8,
        ..Facet::solid(foot - right * (0.5 * size_m) + points * size_m, u, v, look.pick(dice))
    });
}

/// A bush of many canes from one foot, leaves from a third of its height on.
pub fn bush(scene: &mut Scene, dice: &mut Dice, look: Look, foot: V3, height_m: f32, radius_m: f32, twigs: usize) {
    let canes = 6 + dice.below(4);
    let mut tips = Vec::new();
    for cane in 0..canes {
        let (cos, sin) = cos_sin(cane as f32 / canes as f32 * TAU + 0.4 * dice.normal());
        let reach = radius_m * dice.within(0.25, 0.75);
        let tip = foot + v3(cos * reach, sin * reach, height_m * dice.within(0.65, 0.92));
        limb(scene, dice, foot + v3(cos, sin, 0.0) * 0.06, tip, (0.013, 0.005), 3, BARK.first() + 1);
        tips.push(tip);
    }
    for _ in 0..twigs {
        let d = direction(dice);
        let shell = dice.within(0.35, 1.0).sqrt();
        let centre = foot + v3(0.0, 0.0, height_m * 0.6);
        // Lumpy: the crown reaches further where a cane ends.
        let lean = tips[dice.below(tips.len())] - centre;
        let at = centre + v3(d.x * radius_m, d.y * radius_m, d.z * height_m * 0.42) * (shell * 0.85) + lean * 0.22;
        let points = (d + v3(0.0, 0.0, 0.45) + direction(dice) * 0.6).unit();
        let size_m = dice.within(0.17, 0.29) * (0.7 + 0.3 * height_m);
        twig(scene, dice, look, at - points * (0.5 * size_m), points, size_m, d, (at.z - foot.z) * 16.0);
    }
}

/// A stem or branch from one point to another with these radii: `sides` facets round it.
pub fn limb(scene: &mut Scene, dice: &mut Dice, from: V3, to: V3, radii_m: (f32, f32), sides: usize, texture: u8) {
    let axis = to - from;
    let along = axis.unit();
    let side = along.cross(if along.x.abs() < 0.7 { v3(1.0, 0.0, 0.0) } else { v3(0.0, 1.0, 0.0) }).unit();
    let other = along.cross(side);
    let radius = 0.5 * (radii_m.0 + radii_m.1);
    let turn = dice.unit() * TAU;
    let rim = |k: usize| {
        let (cos, sin) = cos_sin(turn + k as f32 * TAU / sides as f32);
        side * cos + other * sin
    };
    let start = dice.unit();
    let v_share = (axis.length() / (TAU * radius).max(0.25)).max(0.2);
    for k in 0..sides {
        let (a, b) = (rim(k), rim(k + 1));
        let u_share = 1.0 / sides as f32;
        scene.add(Facet {
            normal: (a + b).unit(),
            uv: [k as f32 * u_share, start, u_share, v_share],
            tint: v3(1.0, 1.0, 1.0) * (1.0 + 0.12 * dice.normal()),
            ..Facet::solid(from + a * radius, (b - a) * radius, axis, texture)
        });
    }
}

/// What kind of tree, in metres.
#[derive(Debug, Clone, Copy)]
pub struct TreeKind {
    /// Twigs.
    pub look: Look,
    /// 0 for grey bark, 1 for brown.
    pub bark: u8,
    /// Height of the whole tree.
    pub height_m: f32,
    /// Height at which the crown begins.
    pub stem_m: f32,
    /// Radius of the crown.
    pub crown_m: f32,
    /// Radius of the stem.
    pub girth_m: f32,
    /// Twigs in the crown.
    pub twigs: usize,
    /// Size of a twig.
    pub twig_m: f32,
}

/// A tree: a leaning stem that forks, branches, and twigs in clumps round the branches' ends.
pub fn tree(scene: &mut Scene, dice: &mut Dice, kind: &TreeKind, foot: V3) {
    let scale = dice.within(0.85, 1.15);
    let bark = BARK.first() + kind.bark;
    let lean = v3(dice.normal(), dice.normal(), 0.0) * (0.05 * kind.stem_m);
    let fork = foot + v3(0.0, 0.0, kind.stem_m * scale) + lean;
    let knee = foot.mix(fork, 0.5) + v3(dice.normal(), dice.normal(), 0.0) * (0.02 * kind.stem_m);
    limb(scene, dice, foot - v3(0.0, 0.0, 0.1), knee, (kind.girth_m * 1.25, kind.girth_m), 8, bark);
    limb(scene, dice, knee, fork, (kind.girth_m, kind.girth_m * 0.85), 8, bark);
    let crown = (kind.height_m - kind.stem_m) * scale;
    let mut clumps = Vec::new();
    let arms = 4 + dice.below(3);
    for arm in 0..arms {
        let (cos, sin) = cos_sin(arm as f32 / arms as f32 * TAU + 0.35 * dice.normal());
        let reach = kind.crown_m * scale * dice.within(0.45, 0.75);
        let tip = fork + v3(cos * reach, sin * reach, crown * dice.within(0.25, 0.75));
        let elbow = fork.mix(tip, 0.5) + v3(0.0, 0.0, crown * dice.within(-0.06, 0.1));
        limb(scene, dice, fork, elbow, (kind.girth_m * 0.6, kind.girth_m * 0.4), 5, bark);
        limb(scene, dice, elbow, tip, (kind.girth_m * 0.4, kind.girth_m * 0.18), 4, bark);
        clumps.push(tip);
        for _ in 0..3 {
            let (c2, s2) = cos_sin(dice.unit() * TAU);
            let span = kind.crown_m * scale * dice.within(0.25, 0.5);
            let end = elbow.mix(tip, dice.within(0.2, 0.9)) + v3(c2 * span, s2 * span, crown * dice.within(-0.12, 0.32));
            limb(scene, dice, elbow.mix(tip, 0.4), end, (kind.girth_m * 0.2, kind.girth_m * 0.08), 3, bark);
            clumps.push(end);
        }
    }
    clumps.push(fork + v3(0.0, 0.0, crown * 0.85));
    let middle = fork + v3(0.0, 0.0, crown * 0.4);
    for i in 0..kind.twigs {
        let clump = clumps[i % clumps.len()];
        let spread = kind.crown_m * scale * 0.36;
        let d = direction(dice);
        let at = clump + v3(d.x, d.y, 0.75 * d.z) * (spread * dice.within(0.3, 1.0));
        let away = ((at - middle).unit() * 0.6 + d * 0.6).unit();
        let points = (away + v3(0.0, 0.0, 0.1) + direction(dice) * 0.7).unit();
        let size_m = kind.twig_m * dice.within(0.75, 1.3);
        twig(scene, dice, kind.look, at - points * (0.5 * size_m), points, size_m, away, (at.z - foot.z) * 12.0);
    }
}

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
        scene.add(Facet { normal, tint, flags: THINS | LEAFY, sway_mm: (size_m * 40.0) as u8, ..Facet::solid(corner, u, v, look.pick(dice)) });
    }
}

/// A flat card on the ground: a weed, a stone or a fallen leaf, tilted a little.
fn lying(scene: &mut Scene, dice: &mut Dice, texture: u8, at: V3, size_m: (f32, f32), lift_m: f32, tilt: f32, flags: u8) {
    let (cos, sin) = cos_sin(dice.unit() * TAU);
    let right = v3(cos, sin, tilt * dice.normal()).unit();
    let ahead = v3(-sin, cos, tilt * dice.normal()).unit();
    let (u, v) = (right * size_m.0, ahead * size_m.1);
    let normal = u.cross(v).unit();
    let corner = at + v3(0.0, 0.0, lift_m + 0.35 * size_m.0 * (u.unit().z.abs() + v.unit().z.abs())) - (u + v) * 0.5;
    let tint = v3(1.0, 1.0, 1.0) * (1.0 + 0.15 * dice.normal());
    scene.add(Facet { normal, tint, flags, ..Facet::solid(corner, u, v, texture) });
}

/// A low weed with leaves that lie on the ground.
pub fn weed(scene: &mut Scene, dice: &mut Dice, at: V3, size_m: f32) {
    for layer in 0..2 {
        let texture = ROSETTE.pick(dice);
        lying(scene, dice, texture, at, (size_m, size_m), 0.015 + 0.02 * layer as f32, 0.18, THINS | LEAFY);
    }
}

/// A leaf that fell.
pub fn fallen_leaf(scene: &mut Scene, dice: &mut Dice, at: V3) {
    let size_m = dice.within(0.035, 0.085);
    let texture = FALLEN_LEAF.pick(dice);
    lying(scene, dice, texture, at, (size_m, size_m), 0.006, 0.25, THINS | SHADOWLESS);
}

/// A stone: a small one is a domed card, a large one a body of facets half sunk in the ground.
pub fn stone(scene: &mut Scene, dice: &mut Dice, at: V3, size_m: f32) {
    if size_m < 0.09 {
        let texture = STONE.pick(dice);
        lying(scene, dice, texture, at, (size_m, size_m), 0.012, 0.05, SHADOWLESS);
        return;
    }
    let texture = STONE.pick(dice);
    let (turn, squash) = (dice.unit() * TAU, dice.within(0.4, 0.7));
    let rim = |k: i32, ring: i32| {
        let polar = [0.08, 0.75, 1.75][ring as usize];
        let (cos, sin) = cos_sin(turn + (k as f32 + 0.5 * ring as f32) * TAU / 6.0);
        let bump = 1.0 + 0.25 * crate::chance::lattice(k.rem_euclid(6), ring, texture.into()) - 0.12;
        let (height, radius) = cos_sin(polar);
        at + v3(cos * radius, sin * radius * 0.8, height * squash) * (0.5 * size_m * bump)
    };
    let light = 1.0 + 0.15 * dice.normal();
    for k in 0..6 {
        for (a, b, c) in [(rim(k, 0), rim(k, 1), rim(k + 1, 1)), (rim(k, 0), rim(k + 1, 1), rim(k + 1, 0)), (rim(k, 1), rim(k, 2), rim(k + 1, 2)), (rim(k, 1), rim(k + 1, 2), rim(k + 1, 1))] {
            // The middle of a stone's texture, where it covers all.
            let facet = Facet { flags: crate::scene::TRIANGLE, uv: [0.35, 0.35, 0.3, 0.3], tint: v3(light, light, light), ..Facet::solid(a, b - a, c - a, texture) };
            let outward = (a + b + c) * (1.0 / 3.0) - at;
            let normal = if facet.normal.dot(outward) < 0.0 { -facet.normal } else { facet.normal };
            scene.add(Facet { normal, ..facet });
        }
    }
}
