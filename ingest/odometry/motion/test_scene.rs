//! Points that a moving camera sees without error, for the tests of this folder.

use super::observation::{Noise, Observation};
use crate::test_support::uniform;
use furrow_model::{Se3, StereoRig};
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

pub(super) const RIG: StereoRig =
    StereoRig { width: 1226, height: 370, focal_px: 707.0, cu_px: 602.0, cv_px: 183.0, baseline_m: 0.54 };

/// Points in front of the camera and where they are seen after the motion, without error.
pub(super) fn exact_observations(after_from_before: &Se3, count: usize, seed: u64) -> Vec<Observation> {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut observe = || {
        let z = uniform(&mut rng, 5.0, 40.0);
        let point_m = [uniform(&mut rng, -0.6, 0.6) * z, uniform(&mut rng, -0.2, 0.2) * z, z];
        let seen = after_from_before.apply(point_m);
        let [u, v] = RIG.project(seen);
        let seen_px = [u, v, u - RIG.focal_px * RIG.baseline_m / seen[2]];
        Observation { point_m, seen_px, noise: Noise::EQUAL }
    };
    (0..count).map(|_| observe()).collect()
}

/// The motion (after_from_before) of the tests.
pub(super) fn true_motion() -> Se3 {
    Se3::from_quaternion([0.01, -0.06, 0.02, 1.0], [0.2, -0.05, -1.3])
}
