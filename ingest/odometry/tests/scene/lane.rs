//! A lane between two textured walls, seen by an ideal stereo camera. The ray of each pixel is intersected with planes,
//! in closed form.

use furrow_model::{GreyImage, Se3, StereoRig};
use rayon::prelude::*;

/// A ZED 2i at a quarter of its pixels, the camera of the simulated field.
pub const RIG: StereoRig =
    StereoRig { width: 640, height: 360, focal_px: 264.0, cu_px: 319.5, cv_px: 179.5, baseline_m: 0.12 };

/// The camera's pose after `forward_m` and a turn of `yaw_rad` (world_from_camera; world axes as the first camera's).
pub fn pose(right_m: f64, forward_m: f64, yaw_rad: f64) -> Se3 {
    let half = yaw_rad / 2.0;
    Se3::from_quaternion([0.0, half.sin(), 0.0, half.cos()], [right_m, 0.0, forward_m])
}

/// Left and right image from `world_from_left`. `seed` selects the textures; `noise` is the greatest noise in grey
/// levels.
pub fn stereo(world_from_left: &Se3, seed: u64, noise: i32) -> (GreyImage, GreyImage) {
    let left_from_right = Se3 { translation_m: [RIG.baseline_m, 0.0, 0.0], ..Se3::IDENTITY };
    (image(world_from_left, seed, noise, 1), image(&world_from_left.compose(&left_from_right), seed, noise, 2))
}

fn image(world_from_camera: &Se3, seed: u64, noise: i32, eye: u64) -> GreyImage {
    let (width, height) = (RIG.width as usize, RIG.height as usize);
    let from = world_from_camera.translation_m;
    let turn = Se3 { translation_m: [0.0; 3], ..*world_from_camera };
    let pixel = |i: usize| {
        let (u, v) = ((i % width) as f64, (i / width) as f64);
        let ray = turn.apply([(u - RIG.cu_px) / RIG.focal_px, (v - RIG.cv_px) / RIG.focal_px, 1.0]);
        let grey = 20.0 + 215.0 * radiance(from, ray, seed);
        let key = hash(from[2].to_bits() ^ eye, i as i64, seed as i64);
        let disturbance = if noise > 0 { (key % (2 * noise as u64 + 1)) as i32 - noise } else { 0 };
        (grey as i32 + disturbance).clamp(0, 255) as u8
    };
    GreyImage { width, height, pixels: (0..width * height).into_par_iter().map(pixel).collect() }
}

/// The nearest of ground (0.75 m below), walls (2 m to each side) and backdrop (60 m ahead).
fn radiance(from: [f64; 3], ray: [f64; 3], seed: u64) -> f64 {
    let planes = [(1, 0.75), (0, -2.0), (0, 2.0), (1, -3.0), (2, 60.0)];
    let hits = planes.iter().enumerate().map(|(i, &(axis, at))| ((at - from[axis]) / ray[axis], i, axis));
    let nearest = hits.filter(|hit| hit.0 > 1e-6).min_by(|a, b| a.0.total_cmp(&b.0));
    let Some((range, plane, axis)) = nearest else { return 0.5 };
    let at: [f64; 3] = std::array::from_fn(|k| from[k] + range * ray[k]);
    let (a, b) = match axis {
        0 => (at[1], at[2]),
        1 => (at[0], at[2]),
        _ => (at[0], at[1]),
    };
    texture(a, b, range / RIG.focal_px, seed * 16 + plane as u64)
}

/// Value noise of several cell sizes. Cells smaller than two pixels (`pixel_m` each) are faded out against aliasing.
fn texture(a: f64, b: f64, pixel_m: f64, seed: u64) -> f64 {
    let (mut sum, mut weights) = (0.0, 1e-9);
    for octave in 0..8_u64 {
        let cell = 0.02 * f64::from(1_u32 << octave);
        let weight = (cell / (2.0 * pixel_m) - 1.0).clamp(0.0, 1.0);
        if weight == 0.0 {
            continue;
        }
        sum += weight * (value_noise(a / cell, b / cell, seed * 64 + octave) - 0.5);
        weights += weight;
    }
    (0.5 + 1.8 * sum / weights.max(1.0).sqrt()).clamp(0.0, 1.0)
}

fn value_noise(a: f64, b: f64, seed: u64) -> f64 {
    let (i, j) = (a.floor(), b.floor());
    let smooth = |t: f64| t * t * (3.0 - 2.0 * t);
    let (s, t) = (smooth(a - i), smooth(b - j));
    let at = |di: i64, dj: i64| hash(seed, i as i64 + di, j as i64 + dj) as f64 / u64::MAX as f64;
    (1.0 - t) * ((1.0 - s) * at(0, 0) + s * at(1, 0)) + t * ((1.0 - s) * at(0, 1) + s * at(1, 1))
}

/// SplitMix64's finaliser over the three.
fn hash(seed: u64, i: i64, j: i64) -> u64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ (i as u64).wrapping_mul(0xbf58_476d_1ce4_e5b9)
        ^ (j as u64).wrapping_mul(0x94d0_49bb_1331_11eb);
    for _ in 0..2 {
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    }
    z ^ (z >> 31)
}
