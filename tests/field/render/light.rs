//! The light that leaves points: sun through shadows, sky, headlights, haze. Many points are lit at once, step by step,
//! in loops without branches that become vector instructions; what is looked up in memory is looked up between them.

use super::eye::Eye;
use super::stage::Stage;
use crate::lanes::{LANES, Lanes, Vectors};
use crate::vector::{V3, smoothstep, v3};
use std::f32::consts::PI;

/// Sunlight that was scattered on its way, as shares of the sun's on a surface that faces it: by leaves under the
/// thickest foliage, by haze in the open, and by leaves where there is both, times the shares of the sky that are open
/// and covered. It comes from round the sun, so that shade changes with the hour as sunlit ground does; even light of
/// the sky as bright would make all hours of a wood alike.
const UNDER_LEAVES: f32 = 0.0005;
const BY_HAZE: f32 = 0.012;
const BETWEEN_LEAVES: f32 = 0.06;
/// How many times more of it there is under leaves the more the sun shines in between the stems instead of through the
/// crowns: at a slant, and at sunrise.
const SLANTING: f32 = 9.0;
const RISING: f32 = 40.0;
/// Share of the sun that shines through the gaps of the thickest foliage when it stands overhead, and how much sooner
/// than the sky it is all seen: most gaps there are smaller than its disc, which then shines through them in part.
const THROUGH_GAPS: f32 = 0.15;
const SOONER: f32 = 12.0;

/// Luminous power of one headlight, in the units of the sun: W/sr in its middle.
const HEADLIGHT_W_SR: f32 = 38.0;

/// Points to be lit. Lanes that are not used hold anything.
pub struct Points {
    /// Where in the world.
    pub place: Vectors,
    /// Unit vectors from the points to the eye.
    pub to_eye: Vectors,
    /// Albedo.
    pub albedo: Vectors,
    /// Normals, of any length.
    pub normal: Vectors,
    /// Share of the sky's light that arrives.
    pub open: Lanes,
    /// Light that passes through as through a leaf.
    pub through: Lanes,
    /// Shine.
    pub gloss: Lanes,
    /// Distance from the eye in metres.
    pub distance_m: Lanes,
}

impl Points {
    /// No points.
    pub const NONE: Points = Points {
        place: Vectors::ZERO,
        to_eye: Vectors::ZERO,
        albedo: Vectors::ZERO,
        normal: Vectors::ZERO,
        open: [0.0; LANES],
        through: [0.0; LANES],
        gloss: [0.0; LANES],
        distance_m: [0.0; LANES],
    };
}

/// Light on its way: what arrives at the points, and what they mirror.
struct Light {
    arriving: Vectors,
    shine: Vectors,
}

/// The radiance of the first `count` points.
#[inline(always)]
pub fn leaving(stage: &Stage, eye: &Eye, points: &mut Points, count: usize) -> Vectors {
    let sky = stage.sky;
    let mut light = Light { arriving: Vectors::ZERO, shine: Vectors::ZERO };
    for k in 0..LANES {
        let n = points.normal.at(k).unit();
        points.normal.set(k, n);
        light.arriving.set(k, sky.ambient(n) * points.open[k]);
    }
    if sky.to_sun.z > 0.0 {
        scattered(stage, points, &mut light);
        sunlight(stage, points, count, &mut light);
    }
    if sky.headlights {
        headlights(eye, points, &mut light);
    }
    let mut radiance = Vectors::ZERO;
    for k in 0..LANES {
        let leaving = points.albedo.at(k).times(light.arriving.at(k)) * (1.0 / PI) + light.shine.at(k);
        // Haze: half the light is scattered away over 2 km; under a canopy little light scatters in.
        let haze = 1.0 - 1.0 / (1.0 + points.distance_m[k] * (1.0 / 2000.0));
        radiance.set(k, leaving.mix(sky.overhead * (points.open[k] / PI), haze));
    }
    radiance
}

/// What leaves and haze scatter of the sun's light: greener the more leaves there are, over twice as strong on what
/// faces the sun as on the mean of all sides.
#[inline(always)]
fn scattered(stage: &Stage, points: &Points, light: &mut Light) {
    let (sun, to_sun) = (stage.sky.sun, stage.sky.to_sun);
    let slant = 1.0 - to_sun.z;
    let slant2 = slant * slant;
    let slant8 = slant2 * slant2 * slant2 * slant2;
    let under = UNDER_LEAVES * (1.0 + SLANTING * slant2 + RISING * slant8);
    for k in 0..LANES {
        let (open, facing) = (points.open[k], 0.5 + 0.5 * points.normal.at(k).dot(to_sun));
        let covered = 1.0 - open;
        let share = under * covered + BY_HAZE * open + BETWEEN_LEAVES * open * covered;
        let green = v3(1.0 - 0.08 * covered, 1.0, 1.0 - 0.2 * covered);
        let forward = 0.3 + 1.4 * facing * facing;
        light.arriving.set(k, light.arriving.at(k) + sun.times(green) * (share * forward));
    }
}

