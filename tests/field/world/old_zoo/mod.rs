//! The Old Zoo: a loop of about 210 m on a tarred path, through tree tunnels and clearings, past walls, cages and
//! façades.

mod edges;
mod grove;
mod tunnel;

use super::layout::{Floor, strew};
use super::plan::Plan;
use crate::chance::{Dice, fractal, noise};
use crate::vector::smoothstep;
use crate::world::route::{Beside, RouteLine};
use crate::world::scene::Scene;
use crate::world::terrain::{Soil, Terrain};
use tunnel::tunnel;

/// Length of the loop; the vocabulary route's is longer.
const LENGTH_M: f64 = 210.0;
const VOCABULARY_M: f64 = 330.0;
/// Half the width of the tarred path.
const PATH_M: f32 = 1.5;

/// Corners of the loop before it is stretched to its length: straights, wide bends and two tight ones.
const CORNERS: [[f64; 2]; 16] = [
    [0.0, 0.0],
    [13.0, 3.0],
    [27.0, 1.0],
    [38.0, -6.0],
    [51.0, -6.0],
    [60.0, 2.0],
    [58.0, 14.0],
    [47.0, 18.0],
    [43.0, 28.0],
    [50.0, 38.0],
    [42.0, 48.0],
    [27.0, 46.0],
    [19.0, 37.0],
    [12.0, 25.0],
    [-2.0, 22.0],
    [-9.0, 9.0],
];

/// The zoo: `longer` for the vocabulary route's own part of it.
pub fn plan(seed: u64, longer: bool) -> Plan {
    let route = route(seed, longer);
    let length = route.length_m() as f32;
    let salt = seed as u32;
    let terrain = Terrain::build(&route, 14.0, |x, y, beside| soil(x, y, beside, salt));
    let mut scene = Scene::new(seed);
    grove::plant(&mut scene, &route, &terrain, salt);
    edges::build(&mut scene, &route, &terrain);
    let floor = Floor { tufts: 5.0, weeds: 1.6, stones: 5.0, leaves: 26.0, tuft_m: (0.10, 0.34), dry: 0.3 };
    strew(&mut scene, &route, &terrain, (-3.4, 3.4), (0.0, length), &floor, 20);
    let beyond = Floor { tufts: 2.6, weeds: 0.3, stones: 0.3, leaves: 3.0, tuft_m: (0.15, 0.42), dry: 0.35 };
    strew(&mut scene, &route, &terrain, (3.4, 9.0), (0.0, length), &beyond, 21);
    strew(&mut scene, &route, &terrain, (-9.0, -3.4), (0.0, length), &beyond, 22);
    Plan { route, terrain, scene, net: None }
}

fn route(seed: u64, longer: bool) -> RouteLine {
    let mut dice = Dice::of(seed, 40);
    let mut jog = |amount: f64| f64::from(dice.normal()) * amount;
    let bent = CORNERS.map(|[x, y]| if longer { [-x + jog(2.0), y + jog(2.0)] } else { [x, y] });
    let wanted = if longer { VOCABULARY_M } else { LENGTH_M };
    let scale = wanted / RouteLine::through(&bent, true).length_m();
    RouteLine::through(&bent.map(|p| p.map(|v| v * scale)), true)
}

fn soil(x: f32, y: f32, beside: Beside, salt: u32) -> Soil {
    let across = beside.across_m.abs();
    let ragged = 0.5 * (fractal(x * 1.3, y * 1.3, 4, salt) - 0.5);
    let tarred = smoothstep(PATH_M + 0.10, PATH_M - 0.10, across + ragged);
    let broken = smoothstep(0.60, 0.68, fractal(x * 0.5, y * 0.5, 4, salt ^ 5));
    let drifts = smoothstep(0.5, 0.7, fractal(x * 0.8 + 9.0, y * 0.8, 4, salt ^ 6)) * smoothstep(0.3, PATH_M, across);
    let shade = tunnel(beside.along_m, salt);
    let bare = smoothstep(0.40, 0.62, fractal(x * 0.35, y * 0.35, 4, salt ^ 7));
    let tar = tarred * (1.0 - 0.85 * broken) * (1.0 - 0.75 * drifts);
    let leaves = (1.0 - tarred) * (0.25 + 0.75 * shade) * (0.4 + bare) + 0.8 * drifts * tarred;
    let grass = (1.0 - tarred) * (1.0 - 0.7 * shade) * (1.15 - bare);
    let gravel = 0.8 * tarred * broken
        + (1.0 - tarred) * smoothstep(0.5, 0.0, across - PATH_M) * 0.8
        + 0.15 * bare * (1.0 - tarred);
    let relief = 0.12 * (fractal(x * 0.16, y * 0.16, 3, salt ^ 8) - 0.5)
        + 0.03 * (1.0 - tarred) * (noise(x * 1.5, y * 1.5, salt ^ 2) - 0.5);
    Soil {
        height_m: relief + 0.03 * tarred * (1.0 - across / PATH_M).max(0.0),
        shares: [gravel, grass, leaves, tar],
        tint: 0.72 + 0.56 * fractal(x * 0.7, y * 0.7, 4, salt ^ 3),
    }
}
