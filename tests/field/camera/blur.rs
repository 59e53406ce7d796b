//! Motion blur: how far each pixel's image moves while the shutter is open, and its smear along that way.
//!
//! Instead of several pictures per exposure, one picture is averaged along the motion that its own depths give: at a
//! third of the cost, and the same but where something near uncovers what lies behind it within the exposure.

use crate::render::Radiance;
use furrow_model::widest;
use furrow_model::{Se3, StereoRig};
use rayon::prelude::*;

/// Pixels that move less than this stay sharp.
const STILL_PX: f32 = 0.5;

/// Pixels whose way is found at once.
const LANES: usize = 64;

/// A motion during an exposure, in the left camera's axes: metres, and radians about the axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    travel_m: [f64; 3],
    turn_rad: [f64; 3],
}

impl Motion {
    /// The motion from one pose to another (world from left camera), small enough to be even.
    pub fn between(from: &Se3, to: &Se3) -> Motion {
        let step = from.inverse().compose(to);
        let r = &step.rotation;
        let turn_rad = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]].map(|twice| 0.5 * twice);
        Motion { travel_m: step.translation_m, turn_rad }
    }

    /// The same motion seen from a camera `shift_m` to the right.
    pub fn aside(self, shift_m: f64) -> Motion {
        let [_, about_y, about_z] = self.turn_rad;
        let [x, y, z] = self.travel_m;
        Motion { travel_m: [x, y + about_z * shift_m, z - about_y * shift_m], ..self }
    }

    /// How far the image of a point moves, in pixels right and down: the point is seen along (x, y, 1) at one over its
    /// depth.
    #[inline(always)]
    fn flow_px(&self, focal_px: f32, x: f32, y: f32, inverse_depth: f32) -> [f32; 2] {
        let [tx, ty, tz] = self.travel_m.map(|v| v as f32 * inverse_depth);
        let [a, b, c] = self.turn_rad.map(|v| v as f32);
        // The point moves by -t - w x p in the camera's axes.
        let (dx, dy, dz) = (-tx - (b - c * y), -ty - (c * x - a), -tz - (a * y - b * x));
        [focal_px * (dx - x * dz), focal_px * (dy - y * dz)]
    }
}

/// `picture` as the eye with this `motion` takes it, and how far its fastest pixel moved.
pub fn smear(picture: Radiance, rig: &StereoRig, motion: &Motion) -> (Radiance, f32) {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let mut pixels = vec![[0.0; 3]; width * height];
    let fastest = |(row, line): (usize, &mut [[f32; 3]])| smear_row(&picture, rig, motion, row, line);
    let fastest = pixels.par_chunks_mut(width).enumerate().map(fastest).reduce(|| 0.0, f32::max).sqrt();
    (Radiance { pixels, ..picture }, fastest)
}

widest!(
    fn smear_row(picture: &Radiance, rig: &StereoRig, motion: &Motion, row: usize, line: &mut [[f32; 3]]) -> f32
        = smear_row_anywhere
);

/// One row, and the square of how far its fastest pixel moved.
#[inline(always)]
fn smear_row_anywhere(picture: &Radiance, rig: &StereoRig, motion: &Motion, row: usize, line: &mut [[f32; 3]]) -> f32 {
    let (focal, cu, cv) = (rig.focal_px as f32, rig.cu_px as f32, rig.cv_px as f32);
    let here = row * line.len()..(row + 1) * line.len();
    let mut fastest = 0.0_f32;
    let sources = picture.pixels[here.clone()].chunks(LANES).zip(picture.inverse_depth[here].chunks(LANES));
    for (chunk, (line, (sharp, inverse_depth))) in line.chunks_mut(LANES).zip(sources).enumerate() {
        let (mut near, mut flow, mut square) = ([0.0; LANES], [[0.0; LANES]; 2], [0.0; LANES]);
        near[..inverse_depth.len()].copy_from_slice(inverse_depth);
        let first = (chunk * LANES) as f32;
        let y = (row as f32 - cv) / focal;
        for k in 0..LANES {
            let x = (first + k as i32 as f32 - cu) / focal;
            let [du, dv] = motion.flow_px(focal, x, y, near[k]);
            (flow[0][k], flow[1][k]) = (du, dv);
            square[k] = du * du + dv * dv;
        }
        for (k, (pixel, sharp)) in line.iter_mut().zip(sharp).enumerate() {
            fastest = fastest.max(square[k]);
            *pixel = if square[k] < STILL_PX * STILL_PX {
                *sharp
            } else {
                // Three thirds of the exposure, the middle one being the picture itself.
                let (x, y) = (first + k as f32, row as f32);
                let (du, dv) = (flow[0][k] / 3.0, flow[1][k] / 3.0);
                let (before, after) = (between(picture, x - du, y - dv), between(picture, x + du, y + dv));
                std::array::from_fn(|k| (before[k] + sharp[k] + after[k]) * (1.0 / 3.0))
            };
        }
    }
    fastest
}

