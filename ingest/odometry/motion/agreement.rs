//! The score and the inliers of a motion, four observations at a time with AVX2. The errors are those of
//! [`Reprojection::error`], and their sums have one order: equal bits on every machine.

use super::observation::Observation;
use super::reprojection::{NEAR_M, Reprojection, Views};
use furrow_model::Se3;

/// Observations whose errors are computed at once, before the sum is compared with its limit.
const CHUNK: usize = 32;

/// The observations of one reprojection, in structure-of-arrays layout.
pub(super) struct Agreement<'a> {
    reprojection: Reprojection<'a>,
    len: usize,
    chunks: Vec<Chunk>,
}

/// Entries after the last observation are zero and not used.
#[derive(Clone, Copy)]
struct Chunk {
    point_m: [[f64; CHUNK]; 3],
    seen_px: [[f64; CHUNK]; 3],
}

impl<'a> Agreement<'a> {
    pub fn new(reprojection: &Reprojection<'a>, observations: &[Observation]) -> Self {
        let chunk = |observations: &[Observation]| {
            let mut chunk = Chunk { point_m: [[0.0; CHUNK]; 3], seen_px: [[0.0; CHUNK]; 3] };
            for (i, observation) in observations.iter().enumerate() {
                for axis in 0..3 {
                    chunk.point_m[axis][i] = observation.point_m[axis];
                    chunk.seen_px[axis][i] = observation.seen_px[axis];
                }
            }
            chunk
        };
        let chunks = observations.chunks(CHUNK).map(chunk).collect();
        Self { reprojection: *reprojection, len: observations.len(), chunks }
    }

    /// The sum of squared errors, each truncated to `limit` (MSAC, Torr and Zisserman 2000). `None` as soon as it is
    /// not below `least`.
    pub fn truncated_error(&self, motion: &Se3, limit: f64, least: f64) -> Option<f64> {
        let mut sum = 0.0;
        for chunk in 0..self.chunks.len() {
            let (errors, len) = self.errors(chunk, motion);
            sum += errors[..len].iter().map(|error| error.min(limit)).sum::<f64>();
            if sum >= least {
                return None;
            }
        }
        Some(sum)
    }

    /// The observations whose squared error is below `limit`, ascending.
    pub fn inliers(&self, motion: &Se3, limit: f64) -> Vec<usize> {
        let mut inliers = Vec::new();
        for chunk in 0..self.chunks.len() {
            let (errors, len) = self.errors(chunk, motion);
            inliers.extend((0..len).filter(|&i| errors[i] < limit).map(|i| chunk * CHUNK + i));
        }
        inliers
    }

    /// The squared errors of a chunk's observations, and the number of observations.
    fn errors(&self, chunk: usize, motion: &Se3) -> ([f64; CHUNK], usize) {
        let len = CHUNK.min(self.len - chunk * CHUNK);
        let chunk = &self.chunks[chunk];
        #[cfg(target_arch = "x86_64")]
        if is_x86_feature_detected!("avx2") {
            // SAFETY: the machine has AVX2, and the function's body is safe code.
            return (unsafe { errors_avx2(&self.reprojection, chunk, motion) }, len);
        }
        (errors(&self.reprojection, chunk, motion), len)
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn errors_avx2(reprojection: &Reprojection, chunk: &Chunk, motion: &Se3) -> [f64; CHUNK] {
    errors(reprojection, chunk, motion)
}

/// [`Reprojection::error`] of each, operation by operation.
#[inline(always)]
fn errors(reprojection: &Reprojection, chunk: &Chunk, motion: &Se3) -> [f64; CHUNK] {
    let (rig, [a, b, c], [s, t, r]) = (reprojection.rig, &motion.rotation, motion.translation_m);
    let is_stereo = reprojection.views == Views::Stereo;
    let mut errors = [0.0; CHUNK];
    for (i, error) in errors.iter_mut().enumerate() {
        let [p, q, d] = [chunk.point_m[0][i], chunk.point_m[1][i], chunk.point_m[2][i]];
        let x = a[0] * p + a[1] * q + a[2] * d + s;
        let y = b[0] * p + b[1] * q + b[2] * d + t;
        let z = c[0] * p + c[1] * q + c[2] * d + r;
        let scale = rig.focal_px / z;
        let u = x * scale + rig.cu_px - chunk.seen_px[0][i];
        let v = y * scale + rig.cv_px - chunk.seen_px[1][i];
        let right = (x - rig.baseline_m) * scale + rig.cu_px - chunk.seen_px[2][i];
        let right = if is_stereo { right } else { 0.0 };
        let squared = u * u + v * v + right * right;
        *error = if z < NEAR_M { f64::INFINITY } else { squared };
    }
    errors
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::reprojection::Weights;
    use crate::motion::test_scene::{RIG, exact_observations, true_motion};
    use crate::test_support::uniform;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn sums_and_inliers_are_those_of_single_observations() {
        let mut rng = ChaCha8Rng::seed_from_u64(8);
        for (views, count) in [(Views::Left, 3), (Views::Left, 77), (Views::Stereo, 64), (Views::Stereo, 200)] {
            let reprojection = Reprojection { rig: &RIG, views, weights: Weights::Equal };
            let mut observations = exact_observations(&true_motion(), count, 3);
            for observation in observations.iter_mut().step_by(3) {
                observation.seen_px[0] += uniform(&mut rng, -3.0, 3.0);
                observation.point_m[2] *= uniform(&mut rng, -0.1, 1.0);
            }
            let agreement = Agreement::new(&reprojection, &observations);
            let errors: Vec<f64> = observations.iter().map(|o| reprojection.error(&true_motion(), o)).collect();
            let expected: Vec<usize> = (0..count).filter(|&i| errors[i] < 4.0).collect();
            assert!(expected.len() < count && count < 5 || errors.contains(&f64::INFINITY));
            assert_eq!(agreement.inliers(&true_motion(), 4.0), expected);
            let sum = errors.chunks(CHUNK).map(|chunk| chunk.iter().map(|error| error.min(4.0)).sum::<f64>()).sum();
            assert_eq!(agreement.truncated_error(&true_motion(), 4.0, f64::INFINITY), Some(sum));
            assert_eq!(agreement.truncated_error(&true_motion(), 4.0, sum), None);
        }
    }
}
