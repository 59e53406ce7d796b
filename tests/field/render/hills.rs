//! Hills and woods on the horizon, too far to be built of facets.

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
pub struct Slope {
    /// Albedo.
    pub albedo: V3,
    /// How far its normal leans to the right and upwards, seen from the field.
    pub lean: (f32, f32),
    /// Share of the air's light in what is seen.
    pub haze: f32,
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
    /// What is seen in the direction `d`; `None` for sky.
    pub fn at(&self, d: V3) -> Option<&Slope> {
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