/// The colour between pixels, at the border that of the last one.
#[inline(always)]
fn between(picture: &Radiance, x: f32, y: f32) -> [f32; 3] {
    let (width, height) = (picture.width as usize, picture.height as usize);
    let (x, y) = (x.clamp(0.0, (width - 1) as f32), y.clamp(0.0, (height - 1) as f32));
    let (column, row) = ((x as usize).min(width - 2), (y as usize).min(height - 2));
    let (fx, fy) = (x - column as f32, y - row as f32);
    let at = |i: usize| &picture.pixels[i];
    let (i, j) = (row * width + column, (row + 1) * width + column);
    let (a, b, c, d) = (at(i), at(i + 1), at(j), at(j + 1));
    std::array::from_fn(|k| {
        let (top, bottom) = (a[k] + (b[k] - a[k]) * fx, c[k] + (d[k] - c[k]) * fx);
        top + (bottom - top) * fy
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::rig;

    /// A level camera that looks north from 0.75 m above the ground, so far along, aside and turned so far to the left.
    fn pose(north_m: f64, left_rad: f64) -> Se3 {
        let (sin, cos) = (libm::sin(left_rad), libm::cos(left_rad));
        Se3 { rotation: [[cos, 0.0, -sin], [sin, 0.0, cos], [0.0, -1.0, 0.0]], translation_m: [0.0, north_m, 0.75] }
    }

    /// Where a point of the world moves in the image between two poses, by projecting it twice.
    fn projected(point: [f64; 3], from: &Se3, to: &Se3) -> [f64; 2] {
        let rig = rig((640, 360));
        let [a, b] = [from, to].map(|pose| rig.project(pose.inverse().apply(point)));
        [b[0] - a[0], b[1] - a[1]]
    }

    #[test]
    fn every_pixel_moves_as_its_point_does() {
        let rig = rig((640, 360));
        for (ahead_m, turn_rad) in [(0.008, 0.0), (0.0, 0.003), (0.006, -0.002)] {
            let (from, to) = (pose(-0.5 * ahead_m, -0.5 * turn_rad), pose(0.5 * ahead_m, 0.5 * turn_rad));
            let motion = Motion::between(&from, &to);
            for (u, v, depth_m) in [(320.0, 300.0, 1.5), (20.0, 350.0, 1.2), (620.0, 10.0, 30.0), (100.0, 200.0, 4.0)] {
                let ray = [(u - rig.cu_px) / rig.focal_px, (v - rig.cv_px) / rig.focal_px, 1.0];
                let expected = projected(pose(0.0, 0.0).apply(ray.map(|c| c * depth_m)), &from, &to);
                let found = motion.flow_px(rig.focal_px as f32, ray[0] as f32, ray[1] as f32, 1.0 / depth_m as f32);
                for k in 0..2 {
                    assert!((f64::from(found[k]) - expected[k]).abs() < 0.02, "{found:?} {expected:?}");
                }
            }
        }
    }

    #[test]
    fn a_line_spreads_over_the_way_that_it_moves_and_keeps_its_light() {
        // A turn by 3 / 264 rad moves the middle of the image by three pixels: a bright column spreads over three.
        let rig = rig((64, 36));
        let line = |i: usize| if i % 64 == 32 { [9.0; 3] } else { [0.0; 3] };
        let turn = 3.0 / rig.focal_px;
        let picture = Radiance {
            width: 64,
            height: 36,
            pixels: (0..64 * 36).map(line).collect(),
            inverse_depth: vec![0.0; 64 * 36],
        };
        let motion = Motion::between(&pose(0.0, -0.5 * turn), &pose(0.0, 0.5 * turn));
        let (smeared, _) = smear(picture.clone(), &rig, &motion);
        let row = &smeared.pixels[18 * 64 + 29..18 * 64 + 36];
        let found: Vec<f32> = row.iter().map(|pixel| pixel[0]).collect();
        for (value, expected) in found.iter().zip([0.0, 0.0, 3.0, 3.0, 3.0, 0.0, 0.0]) {
            assert!((value - expected).abs() < 0.2, "{found:?}");
        }
        let still = smear(picture.clone(), &rig, &Motion::between(&pose(0.0, 0.0), &pose(0.0, 0.0)));
        assert!(still.0.pixels == picture.pixels && still.1 == 0.0);
    }
}
