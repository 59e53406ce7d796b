//! Textures of made things and stems: bark, weathered wood, brick, plaster, rusty bars, wire mesh, corrugated iron.

use super::Texture;
use super::canvas::{Canvas, Paint, vary};
use crate::chance::{Dice, lattice, periodic_fractal};
use crate::vector::{V3, v3};

/// Bark with furrows along v; one repeat is one turn round the trunk.
pub fn bark(albedo: V3, seed: u32) -> Texture {
    let mut canvas = Canvas::clear(7, true);
    canvas.fill(|x, y| {
        let (u, v) = (x / 128.0, y / 128.0);
        let twist = 0.6 * periodic_fractal(u * 4.0, v * 4.0, 4, 3, seed);
        let ridge = periodic_fractal(u * 8.0 + twist * 2.0, v * 2.0, 8, 4, seed ^ 5);
        let fine = periodic_fractal(u * 32.0, v * 16.0, 16, 2, seed ^ 9);
        let deep = ((ridge - 0.5).abs() * 5.0).min(1.0);
        let lichen = periodic_fractal(u * 4.0, v * 4.0, 4, 3, seed ^ 21) > 0.66;
        let colour = if lichen { v3(0.30, 0.32, 0.25) } else { albedo };
        let paint = Paint { slope: (1.4 * (ridge - 0.5), 0.6 * (fine - 0.5)), ..Paint::matt(colour) };
        (paint, (0.35 + 0.75 * deep) * (0.7 + 0.6 * fine))
    });
    canvas.finish()
}

/// Grey weathered planks or a post: grain along v, knots, cracks.
pub fn wood(seed: u32) -> Texture {
    let mut canvas = Canvas::clear(7, true);
    canvas.fill(|x, y| {
        let (u, v) = (x / 128.0, y / 128.0);
        let bend = periodic_fractal(u * 2.0, v * 2.0, 2, 3, seed);
        let grain = periodic_fractal(u * 16.0 + bend * 3.0, v * 2.0, 16, 4, seed ^ 3);
        let crack = if ((grain - 0.5).abs()) < 0.012 { 0.35 } else { 1.0 };
        let stain = periodic_fractal(u * 2.0, v * 4.0, 2, 4, seed ^ 8);
        let colour = v3(0.30, 0.25, 0.19).mix(v3(0.20, 0.15, 0.10), stain);
        let paint = Paint { slope: (1.2 * (grain - 0.5), 0.0), ..Paint::matt(colour) };
        (paint, crack * (0.55 + 0.85 * grain))
    });
    canvas.finish()
}

/// Bricks, 4 columns by 8 courses in one repeat, each of its own colour, with pale mortar and patches of old render.
pub fn brick(seed: u32) -> Texture {
    let mut canvas = Canvas::clear(8, true);
    canvas.fill(|x, y| {
        let course = (y / 32.0) as i32;
        let shifted = x + if course % 2 == 0 { 0.0 } else { 32.0 };
        let column = (shifted / 64.0) as i32 % 4;
        let (bx, by) = (shifted % 64.0, y % 32.0);
        let rough = periodic_fractal(x / 16.0, y / 16.0, 16, 4, seed);
        let edge = bx.min(64.0 - bx).min(by).min(32.0 - by);
        let tone = lattice(column, course, seed ^ 4);
        let render = periodic_fractal(x / 64.0, y / 64.0, 4, 4, seed ^ 31) > 0.64;
        if render {
            return (Paint::matt(v3(0.44, 0.40, 0.34)), 0.7 + 0.5 * rough);
        }
        if edge < 2.2 + 2.0 * rough {
            return (Paint::matt(v3(0.36, 0.33, 0.29)), 0.6 + 0.5 * rough);
        }
        let tilt = (0.3 * (lattice(column, course, seed ^ 6) - 0.5) + 0.8 * (rough - 0.5), 0.6 * (rough - 0.5));
        let colour = v3(0.30, 0.115, 0.07).mix(v3(0.42, 0.22, 0.14), tone) * (0.6 + 0.6 * tone);
        (Paint { slope: tilt, ..Paint::matt(colour) }, 0.65 + 0.6 * rough)
    });
    canvas.finish()
}

/// Stained plaster with cracks and runs of damp.
pub fn plaster(albedo: V3, seed: u32) -> Texture {
    let mut canvas = Canvas::clear(8, true);
    canvas.fill(|x, y| {
        let (u, v) = (x / 256.0, y / 256.0);
        let broad = periodic_fractal(u * 3.0, v * 3.0, 3, 5, seed);
        let runs = periodic_fractal(u * 12.0, v * 2.0, 2, 3, seed ^ 6);
        let crack = periodic_fractal(u * 5.0, v * 5.0, 5, 5, seed ^ 12);
        let fine = periodic_fractal(u * 64.0, v * 64.0, 64, 2, seed ^ 3);
        let dark = if (crack - 0.5).abs() < 0.005 { 0.4 } else { 1.0 };
        let bare = broad > 0.66;
        let colour =
            if bare { v3(0.30, 0.22, 0.16) } else { albedo.mix(v3(0.16, 0.15, 0.12), 0.75 * (runs - 0.35).max(0.0)) };
        (
            Paint { slope: (0.8 * (fine - 0.5), 0.8 * (broad - 0.5)), ..Paint::matt(colour) },
            dark * (0.6 + 0.4 * fine + 0.45 * broad),
        )
    });
    canvas.finish()
}

/// Upright rusty bars with two cross rails; the rest is open.
pub fn bars(seed: u64) -> Texture {
    let mut dice = Dice::new(seed);
    let mut canvas = Canvas::clear(7, true);
    for bar in 0..8 {
        let x = bar as f32 * 16.0 + 8.0;
        let paint = Paint { gloss: 0.3, ..Paint::matt(vary(v3(0.17, 0.10, 0.06), &mut dice, 0.3)) };
        canvas.stroke((x, 0.0), (x, 128.0), (4.0, 4.0), paint);
    }
    for y in [14.0, 108.0] {
        canvas.stroke((0.0, y), (128.0, y), (6.0, 6.0), Paint::matt(v3(0.14, 0.09, 0.06)));
    }
    canvas.finish()
}

/// Diamonds of galvanised wire.
pub fn mesh() -> Texture {
    let mut canvas = Canvas::clear(7, true);
    let paint = Paint { gloss: 0.3, ..Paint::matt(v3(0.30, 0.30, 0.29)) };
    for k in -4..8 {
        let x = k as f32 * 32.0;
        canvas.stroke((x, 0.0), (x + 128.0, 128.0), (2.6, 2.6), paint);
        canvas.stroke((x, 128.0), (x + 128.0, 0.0), (2.6, 2.6), paint);
    }
    canvas.finish()
}

/// Corrugated iron, rusting from the edges.
pub fn iron(seed: u32) -> Texture {
    let mut canvas = Canvas::clear(7, true);
    canvas.fill(|x, y| {
        let (u, v) = (x / 128.0, y / 128.0);
        let wave = libm::sinf(u * 8.0 * std::f32::consts::TAU);
        let rust = periodic_fractal(u * 4.0, v * 4.0, 4, 5, seed);
        let colour = v3(0.33, 0.34, 0.35).mix(v3(0.24, 0.11, 0.05), ((rust - 0.4) * 4.0).clamp(0.0, 1.0));
        (Paint { slope: (0.6 * wave, 0.0), gloss: 0.3, ..Paint::matt(colour) }, 0.85 + 0.15 * wave)
    });
    canvas.finish()
}
