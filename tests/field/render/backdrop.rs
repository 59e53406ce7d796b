//! What is too far to be built of facets: hills and woods on the horizon, and the net overhead.

use super::Stage;
use crate::chance::{fractal, lattice, periodic_fractal};
use crate::vector::{V3, smoothstep, v3};

const COLUMNS: usize = 4096;
const ROWS: usize = 96;
/// The panorama reaches from here up to `TOP`, as sines of the elevation.
const BOTTOM: f32 = -0.01;
const TOP: f32 = 0.14;
/// Sine of the elevation above which there are no hills.
pub const HILLTOPS: f32 = TOP;

/// A panorama of hills: what is seen there, or sky.
pub struct Hills {
    texels: Vec<Option<Slope>>,
}

/// A piece of a hill or of the woods before it.
#[derive(Clone, Copy)]
struct Slope {
    albedo: V3,
    /// How far its normal leans to the right and upwards, seen from the field.
    lean: (f32, f32),
    /// Share of the air's light in what is seen.
    haze: f32,
}

impl Hills {
    /// The horizon of the world `seed`.
    pub fn paint(seed: u32) -> Hills {
        // The sky line repeats after a full turn.
        let sky_line = |column: usize| {
            let around = column as f32 / COLUMNS as f32;
            let ridge = |waves: i32, salt: u32| periodic_fractal(around * waves as f32, 0.3, waves, 5, seed ^ salt);
            (0.02 + 0.11 * (ridge(9, 1) - 0.32).max(0.0), 0.010 + 0.028 * ridge(60, 7) + 0.008 * ridge(700, 8))
        };
        let lines: Vec<(f32, f32)> = (0..COLUMNS).map(sky_line).collect();
        let texel = |i: usize| {
            let (column, row) = ((i % COLUMNS) as f32, (i / COLUMNS) as f32);
            let up = BOTTOM + (TOP - BOTTOM) * (row + 0.5) / ROWS as f32;
            let (far, tree_tops) = lines[i % COLUMNS];
            let rough = |across: f32, upward: f32, salt: u32| {
                let at = |dx: f32, dy: f32| fractal(column * across + dx, row * upward + dy, 3, seed ^ salt);
                (4.0 * (at(0.35, 0.0) - at(-0.35, 0.0)), 4.0 * (at(0.0, 0.35) - at(0.0, -0.35)))
            };
            if up < tree_tops {
                let grain = fractal(column * 0.35, row * 0.5, 3, seed ^ 3);
                let shade = 0.65 + 0.5 * grain + 0.2 * lattice(column as i32 / 3, row as i32 / 2, seed);
                Some(Slope { albedo: v3(0.045, 0.062, 0.028) * shade, lean: rough(0.35, 0.5, 3), haze: 0.12 })
            } else if up < far {
                let field = fractal(column * 0.02, row * 0.25, 4, seed ^ 5);
                let albedo = v3(0.12, 0.13, 0.06).mix(v3(0.24, 0.20, 0.13), smoothstep(0.4, 0.6, field));
                Some(Slope { albedo, lean: rough(0.03, 0.12, 6), haze: 0.75 * (0.62 + 0.25 * (up / far)) })
            } else {
                None
            }
        };
        Hills { texels: (0..COLUMNS * ROWS).map(texel).collect() }
    }

    #[inline(always)]
    fn at(&self, d: V3) -> Option<&Slope> {
        let row = ((d.z - BOTTOM) * (ROWS as f32 / (TOP - BOTTOM))) as i32;
        if d.z < BOTTOM || row >= ROWS as i32 {
            return None;
        }
        // The angle round the horizon, measured along a diamond instead of a circle: no arc tangent needed.
        let flat = d.x / (d.x.abs() + d.y.abs()).max(1e-6);
        let turn = if d.y >= 0.0 { 0.25 - 0.25 * flat } else { 0.75 + 0.25 * flat };
        let column = (turn * COLUMNS as f32) as usize & (COLUMNS - 1);
        self.texels[row as usize * COLUMNS + column].as_ref()
    }
}

/// Radiance of sky and horizon in the direction `d`, seen from `from` through the net if there is one, by a pixel that is `width`
/// wide at a distance of one.
#[inline(always)]
pub fn behind_all(stage: &Stage, from: V3, d: V3, width: f32) -> V3 {
    let sky = stage.sky;
    let radiance = match stage.hills.at(d) {
        Some(slope) => {
            // A slope faces the field, and leans its own way: the sun brings out other sides of it hour by hour.
            let right = v3(d.y, -d.x, 0.0);
            let normal = (v3(-d.x, -d.y, 0.6) + right * slope.lean.0 + V3::UP * slope.lean.1).unit();
            let light = sky.ambient(normal) + sky.sun * (normal.dot(sky.to_sun).max(0.0) + 0.06);
            let lit = slope.albedo.times(light) * (1.0 / std::f32::consts::PI);
            lit.mix(sky.radiance(v3(d.x, d.y, 0.06).unit()), slope.haze)
        }
        None => sky.radiance(d),
    };
    through_net(stage, (from, d), radiance, width)
}

/// Thickness of the wires that hold the net.
const WIRE_M: f32 = 0.004;

/// What is left of `radiance` behind the net: a veil that grows towards the horizon, with its seams and threads.
#[inline(always)]
fn through_net(stage: &Stage, (from, d): (V3, V3), radiance: V3, width: f32) -> V3 {
    let Some(net) = &stage.world.net else { return radiance };
    if d.z < 0.03 {
        return radiance;
    }
    let t = (net.height_m - from.z) / d.z;
    let p = from + d * t;
    let along = p.dot(net.along);
    let across = p.x * net.along.y - p.y * net.along.x;
    if along < net.reach_m.0 || along > net.reach_m.1 || across.abs() > net.half_width_m {
        return radiance;
    }
    // 12 % of the net is thread, seen at a slant.
    let veil = 1.0 - 1.0 / (1.0 + 0.14 * (1.0 / d.z).min(9.0));
    // The pixel on the net: as wide as it is across the view, longer along it. A thread is spread over a pixel to either side, so that it does
    // not come and go between samples.
    let flat = v3(d.x, d.y, 0.0).unit();
    let spread_m = |axis: V3| {
        let (with, beside) = (flat.dot(axis) / d.z, flat.x * axis.y - flat.y * axis.x);
        0.004 + 1.1 * width * t * (with * with + beside * beside).sqrt()
    };
    let (along_m, across_m) = (spread_m(net.along), spread_m(v3(net.along.y, -net.along.x, 0.0)));
    let seam = |x: f32, every: f32, spread_m: f32| {
        let off = (x / every - (x / every).round()).abs() * every;
        (1.0 - off / spread_m).clamp(0.0, 1.0) * (WIRE_M / spread_m).min(1.0)
    };
    let lengthways = seam(across + 1.5, 3.0, across_m).max(0.6 * seam(across, 1.0, across_m));
    let crossways = seam(along - 0.45, 8.0, along_m).max(0.6 * seam(along, 1.0, along_m));
    let threads = lengthways.max(crossways);
    let sky = stage.sky;
    let glow = (sky.overhead * 0.10 + sky.sun * (0.05 * sky.to_sun.z.max(0.0))) * (0.8 / std::f32::consts::PI);
    radiance.mix(glow, veil) * (1.0 - 0.75 * threads)
}
