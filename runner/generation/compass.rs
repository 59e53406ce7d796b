//! Which way a camera looked: its chain, laid on a track whose compass is known.

use crate::evaluate::truth::GroundTruth;
use furrow_model::trajectory::ChainPose;

/// A track tells the compass where it reaches so far about its middle, root mean square.
const LEAST_REACH_M: f64 = 1.0;

/// A direction east, north, up as a level camera of this heading has it: right, down, forward.
pub(super) fn seen_by_camera([east, north, up]: [f64; 3], heading_rad: f64) -> [f64; 3] {
    let (sin, cos) = (libm::sin(heading_rad), libm::cos(heading_rad));
    [east * sin - north * cos, -up, east * cos + north * sin]
}

/// Where the chain's first camera looks, radians counter-clockwise from east: the turn that lays the chain on the track
/// with least squares.
pub(super) fn compass(chain: &[ChainPose], track: &GroundTruth) -> Option<f64> {
    let pairs: Vec<[f64; 4]> = (chain.iter())
        .filter_map(|pose| {
            let [right_m, _, forward_m] = pose.start_from_here.translation_m;
            track.at(pose.stamp_ns).map(|at| [right_m, forward_m, at.east_m, at.north_m])
        })
        .collect();
    let count = pairs.len() as f64;
    let mean: [f64; 4] = std::array::from_fn(|k| pairs.iter().map(|pair| pair[k]).sum::<f64>() / count);
    let (mut along, mut across, mut reach) = (0.0, 0.0, 0.0);
    for pair in &pairs {
        let [x, z, e, n]: [f64; 4] = std::array::from_fn(|k| pair[k] - mean[k]);
        along += e * z - n * x;
        across += e * x + n * z;
        reach += (e * e + n * n).min(x * x + z * z);
    }
    (count > 0.0 && reach >= count * LEAST_REACH_M * LEAST_REACH_M).then(|| libm::atan2(across, along))
}

#[cfg(test)]
mod tests {
    use super::*;
    use furrow_model::Se3;

    /// A camera drives 8 m east, turns left and drives 6 m north; the chain starts with its own axes. The track is in
    /// metres, written as poses whose orientation says nothing.
    #[test]
    fn the_chain_is_turned_to_the_compass() {
        let world = |i: usize| if i <= 8 { [i as f64, 0.0] } else { [8.0, (i - 8) as f64] };
        let text: String =
            (0..15).map(|i| format!("{i} {} {} 0 0 0 0 1\n", world(i)[0] + 3.0, world(i)[1] - 7.0)).collect();
        let track = GroundTruth::from_tum(text.as_bytes()).unwrap();
        let pose = |i: usize| ChainPose {
            stamp_ns: i as i64 * 1_000_000_000,
            // East is forward, north is left.
            start_from_here: Se3 { translation_m: [-world(i)[1], 0.0, world(i)[0]], ..Se3::IDENTITY },
            travelled_m: i as f64,
            valid: true,
        };
        let chain: Vec<ChainPose> = (0..15).map(pose).collect();
        let found = compass(&chain, &track).unwrap();
        assert!(found.abs() < 1e-9, "looks east: {found}");
        assert_eq!(compass(&chain[..2], &track), None, "half a metre about its middle tells nothing");
    }

    #[test]
    fn a_camera_that_looks_north_has_the_morning_sun_on_its_right() {
        let camera = seen_by_camera([0.8, 0.0, 0.6], std::f64::consts::FRAC_PI_2);
        let expected = [0.8, -0.6, 0.0];
        assert!(camera.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{camera:?}");
    }
}
