//! What a picture is made of, and what it is.

use super::hills::Hills;
use super::shadow::ShadowMap;
use crate::sky::Sky;
use crate::world::World;

/// A picture of radiances, W/m^2/sr, red green blue, row by row.
#[derive(Debug, Clone)]
pub struct Radiance {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` colours.
    pub pixels: Vec<[f32; 3]>,
    /// One over the depth (along the optical axis, in metres) of what is seen in each pixel, 0 for the sky; empty
    /// behind a lens.
    pub inverse_depth: Vec<f32>,
}

/// All that stays the same during a traversal.
pub struct Stage<'a> {
    /// The world.
    pub world: &'a World,
    /// The light.
    pub sky: &'a Sky,
    /// The sun's shadows.
    pub shadows: &'a ShadowMap,
    /// The horizon.
    pub hills: &'a Hills,
    /// How far the wind moves things, about 1 in a light breeze.
    pub wind: f32,
}
