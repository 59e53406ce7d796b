//! What is behind all facets: sky and horizon, seen through the net overhead.

use super::stage::Stage;
use crate::vector::{V3, v3};

/// Radiance of sky and horizon in the direction `d`, seen from `from` through the net if there is one, by a pixel that
/// is `width` wide at a distance of one.
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
    // The pixel on the net: as wide as it is across the view, longer along it. A thread is spread over a pixel to
    // either side, so that it does not come and go between samples.
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
