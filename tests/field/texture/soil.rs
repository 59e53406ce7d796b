//! The four grounds that repeat every two metres: gravelly soil, short grass, mulch, tar. Each texel's `through` is its
//! height.

use super::canvas::{Canvas, Paint, vary};
use super::{Texel, Texture};
use crate::chance::{Dice, periodic_fractal};
use crate::vector::{V3, cos_sin, v3};
use std::f32::consts::TAU;

/// Length of one repeat in metres.
pub const REPEAT_M: f32 = 2.048;
const LOG2: u32 = 9;

/// Packed earth with pebbles of all sizes, straws and small dead leaves.
pub fn gravel(seed: u64) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = earth(v3(0.245, 0.18, 0.12), seed as u32);
    for i in 0..2600 {
        let size = 3.0 + 9.0 * dice.unit() * dice.unit() * dice.unit();
        pebble(&mut canvas, &mut dice, size, i);
    }
    for i in 0..90 {
        let size = dice.within(9.0, 19.0);
        pebble(&mut canvas, &mut dice, size, i);
    }
    for _ in 0..500 {
        straw(&mut canvas, &mut dice, (8.0, 30.0), v3(0.36, 0.28, 0.15));
    }
    for _ in 0..160 {
        scrap(&mut canvas, &mut dice, (8.0, 16.0));
    }
    with_relief(canvas, 1.0)
}

/// Short grass and clover over earth.
pub fn grass(seed: u64) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = earth(v3(0.13, 0.115, 0.06), seed as u32);
    for blade in 0..13_000 {
        let green = if dice.chance(0.24) { v3(0.27, 0.23, 0.10) } else { v3(0.115, 0.185, 0.045) };
        let depth = 0.55 + 0.6 * (blade as f32 / 13_000.0);
        let long = dice.within(9.0, 26.0);
        let from = (dice.unit() * canvas.size(), dice.unit() * canvas.size());
        let (cos, sin) = cos_sin(dice.unit() * TAU);
        let paint = Paint {
            albedo: vary(green, &mut dice, 0.22) * depth,
            slope: (0.45 * dice.normal(), 0.45 * dice.normal()),
            through: 0.5 * depth,
            gloss: 0.15,
        };
        canvas.stroke(from, (from.0 + long * cos, from.1 + long * sin), (2.6, 1.0), paint);
    }
    for _ in 0..150 {
        let at = (dice.unit() * canvas.size(), dice.unit() * canvas.size());
        for third in 0..3 {
            let angle = third as f32 * TAU / 3.0 + dice.unit();
            let paint = Paint { through: 0.6, ..Paint::matt(vary(v3(0.10, 0.2, 0.05), &mut dice, 0.25)) };
            canvas.leaf(at, angle, dice.within(8.0, 14.0), 8.0, paint);
        }
    }
    with_relief(canvas, 0.5)
}

/// Bark chips and dead leaves, several layers.
pub fn mulch(seed: u64) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = earth(v3(0.10, 0.07, 0.045), seed as u32);
    for _ in 0..2400 {
        scrap(&mut canvas, &mut dice, (10.0, 30.0));
    }
    for _ in 0..1500 {
        straw(&mut canvas, &mut dice, (8.0, 34.0), v3(0.22, 0.15, 0.085));
    }
    with_relief(canvas, 0.8)
}

/// Worn tar: grains, patches, cracks.
pub fn tar(seed: u64) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = Canvas::clear(LOG2, true);
    let salt = seed as u32;
    let size = canvas.size();
    canvas.fill(|x, y| {
        let (u, v) = (x / size, y / size);
        let patch = periodic_fractal(u * 4.0, v * 4.0, 4, 4, salt);
        let grain = periodic_fractal(u * 170.0, v * 170.0, 170, 2, salt ^ 2);
        let bend = periodic_fractal(u * 6.0, v * 6.0, 6, 4, salt ^ 9);
        let crack =
            (bend - 0.5).abs() < 0.004 || (periodic_fractal(u * 3.0, v * 3.0, 3, 5, salt ^ 14) - 0.5).abs() < 0.003;
        let paint =
            Paint { through: if crack { 0.1 } else { 0.5 + 0.3 * grain }, ..Paint::matt(v3(0.135, 0.13, 0.125)) };
        (paint, (0.7 + 0.6 * patch) * (0.6 + 0.8 * grain) * if crack { 0.35 } else { 1.0 })
    });
    for i in 0..2600 {
        let size = 2.0 + 3.5 * dice.unit();
        pebble(&mut canvas, &mut dice, size, i);
    }
    with_relief(canvas, 0.35)
}

