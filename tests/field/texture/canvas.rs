//! A square to paint on, with leaves, strokes and stones as its brushes. Coordinates are pixels; colours are albedo
//! (linear).

use super::{Texel, Texture};
use crate::chance::{Dice, noise};
use crate::vector::{V3, cos_sin, v3};

/// A texture in the making.
pub struct Canvas {
    log2: u32,
    size: i32,
    wraps: bool,
    texels: Vec<Texel>,
}

/// How a brush colours: albedo, tilt of the surface, light through it, shine.
#[derive(Debug, Clone, Copy)]
pub struct Paint {
    /// Albedo, red green blue.
    pub albedo: V3,
    /// Slope along x and y.
    pub slope: (f32, f32),
    /// Light that passes through, 0 to 1.
    pub through: f32,
    /// Shine, 0 to 1.
    pub gloss: f32,
}

impl Paint {
    /// A dull opaque colour.
    pub fn matt(albedo: V3) -> Self {
        Self { albedo, slope: (0.0, 0.0), through: 0.0, gloss: 0.0 }
    }

    fn texel(&self, shade: f32, bend: (f32, f32)) -> Texel {
        let root = |value: f32| ((value * shade).clamp(0.0, 1.0).sqrt() * 255.0) as u8;
        Texel {
            rgb: [root(self.albedo.x), root(self.albedo.y), root(self.albedo.z)],
            alpha: 255,
            slope: [self.slope.0 + bend.0, self.slope.1 + bend.1].map(Texel::stored_slope),
            through: (self.through * 255.0) as u8,
            gloss: (self.gloss * 255.0) as u8,
        }
    }
}

/// A greenish, yellowish or darker variant of a colour.
pub fn vary(albedo: V3, dice: &mut Dice, amount: f32) -> V3 {
    let light = 1.0 + amount * dice.normal();
    let warm = 0.5 * amount * dice.normal();
    v3(albedo.x * (light + warm).max(0.2), albedo.y * light.max(0.2), albedo.z * (light - warm).max(0.2))
}

impl Canvas {
    /// An empty canvas of `1 << log2` pixels square.
    pub fn clear(log2: u32, wraps: bool) -> Self {
        Self { log2, size: 1 << log2, wraps, texels: vec![Texel::default(); 1 << (2 * log2)] }
    }

    /// Columns, as a float.
    pub fn size(&self) -> f32 {
        self.size as f32
    }

    /// Sets every pixel by its coordinates.
    pub fn fill(&mut self, paint: impl Fn(f32, f32) -> (Paint, f32)) {
        for y in 0..self.size {
            for x in 0..self.size {
                let (paint, shade) = paint(x as f32, y as f32);
                self.texels[(y * self.size + x) as usize] = paint.texel(shade, (0.0, 0.0));
            }
        }
    }

    /// The finished texture.
    pub fn finish(self) -> Texture {
        Texture::new(self.log2, self.texels)
    }

    /// The texels, to be worked on as a field of heights and colours.
    pub fn texels_mut(&mut self) -> &mut [Texel] {
        &mut self.texels
    }

    fn set(&mut self, x: i32, y: i32, texel: Texel) {
        let (x, y) = if self.wraps { (x.rem_euclid(self.size), y.rem_euclid(self.size)) } else { (x, y) };
        if (0..self.size).contains(&x) && (0..self.size).contains(&y) {
            self.texels[(y * self.size + x) as usize] = texel;
        }
    }

    /// Visits the pixels within `reach` of (cx, cy) with their offsets in the frame turned by `angle_rad`: along,
    /// across.
    fn around(
        &mut self,
        cx: f32,
        cy: f32,
        angle_rad: f32,
        reach: f32,
        mut brush: impl FnMut(f32, f32) -> Option<Texel>,
    ) {
        let (cos, sin) = cos_sin(angle_rad);
        for y in (cy - reach).floor() as i32..=(cy + reach).ceil() as i32 {
            for x in (cx - reach).floor() as i32..=(cx + reach).ceil() as i32 {
                let (dx, dy) = (x as f32 + 0.5 - cx, y as f32 + 0.5 - cy);
                if let Some(texel) = brush(cos * dx + sin * dy, cos * dy - sin * dx) {
                    self.set(x, y, texel);
                }
            }
        }
    }