#[inline(always)]
fn sunlight(stage: &Stage, points: &Points, count: usize, light: &mut Light) {
    let (sun, to_sun) = (stage.sky.sun, stage.sky.to_sun);
    let (mut cosine, mut off) = ([0.0; LANES], Vectors::ZERO);
    for (k, cosine) in cosine.iter_mut().enumerate() {
        let n = points.normal.at(k);
        let facing = n.dot(to_sun);
        *cosine = facing.max(0.0) + 0.55 * points.through[k] * (-facing).max(0.0) + 0.12 * points.through[k];
        off.set(k, points.place.at(k) + n * 0.02);
    }
    let lit = stage.shadows.lit(&off, &cosine, count);
    let netted = netted(stage, points);
    for k in 0..LANES {
        let n = points.normal.at(k);
        let through_gaps = (THROUGH_GAPS + SOONER * points.open[k]).min(1.0);
        let gaps = 1.0 + (through_gaps - 1.0) * to_sun.z;
        let direct = sun * (gaps * if netted[k] > 0.0 { 0.75 * lit[k] } else { lit[k] });
        // The net scatters part of the sun's light it takes.
        let scattered = sun * (netted[k] * 0.10 * to_sun.z * points.open[k] * (0.5 + 0.5 * n.z));
        light.arriving.set(k, light.arriving.at(k) + direct * cosine[k] + scattered);
        light.shine.set(k, direct * (points.gloss[k] * sheen(n, to_sun, points.to_eye.at(k))));
    }
}

/// 1 for the points under the net, 0 for the others.
#[inline(always)]
fn netted(stage: &Stage, points: &Points) -> Lanes {
    let mut netted = [0.0; LANES];
    if let Some(net) = &stage.world.net {
        for (k, netted) in netted.iter_mut().enumerate() {
            let place = points.place.at(k);
            let along = place.dot(net.along);
            let under = (place.z < net.height_m) & (along > net.reach_m.0) & (along < net.reach_m.1);
            *netted = if under { 1.0 } else { 0.0 };
        }
    }
    netted
}

/// A soft highlight round the mirror direction.
#[inline(always)]
fn sheen(n: V3, to_light: V3, to_eye: V3) -> f32 {
    let half = (to_light + to_eye).unit();
    let c = n.dot(half).max(0.0);
    let c4 = c * c * c * c;
    let c16 = c4 * c4 * c4 * c4;
    0.055 * c16 * c4
}

/// The robot's two lamps, a quarter of a metre to either side of the camera, with a lobe of cos^8 and 1/r^2: white
/// irradiance and shine.
#[inline(always)]
fn headlights(eye: &Eye, points: &Points, light: &mut Light) {
    let (mut sum, mut shine) = ([0.0; LANES], [0.0; LANES]);
    for side in [-0.25, 0.25] {
        let lamp = eye.position + eye.right * side + eye.down * 0.12;
        let axis = (eye.forward + eye.down * 0.09 + eye.right * (side * 0.25)).unit();
        for k in 0..LANES {
            let n = points.normal.at(k);
            let ray = points.place.at(k) - lamp;
            let square = ray.dot(ray).max(0.09);
            let d = ray * (1.0 / square.sqrt());
            let c = d.dot(axis).max(0.0);
            let c2 = c * c;
            let c8 = c2 * c2 * c2 * c2;
            // A weak even part keeps what lies beside the lobe from vanishing.
            let strength = HEADLIGHT_W_SR * (c8 + 0.02 * smoothstep(0.0, 0.5, c)) / square;
            let facing = -d.dot(n);
            sum[k] += strength * (facing.max(0.0) + 0.3 * points.through[k] + 0.06);
            shine[k] += strength * points.gloss[k] * sheen(n, -d, points.to_eye.at(k));
        }
    }
    let white = v3(1.0, 0.98, 0.92);
    for k in 0..LANES {
        light.arriving.set(k, light.arriving.at(k) + white * sum[k]);
        light.shine.set(k, light.shine.at(k) + white * shine[k]);
    }
}
