//! Bushes and trees: stems, branches, and twigs on cards.

use crate::chance::Dice;
use crate::texture::set::{BARK, Look};
use crate::vector::{V3, cos_sin, v3};
use crate::world::scene::{Facet, LEAFY, Scene, THINS};
use std::f32::consts::TAU;

/// A direction at random, evenly over the sphere.
pub fn direction(dice: &mut Dice) -> V3 {
    let z = dice.within(-1.0, 1.0);
    let (cos, sin) = cos_sin(dice.unit() * TAU);
    let r = (1.0 - z * z).max(0.0).sqrt();
    v3(r * cos, r * sin, z)
}

/// A twig of leaves to be placed.
#[derive(Debug, Clone, Copy)]
pub struct Twig {
    /// Which leaves.
    pub look: Look,
    /// Its middle.
    pub middle: V3,
    /// Unit direction from its foot to its tip.
    pub points: V3,
    /// Length and width in metres.
    pub size_m: f32,
    /// The crown's outward direction there.
    pub outward: V3,
    /// How far wind moves it.
    pub sway_mm: f32,
}

impl Twig {
    fn place(&self, scene: &mut Scene, dice: &mut Dice) {
        let right = self.points.cross(direction(dice)).unit();
        let (u, v) = (right * self.size_m, self.points * -self.size_m);
        // Leaf normals follow the crown, so that a crown is lit as one body; rough enough that other twigs shine two
        // hours later.
        let normal = (self.outward * 0.75 + direction(dice) * 0.8).unit();
        let light = 1.0 + 0.16 * dice.normal();
        let warm = 1.0 + 0.10 * dice.normal();
        scene.add(Facet {
            normal,
            tint: v3(light * warm, light, light * (2.0 - warm)),
            flags: THINS | LEAFY,
            sway_mm: self.sway_mm.clamp(0.0, 250.0) as u8,
            ..Facet::solid(self.middle - (u + v) * 0.5, u, v, self.look.pick(dice))
        });
    }
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
        let sway_mm = (at.z - foot.z) * 10.0;
        Twig { look, middle: at, points, size_m, outward: d, sway_mm }.place(scene, dice);
    }
}

/// Undergrowth seen from afar: leaves from the ground to its height.
pub fn thicket(scene: &mut Scene, dice: &mut Dice, look: Look, foot: V3, height_m: f32, radius_m: f32, twigs: usize) {
    for _ in 0..twigs {
        let d = direction(dice);
        let up = dice.unit();
        let at = foot + v3(d.x * radius_m, d.y * radius_m, up * height_m);
        let outward = v3(d.x, d.y, up).unit();
        let points = (outward + V3::UP + direction(dice)).unit();
        let size_m = dice.within(0.9, 1.4);
        Twig { look, middle: at, points, size_m, outward, sway_mm: 20.0 * up * height_m }.place(scene, dice);
    }
}

/// A stem or branch from one point to another with these radii: `sides` facets round it.
pub fn limb(scene: &mut Scene, dice: &mut Dice, from: V3, to: V3, radii_m: (f32, f32), sides: usize, texture: u8) {
    let axis = to - from;
    let along = axis.unit();
    let side = along.cross(if along.x.abs() < 0.7 { v3(1.0, 0.0, 0.0) } else { v3(0.0, 1.0, 0.0) }).unit();
    let other = along.cross(side);
    let radius = 0.5 * (radii_m.0 + radii_m.1);
    let rim = |k: usize| {
        let (cos, sin) = cos_sin(k as f32 * TAU / sides as f32);
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
            tint: v3(1.0, 1.0, 1.0) * (1.0 + 0.05 * dice.normal()),
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
    /// Whether it is only seen from afar: without its lesser branches.
    pub far: bool,
}

/// A tree: a leaning stem that forks, branches, and twigs in clumps round the branches' ends.
pub fn tree(scene: &mut Scene, dice: &mut Dice, kind: &TreeKind, foot: V3) {
    let scale = dice.within(0.85, 1.15);
    let bark = BARK.first() + kind.bark;
    let lean = v3(dice.normal(), dice.normal(), 0.0) * (0.05 * kind.stem_m);
    let fork = foot + v3(0.0, 0.0, kind.stem_m * scale) + lean;
    let bow = v3(dice.normal(), dice.normal(), 0.0) * (0.03 * kind.stem_m);
    let stem = |t: f32| foot.mix(fork, t) + bow * (4.0 * t * (1.0 - t)) - v3(0.0, 0.0, 0.1) * (1.0 - t);
    // The stem flares at its foot.
    let radius = |t: f32| kind.girth_m * (0.85 + 0.15 * (1.0 - t) + 0.35 * libm::expf(-9.0 * t));
    let (pieces, sides) = if kind.far { (2, 5) } else { (6, 9) };
    for piece in 0..pieces {
        let [a, b] = [piece, piece + 1].map(|k| k as f32 / pieces as f32);
        limb(scene, dice, stem(a), stem(b) + (stem(b) - stem(a)) * 0.04, (radius(a), radius(b)), sides, bark);
    }
    let crown = (kind.height_m - kind.stem_m) * scale;
    let mut clumps = Vec::new();
    let arms = 4 + dice.below(3);
    for arm in 0..arms {
        let (cos, sin) = cos_sin(arm as f32 / arms as f32 * TAU + 0.35 * dice.normal());
        let reach = kind.crown_m * scale * dice.within(0.45, 0.75);
        let tip = fork + v3(cos * reach, sin * reach, crown * dice.within(0.25, 0.75));
        let elbow = fork.mix(tip, 0.5) + v3(0.0, 0.0, crown * dice.within(-0.06, 0.1));
        if !kind.far {
            limb(scene, dice, fork, elbow, (kind.girth_m * 0.6, kind.girth_m * 0.4), 5, bark);
            limb(scene, dice, elbow, tip, (kind.girth_m * 0.4, kind.girth_m * 0.18), 4, bark);
        }
        clumps.push(tip);
        for _ in 0..3 {
            let (c2, s2) = cos_sin(dice.unit() * TAU);
            let span = kind.crown_m * scale * dice.within(0.25, 0.5);
            let end =
                elbow.mix(tip, dice.within(0.2, 0.9)) + v3(c2 * span, s2 * span, crown * dice.within(-0.12, 0.32));
            if !kind.far {
                limb(scene, dice, elbow.mix(tip, 0.4), end, (kind.girth_m * 0.2, kind.girth_m * 0.08), 3, bark);
            }
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
        let sway_mm = (at.z - foot.z) * 54.0;
        Twig { look: kind.look, middle: at, points, size_m, outward: away, sway_mm }.place(scene, dice);
    }
}
