//! Motion blur: how far the image moves while the shutter is open, and the moments whose pictures make up the exposure.

use crate::render::Radiance;
use furrow_model::{Se3, StereoRig};

/// How far the left image moves between two poses (world from left camera), in pixels of `rig`: the most of the ground at the image's
/// bottom, `height_m` below `middle`, and of the far distance at its corners and centre, which turns alone.
pub fn motion_px(rig: &StereoRig, height_m: f64, middle: &Se3, [from, to]: [&Se3; 2]) -> f64 {
    let (right, bottom) = (f64::from(rig.width) - 1.0, f64::from(rig.height) - 1.0);
    let ray = |u: f64, v: f64| [(u - rig.cu_px) / rig.focal_px, (v - rig.cv_px) / rig.focal_px, 1.0];
    let turn_only = |pose: &Se3| Se3 { translation_m: [0.0; 3], ..*pose };
    let moved = |point: [f64; 3], from: &Se3, to: &Se3| {
        let [a, b] = [from, to].map(|pose| rig.project(pose.inverse().apply(point)));
        libm::hypot(a[0] - b[0], a[1] - b[1])
    };
    let far = [(0.0, 0.0), (right, 0.0), (0.0, bottom), (right, bottom), (rig.cu_px, rig.cv_px)].map(|(u, v)| {
        let (middle, from, to) = (turn_only(middle), turn_only(from), turn_only(to));
        moved(middle.apply(ray(u, v)), &from, &to)
    });
    let ground = [0.0, rig.cu_px, right].map(|u| {
        let ray = ray(u, bottom);
        let fall = -turn_only(middle).apply(ray)[2];
        // A camera that looks up sees no ground.
        if fall > 0.0 { moved(middle.apply(ray.map(|c| c * height_m / fall)), from, to) } else { 0.0 }
    });
    far.into_iter().chain(ground).fold(0.0, f64::max)
}

/// The moments in seconds whose pictures are averaged for an exposure of `exposure_s` round `time_s`, while the image moves by
/// `motion_px`: one up to 1 px, two up to 2 px, else three, evenly over the exposure (SPEC 8.3).
pub fn moments(time_s: f64, exposure_s: f64, motion_px: f64) -> Vec<f64> {
    let count = 1 + usize::from(motion_px > 1.0) + usize::from(motion_px > 2.0);
    (0..count).map(|k| time_s + exposure_s * ((k as f64 + 0.5) / count as f64 - 0.5)).collect()
}

/// The mean of the pictures of both eyes, added up in their order.
pub fn mean(first: [Radiance; 2], others: impl Iterator<Item = [Radiance; 2]>) -> [Radiance; 2] {
    let (mut sum, mut count) = (first, 1.0_f32);
    for other in others {
        count += 1.0;
        for (sum, other) in sum.iter_mut().zip(&other) {
            sum.pixels.iter_mut().zip(&other.pixels).for_each(|(a, b)| (0..3).for_each(|k| a[k] += b[k]));
        }
    }
    if count > 1.0 {
        sum.iter_mut().flat_map(|sum| &mut sum.pixels).for_each(|pixel| *pixel = pixel.map(|c| c / count));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::rig;

    /// A level camera that looks north from 0.75 m above the ground, so far along and turned so far to the left.
    fn pose(north_m: f64, left_rad: f64) -> Se3 {
        let (sin, cos) = (libm::sin(left_rad), libm::cos(left_rad));
        Se3 { rotation: [[cos, 0.0, -sin], [sin, 0.0, cos], [0.0, -1.0, 0.0]], translation_m: [0.0, north_m, 0.75] }
    }

    #[test]
    fn the_ground_at_the_bottom_moves_fastest_on_a_straight() {
        // Ground 0.75 m below is seen at the bottom row, 179.5 px under the centre, at z = 264 * 0.75 / 179.5 m. A step of 1 cm towards
        // it moves it by v (z / (z -+ 5 mm)); aside, at 319.5 px, by as much more as the corner lies farther out.
        let z = 264.0 * 0.75 / 179.5;
        let out = (179.5_f64 * 179.5 + 319.5 * 319.5).sqrt();
        let expected = out * (z / (z - 0.005) - z / (z + 0.005));
        let found = motion_px(&rig((640, 360)), 0.75, &pose(0.0, 0.0), [&pose(-0.005, 0.0), &pose(0.005, 0.0)]);
        assert!((found - expected).abs() < 1e-6 && expected > 3.0, "{found} {expected}");
    }

    #[test]
    fn a_turn_moves_the_corners_most() {
        // A turn by 4 mrad moves a direction at (x, y) by f * 4 mrad * (1 + x^2, x y), to first order.
        let (x, y) = (319.5 / 264.0, 179.5 / 264.0);
        let expected = 264.0 * 0.004 * libm::hypot(1.0 + x * x, x * y);
        let found = motion_px(&rig((640, 360)), 0.75, &pose(0.0, 0.0), [&pose(0.0, -0.002), &pose(0.0, 0.002)]);
        assert!((found - expected).abs() < 0.001 * expected, "{found} {expected}");
    }

    #[test]
    fn one_two_or_three_moments_round_the_middle() {
        assert_eq!(moments(5.0, 0.012, 0.99), [5.0]);
        let close = |found: Vec<f64>, expected: &[f64]| {
            found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12)
        };
        assert!(close(moments(5.0, 0.012, 1.01), &[4.997, 5.003]));
        assert!(close(moments(5.0, 0.012, 2.01), &[4.996, 5.0, 5.004]));
    }
}