fn earth(albedo: V3, seed: u32) -> Canvas {
    let mut canvas = Canvas::clear(LOG2, true);
    let size = canvas.size();
    canvas.fill(|x, y| {
        let (u, v) = (x / size, y / size);
        let broad = periodic_fractal(u * 5.0, v * 5.0, 5, 5, seed);
        let grain = periodic_fractal(u * 90.0, v * 90.0, 90, 3, seed ^ 7);
        (Paint { through: 0.15 + 0.3 * broad, ..Paint::matt(albedo) }, (0.55 + 0.8 * broad) * (0.6 + 0.8 * grain))
    });
    canvas
}

fn pebble(canvas: &mut Canvas, dice: &mut Dice, size: f32, seed: u32) {
    let tones =
        [v3(0.36, 0.33, 0.29), v3(0.22, 0.18, 0.14), v3(0.52, 0.50, 0.46), v3(0.28, 0.19, 0.13), v3(0.17, 0.16, 0.15)];
    let paint = Paint { through: 0.5 + 0.02 * size, ..Paint::matt(vary(tones[dice.below(tones.len())], dice, 0.15)) };
    let at = (dice.unit() * canvas.size(), dice.unit() * canvas.size());
    canvas.dome(at, dice.unit() * TAU, (size, size * dice.within(0.55, 0.95)), 0.5, paint, seed);
}

fn straw(canvas: &mut Canvas, dice: &mut Dice, long: (f32, f32), albedo: V3) {
    let from = (dice.unit() * canvas.size(), dice.unit() * canvas.size());
    let (cos, sin) = cos_sin(dice.unit() * TAU);
    let length = dice.within(long.0, long.1);
    let paint = Paint { through: 0.6, ..Paint::matt(vary(albedo, dice, 0.35)) };
    canvas.stroke(from, (from.0 + length * cos, from.1 + length * sin), (2.0, 1.2), paint);
}

fn scrap(canvas: &mut Canvas, dice: &mut Dice, long: (f32, f32)) {
    let tones = [
        v3(0.20, 0.12, 0.065),
        v3(0.28, 0.18, 0.09),
        v3(0.13, 0.085, 0.055),
        v3(0.34, 0.25, 0.14),
        v3(0.17, 0.15, 0.12),
    ];
    let at = (dice.unit() * canvas.size(), dice.unit() * canvas.size());
    let length = dice.within(long.0, long.1);
    let paint = Paint {
        albedo: vary(tones[dice.below(tones.len())], dice, 0.25),
        slope: (0.4 * dice.normal(), 0.4 * dice.normal()),
        through: dice.within(0.3, 0.7),
        gloss: 0.0,
    };
    canvas.leaf(at, dice.unit() * TAU, length, length * dice.within(0.3, 0.6), paint);
}

/// Adds the slopes of the heights to those painted.
fn with_relief(mut canvas: Canvas, strength: f32) -> Texture {
    let size = 1_usize << LOG2;
    let texels = canvas.texels_mut();
    let heights: Vec<f32> = texels.iter().map(|texel| f32::from(texel.through)).collect();
    let at = |x: usize, y: usize| heights[(y & (size - 1)) * size + (x & (size - 1))];
    for (i, texel) in texels.iter_mut().enumerate() {
        let (x, y) = (i % size, i / size);
        let slope =
            [at(x + size - 1, y) - at(x + 1, y), at(x, y + size - 1) - at(x, y + 1)].map(|d| d * strength * 0.6);
        texel.slope = [0, 1].map(|k| (f32::from(texel.slope[k]) + slope[k]).clamp(1.0, 255.0) as u8);
        *texel = Texel { alpha: 255, gloss: 0, ..*texel };
    }
    canvas.finish()
}
