//! A site as its module lays it out, before the common finish.

use super::route::RouteLine;
use super::scene::Scene;
use super::terrain::Terrain;
use crate::vector::V3;

/// A net over the rows of a farm.
#[derive(Debug, Clone, Copy)]
pub struct Net {
    /// Height above the ground.
    pub height_m: f32,
    /// Unit direction of the rows.
    pub along: V3,
    /// From where to where along the rows it reaches.
    pub reach_m: (f32, f32),
    /// How far to either side.
    pub half_width_m: f32,
}

/// A site as its module lays it out, before the common finish.
pub struct Plan {
    /// The line that the robot follows.
    pub route: RouteLine,
    /// The ground.
    pub terrain: Terrain,
    /// What stands there, without the ground.
    pub scene: Scene,
    /// The net overhead.
    pub net: Option<Net>,
}
