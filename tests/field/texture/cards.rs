//! Textures of plants: twigs full of leaves, tufts of grass, single leaves and stones on the ground.
//! On a twig's card v = 1 is its foot and v = 0 its tip; on a tuft's card too.

use super::Texture;
use super::canvas::{Canvas, Paint, vary};
use crate::chance::Dice;
use crate::vector::{V3, cos_sin, v3};
use std::f32::consts::PI;

/// What the leaves of a kind of plant look like on its cards of 128 pixels.
pub struct Foliage {
    /// Leaf length, in pixels.
    pub length: f32,
    /// Leaf width over length.
    pub slender: f32,
    /// Leaves on a card.
    pub leaves: usize,
    /// Albedo.
    pub albedo: V3,
    /// How much the leaves differ in colour: 1 for a quarter of them much lighter or darker.
    pub varied: f32,
    /// How much the leaves are tilted against each other, as slopes.
    pub tilt: f32,
    /// Share of the light that passes a leaf.
    pub through: f32,
    /// Shine.
    pub gloss: f32,
    /// Fruit: how many on a card, diameter in pixels, albedo.
    pub fruit: (usize, f32, V3),
}

/// Blueberry: small, stiff, bluish leaves in dense sprays, some berries.
pub const BLUEBERRY: Foliage = Foliage {
    length: 31.0,
    slender: 0.46,
    leaves: 30,
    albedo: v3(0.085, 0.15, 0.05),
    varied: 1.0,
    tilt: 0.36,
    through: 0.35,
    gloss: 0.45,
    fruit: (3, 8.0, v3(0.06, 0.07, 0.16)),
};
/// Nectarine: long narrow leaves, and ripe fruit: the default day is in January.
pub const NECTARINE: Foliage = Foliage {
    length: 52.0,
    slender: 0.24,
    leaves: 34,
    albedo: v3(0.075, 0.14, 0.035),
    varied: 0.3,
    tilt: 0.6,
    through: 0.22,
    gloss: 0.5,
    fruit: (2, 15.0, v3(0.5, 0.13, 0.05)),
};
/// Broad-leaved trees and shrubs of a park.
pub const BROADLEAF: Foliage = Foliage {
    length: 30.0,
    slender: 0.55,
    leaves: 36,
    albedo: v3(0.105, 0.19, 0.06),
    varied: 0.4,
    tilt: 0.6,
    through: 0.3,
    gloss: 0.35,
    fruit: (0, 6.0, v3(0.3, 0.2, 0.1)),
};
/// A clump of a park tree's crown as it looks from afar.
pub const CROWN: Foliage = Foliage { length: 15.0, slender: 0.6, leaves: 190, varied: 0.5, ..BROADLEAF };
/// The needles of stone pines, in bundles.
pub const NEEDLES: Foliage = Foliage {
    length: 36.0,
    slender: 0.09,
    leaves: 120,
    albedo: v3(0.05, 0.09, 0.035),
    varied: 0.6,
    tilt: 0.4,
    through: 0.15,
    gloss: 0.2,
    fruit: (1, 14.0, v3(0.13, 0.08, 0.05)),
};

/// A twig of 128 pixels square with its leaves, the ones painted last in front.
pub fn twig(foliage: &Foliage, seed: u64) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = Canvas::clear(7, false);
    let bark = Paint::matt(v3(0.12, 0.085, 0.05));
    let mut stems = vec![];
    for stem in 0..5 {
        let start = (64.0 + 8.0 * dice.normal(), 126.0);
        let lean = if stem == 0 { 0.1 * dice.normal() } else { dice.within(-0.85, 0.85) };
        let (cos, sin) = cos_sin(lean);
        let reach = dice.within(66.0, 108.0);
        let end = (start.0 + reach * sin, start.1 - reach * cos);
        canvas.stroke(start, end, (3.4, 1.2), bark);
        stems.push((start, end, lean));
    }
    for _ in 0..foliage.leaves {
        let (start, end, lean) = stems[dice.below(stems.len())];
        let t = 1.0 - 0.86 * dice.unit() * dice.unit().sqrt();
        let foot = (start.0 + (end.0 - start.0) * t, start.1 + (end.1 - start.1) * t);
        let side = if dice.chance(0.5) { 1.0 } else { -1.0 };
        let angle = lean - 0.5 * PI + side * dice.within(0.15, 1.35);
        let mut paint = Paint {
            albedo: vary(foliage.albedo, &mut dice, 0.22 * foliage.varied),
            slope: (foliage.tilt * dice.normal(), foliage.tilt * dice.normal()),
            through: foliage.through,
            gloss: foliage.gloss * dice.within(0.4, 1.0),
        };
        // A quarter of the leaves are outliers: fresh and light, or old and dark.
        if dice.chance(0.14 * foliage.varied) {
            paint.albedo = paint.albedo.times(v3(1.9, 1.6, 1.25));
        } else if dice.chance(0.12 * foliage.varied) {
            paint.albedo = paint.albedo * 0.45;
        } else if dice.chance(0.04 * foliage.varied) {
            paint.albedo = v3(0.30, 0.19, 0.06);
        }
        let length = foliage.length * dice.within(0.65, 1.2);
        canvas.leaf(foot, angle, length, length * foliage.slender * dice.within(0.7, 1.15), paint);
    }
    let (fruits, diameter, albedo) = foliage.fruit;
    for i in 0..fruits {
        let (start, end, _) = stems[dice.below(stems.len())];
        let t = dice.within(0.45, 0.95);
        let at = (start.0 + (end.0 - start.0) * t + 4.0 * dice.normal(), start.1 + (end.1 - start.1) * t);
        let paint = Paint { albedo: vary(albedo, &mut dice, 0.3), slope: (0.0, 0.0), through: 0.0, gloss: 0.6 };
        canvas.dome(at, 0.0, (diameter, diameter), 0.1, paint, i as u32);
    }
    canvas.finish()
}

