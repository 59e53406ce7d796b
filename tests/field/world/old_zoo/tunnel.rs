//! Where trees close over the path.

use crate::chance::noise;
use crate::vector::smoothstep;

/// How much of a tree tunnel the path is in at `along`: 1 inside, 0 in a clearing.
pub fn tunnel(along: f32, salt: u32) -> f32 {
    smoothstep(0.42, 0.55, noise(along / 24.0, 3.3, salt ^ 91))
}
