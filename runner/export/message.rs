//! Small parts of messages.

use crate::RunError;
use crate::evaluate::truth::GroundPose;
use foxglove::messages::{Color, FrameTransform, Point2, Point3, Pose, Quaternion, Timestamp, Vector3};
use furrow_model::Se3;

/// Okabe and Ito's colours, which the colour-blind tell apart: live.
pub(super) const BLUE: Color = Color { r: 0.0, g: 0.447, b: 0.698, a: 1.0 };
/// Experiences.
pub(super) const ORANGE: Color = Color { r: 0.902, g: 0.624, b: 0.0, a: 1.0 };
/// Accepted.
pub(super) const GREEN: Color = Color { r: 0.0, g: 0.62, b: 0.451, a: 1.0 };
/// Not accepted.
pub(super) const VERMILION: Color = Color { r: 0.835, g: 0.369, b: 0.0, a: 1.0 };
/// Ground truth.
pub(super) const GREY: Color = Color { r: 0.5, g: 0.5, b: 0.5, a: 1.0 };
pub(super) const WHITE: Color = Color { r: 1.0, g: 1.0, b: 1.0, a: 1.0 };
pub(super) const SHADE: Color = Color { r: 0.0, g: 0.0, b: 0.0, a: 0.7 };

/// A stamp as messages carry it: seconds since 1970 in 32 bits, and nanoseconds.
///
/// # Errors
/// [`RunError::Recording`] where it does not fit.
pub(super) fn stamp(stamp_ns: i64) -> Result<Timestamp, RunError> {
    let seconds = u32::try_from(stamp_ns.div_euclid(1_000_000_000));
    let nanos = stamp_ns.rem_euclid(1_000_000_000) as u32;
    let fits = seconds.ok().and_then(|seconds| Timestamp::new_checked(seconds, nanos));
    fits.ok_or_else(|| RunError::Recording(format!("stamp {stamp_ns} ns: expected one between 1970 and 2106")))
}

pub(super) fn point3([x, y, z]: [f64; 3]) -> Point3 {
    Point3 { x, y, z }
}

/// A pixel whose centre has whole coordinates, as players count: from the image's corner.
pub(super) fn point2([u_px, v_px]: [f64; 2]) -> Point2 {
    Point2 { x: u_px + 0.5, y: v_px + 0.5 }
}

fn translation(pose: &Se3) -> Vector3 {
    let [x, y, z] = pose.translation_m;
    Vector3 { x, y, z }
}

fn rotation(pose: &Se3) -> Quaternion {
    let [x, y, z, w] = pose.quaternion_xyzw();
    Quaternion { x, y, z, w }
}

/// The pose of something, where `frame_from_thing` is its transform.
pub(super) fn pose(frame_from_thing: &Se3) -> Pose {
    Pose { position: Some(translation(frame_from_thing)), orientation: Some(rotation(frame_from_thing)) }
}

pub(super) fn transform(timestamp: Timestamp, parent: &str, child: &str, parent_from_child: &Se3) -> FrameTransform {
    FrameTransform {
        timestamp: Some(timestamp),
        parent_frame_id: parent.to_owned(),
        child_frame_id: child.to_owned(),
        translation: Some(translation(parent_from_child)),
        rotation: Some(rotation(parent_from_child)),
    }
}

/// A camera on level ground, at height 0: x east, y north, z up from x right, y down, z forward.
pub(super) fn world_from_camera(truth: GroundPose) -> Se3 {
    let (sin, cos) = (libm::sin(truth.heading_rad), libm::cos(truth.heading_rad));
    Se3 {
        rotation: [[sin, 0.0, cos], [-cos, 0.0, sin], [0.0, -1.0, 0.0]],
        translation_m: [truth.east_m, truth.north_m, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_camera_that_looks_north_has_east_on_its_right() {
        let truth = GroundPose { east_m: 3.0, north_m: 4.0, heading_rad: std::f64::consts::FRAC_PI_2 };
        let world_from_camera = world_from_camera(truth);
        let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
        assert!(close(world_from_camera.apply([0.0, 0.0, 2.0]), [3.0, 6.0, 0.0]), "forward is north");
        assert!(close(world_from_camera.apply([1.0, 0.0, 0.0]), [4.0, 4.0, 0.0]), "right is east");
        assert!(close(world_from_camera.apply([0.0, 1.0, 0.0]), [3.0, 4.0, -1.0]), "down is down");
    }

    #[test]
    fn stamps_keep_every_nanosecond_and_none_before_1970_is_written() {
        let time = stamp(1_700_000_000_123_456_789).unwrap();
        assert_eq!((time.sec(), time.nsec()), (1_700_000_000, 123_456_789));
        assert!(stamp(-1).is_err() && stamp(i64::MAX).is_err());
    }
}
