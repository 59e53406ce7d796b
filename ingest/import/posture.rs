//! Orientations of bodies and cameras in a world with x east, y north, z up.

use super::profile::Axes;
use furrow_model::Se3;

/// World axes from those of KITTI's first camera: x stays, z (forward) becomes y, -y (up) becomes z.
pub(super) const UP_FROM_CAMERA: Se3 =
    Se3 { rotation: [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]], translation_m: [0.0; 3] };

/// A body's axes from those of a camera that looks along its forward axis.
pub(super) fn body_from_forward_camera(axes: Axes) -> Se3 {
    let rotation = match axes {
        Axes::Enu => [[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]],
        Axes::Ned => [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
    };
    Se3 { rotation, translation_m: [0.0; 3] }
}

/// World from body by roll, pitch and yaw, radians, about the body's x, y and z in the order yaw, pitch, roll.
pub(super) fn world_from_body(axes: Axes, [roll, pitch, yaw]: [f64; 3], position_m: [f64; 3]) -> Se3 {
    let turn = |angle: f64, i: usize, j: usize| {
        let (sin, cos) = libm::sincos(angle);
        let mut rotation = Se3::IDENTITY.rotation;
        [rotation[i][i], rotation[i][j], rotation[j][i], rotation[j][j]] = [cos, -sin, sin, cos];
        Se3 { rotation, translation_m: [0.0; 3] }
    };
    let turned = turn(yaw, 0, 1).compose(&turn(pitch, 2, 0)).compose(&turn(roll, 1, 2));
    let turned = match axes {
        Axes::Enu => turned,
        Axes::Ned => {
            let up_from_ned = [[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]];
            Se3 { rotation: up_from_ned, translation_m: [0.0; 3] }.compose(&turned)
        }
    };
    Se3 { translation_m: position_m, ..turned }
}

/// World from a level camera that looks along `east, north`.
pub(super) fn looking_along([east, north]: [f64; 2], position_m: [f64; 3]) -> Se3 {
    let length = libm::hypot(east, north);
    let [e, n] = if length > 0.0 { [east / length, north / length] } else { [0.0, 1.0] };
    Se3 { rotation: [[n, 0.0, e], [-e, 0.0, n], [0.0, -1.0, 0.0]], translation_m: position_m }
}

/// Poses at positions of which only the way is known: the camera is taken to look along it, over at least half a metre.
pub(super) fn along_the_way(positions_m: &[[f64; 3]]) -> Vec<Se3> {
    let mut direction = [0.0, 1.0];
    let mut ahead = 0;
    let look = |(at, from): (usize, &[f64; 3])| {
        ahead = ahead.max(at + 1);
        while let Some(to) = positions_m.get(ahead) {
            let step = [to[0] - from[0], to[1] - from[1]];
            if libm::hypot(step[0], step[1]) >= 0.5 {
                direction = step;
                break;
            }
            ahead += 1;
        }
        looking_along(direction, *from)
    };
    positions_m.iter().enumerate().map(look).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn forward(world_from_camera: &Se3) -> [f64; 3] {
        Se3 { translation_m: [0.0; 3], ..*world_from_camera }.apply([0.0, 0.0, 1.0]).map(|v| (v * 1e9).round() / 1e9)
    }

    #[test]
    fn north_east_and_up_are_where_each_convention_has_them() {
        let camera = |axes, angles| world_from_body(axes, angles, [0.0; 3]).compose(&body_from_forward_camera(axes));
        let quarter = std::f64::consts::FRAC_PI_2;
        // KITTI: yaw 0 is east, counter-clockwise; RobotCar: yaw 0 is north, clockwise; pitch of NED is nose up.
        assert_eq!(forward(&camera(Axes::Enu, [0.0; 3])), [1.0, 0.0, 0.0]);
        assert_eq!(forward(&camera(Axes::Enu, [0.0, 0.0, quarter])), [0.0, 1.0, 0.0]);
        assert_eq!(forward(&camera(Axes::Ned, [0.0; 3])), [0.0, 1.0, 0.0]);
        assert_eq!(forward(&camera(Axes::Ned, [0.0, 0.0, quarter])), [1.0, 0.0, 0.0]);
        assert_eq!(forward(&camera(Axes::Ned, [0.0, quarter, 0.0])), [0.0, 0.0, 1.0]);
        for pose in [camera(Axes::Enu, [0.0; 3]), camera(Axes::Ned, [0.0; 3]), looking_along([3.0, 0.0], [0.0; 3])] {
            assert_eq!(pose.apply([0.0, 1.0, 0.0]).map(f64::round), [0.0, 0.0, -1.0], "the image's rows go down");
        }
    }

    #[test]
    fn a_robot_that_stands_looks_where_it_goes_next() {
        let poses = along_the_way(&[[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0], [1.0, 2.0, 0.0], [1.0, 2.1, 0.0]]);
        let looks: Vec<[f64; 3]> = poses.iter().map(forward).collect();
        assert_eq!(looks, [[1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]]);
    }
}