    /// A leaf from its stalk at (x, y), pointing along the angle, with midrib, side veins and a fold along the rib.
    pub fn leaf(&mut self, (x, y): (f32, f32), angle_rad: f32, length: f32, width: f32, paint: Paint) {
        let (cos, sin) = cos_sin(angle_rad);
        self.around(x + 0.5 * length * cos, y + 0.5 * length * sin, angle_rad, 0.5 * length + 1.0, |along, across| {
            let t = along / length + 0.5;
            if !(0.0..=1.0).contains(&t) {
                return None;
            }
            let half = 0.5 * width * 2.6 * t.sqrt() * (1.0 - t);
            if across.abs() > half.max(0.4) {
                return None;
            }
            let rib = across.abs() < 0.035 * width.max(14.0);
            let veins = ((t * 9.0 - across.abs() / width * 3.0).fract() - 0.5).abs() < 0.09;
            let edge = 1.0 - 0.25 * (across / half).abs();
            let shade = if rib {
                1.45
            } else if veins {
                1.13
            } else {
                edge
            };
            // The two halves fold upwards, so that one catches the light before the other.
            let fold = if across > 0.0 { 0.28 } else { -0.28 };
            Some(paint.texel(shade, (-fold * sin, fold * cos)))
        });
    }

    /// A tapering stroke from one point to another: a twig, a blade, a straw.
    pub fn stroke(&mut self, from: (f32, f32), to: (f32, f32), wide: (f32, f32), paint: Paint) {
        let (dx, dy) = (to.0 - from.0, to.1 - from.1);
        let length = (dx * dx + dy * dy).sqrt();
        let steps = (length * 1.5).ceil().max(1.0);
        for step in 0..=steps as i32 {
            let t = step as f32 / steps;
            let half = 0.5 * (wide.0 + (wide.1 - wide.0) * t);
            let (cx, cy) = (from.0 + dx * t, from.1 + dy * t);
            let inverse = 1.0 / length.max(1e-3);
            self.around(cx, cy, 0.0, half, |ox, oy| {
                let across = (ox * -dy + oy * dx) * inverse;
                let round = 0.5 * across / half.max(0.3);
                let inside = ox * ox + oy * oy <= half * half + 0.3;
                inside.then(|| paint.texel(1.0 - 0.35 * round.abs(), (-dy * inverse * round, dx * inverse * round)))
            });
        }
    }

    /// A round thing, fruit or stone: an ellipse with a domed surface and an uneven outline.
    pub fn dome(
        &mut self,
        (x, y): (f32, f32),
        angle_rad: f32,
        (long, wide): (f32, f32),
        rough: f32,
        paint: Paint,
        seed: u32,
    ) {
        let (cos, sin) = cos_sin(angle_rad);
        self.around(x, y, angle_rad, 0.5 * long * (1.0 + rough) + 1.0, |along, across| {
            let (a, b) = (2.0 * along / long, 2.0 * across / wide);
            let lump = rough * (noise(a * 1.7 + 9.0, b * 1.7, seed) - 0.5);
            let r2 = a * a + b * b;
            if r2 > (1.0 + lump) * (1.0 + lump) {
                return None;
            }
            let steep = 0.75 * r2.sqrt();
            let grain = 0.85 + 0.3 * noise(a * 4.0, b * 4.0, seed ^ 77);
            let bend = (steep * (a * cos - b * sin), steep * (a * sin + b * cos));
            Some(paint.texel(grain * (1.05 - 0.3 * r2), bend))
        });
    }
}