/// A tuft of blades, 128 pixels square: dry ones behind, green ones in front.
pub fn tuft(seed: u64, blades: usize, dry_share: f32) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = Canvas::clear(7, false);
    for blade in 0..blades {
        let foot = (64.0 + 17.0 * dice.normal(), 127.0);
        let height = dice.within(45.0, 122.0);
        let lean = 0.32 * dice.normal() + (foot.0 - 64.0) * 0.008;
        let droop = lean * dice.within(0.6, 2.2);
        let dry = (blade as f32) < dry_share * blades as f32;
        let colour = if dry { v3(0.33, 0.27, 0.14) } else { v3(0.125, 0.19, 0.055) };
        let slope = (0.5 * dice.normal(), 0.2 * dice.normal());
        let paint = Paint { albedo: vary(colour, &mut dice, 0.25), slope, through: 0.4, gloss: 0.3 };
        let middle = (foot.0 + 0.55 * height * lean, foot.1 - 0.58 * height);
        let tip = (middle.0 + 0.5 * height * droop, middle.1 - 0.42 * height * (1.0 - 0.25 * droop.abs()));
        let wide = dice.within(3.0, 6.5);
        canvas.stroke(foot, middle, (wide * 0.8, wide), paint);
        canvas.stroke(middle, tip, (wide, 0.8), paint);
    }
    canvas.finish()
}

/// A low weed seen from above: a rosette of broad leaves, 128 pixels square.
pub fn rosette(seed: u64) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = Canvas::clear(7, false);
    let leaves = 7 + dice.below(6);
    for leaf in 0..leaves {
        let angle = leaf as f32 * 2.4 + 0.3 * dice.normal();
        let (cos, sin) = cos_sin(angle);
        let length = dice.within(34.0, 60.0);
        let paint = Paint {
            albedo: vary(v3(0.10, 0.17, 0.045), &mut dice, 0.25),
            slope: (0.35 * cos, 0.35 * sin),
            through: 0.35,
            gloss: 0.4,
        };
        canvas.leaf((64.0 + 3.0 * cos, 64.0 + 3.0 * sin), angle, length, length * dice.within(0.35, 0.6), paint);
    }
    canvas.finish()
}

/// One fallen leaf, 64 pixels square, dead or (some) still green.
pub fn fallen_leaf(seed: u64) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = Canvas::clear(6, false);
    let tones =
        [v3(0.30, 0.17, 0.06), v3(0.20, 0.12, 0.06), v3(0.42, 0.30, 0.12), v3(0.16, 0.19, 0.06), v3(0.36, 0.14, 0.05)];
    let albedo = vary(tones[dice.below(tones.len())], &mut dice, 0.2);
    let paint = Paint { albedo, slope: (0.2 * dice.normal(), 0.2 * dice.normal()), through: 0.2, gloss: 0.15 };
    canvas.stroke((2.0, 32.0), (14.0, 32.0), (2.5, 2.5), Paint::matt(albedo * 0.6));
    canvas.leaf((9.0, 32.0), 0.12 * dice.normal(), 53.0, dice.within(17.0, 34.0), paint);
    canvas.finish()
}

/// One stone seen from above, 64 pixels square.
pub fn stone(seed: u64) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = Canvas::clear(6, false);
    let tones = [v3(0.42, 0.40, 0.36), v3(0.27, 0.24, 0.20), v3(0.58, 0.56, 0.52), v3(0.33, 0.26, 0.19)];
    let paint = Paint::matt(vary(tones[dice.below(tones.len())], &mut dice, 0.15));
    let shape = (dice.within(46.0, 56.0), dice.within(30.0, 50.0));
    canvas.dome((32.0, 32.0), dice.within(0.0, PI), shape, 0.5, paint, seed as u32);
    canvas.finish()
}
