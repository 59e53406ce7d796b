//! The iterations of Gauss-Newton on eight triples.

use super::equations::{Equations, Seen};
use super::lanes::LANES;
use super::motions::Motions;
use crate::motion::gauss_newton::{DIVERGED, Stop};
use crate::motion::observation::Observation;
use crate::motion::reprojection::Reprojection;
use crate::se3::orthonormalise;
use furrow_model::Se3;

/// The motions of triples of observations, given by index, each of weight one; see [`Reprojection::fit`].
pub(in crate::motion) fn fit_triples(
    reprojection: &Reprojection,
    start: &Se3,
    observations: &[Observation],
    triples: &[[usize; 3]; LANES],
    stop: Stop,
) -> [Option<Se3>; LANES] {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2, and the function's body is safe code.
        return unsafe { fit_avx2(reprojection, start, observations, triples, stop) };
    }
    fit_portable(reprojection, start, observations, triples, stop)
}

/// The same code, compiled for registers of twice the width.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn fit_avx2(
    reprojection: &Reprojection,
    start: &Se3,
    observations: &[Observation],
    triples: &[[usize; 3]; LANES],
    stop: Stop,
) -> [Option<Se3>; LANES] {
    fit_portable(reprojection, start, observations, triples, stop)
}

#[inline(always)]
fn fit_portable(
    reprojection: &Reprojection,
    start: &Se3,
    observations: &[Observation],
    triples: &[[usize; 3]; LANES],
    stop: Stop,
) -> [Option<Se3>; LANES] {
    let seen: [Seen; 3] = std::array::from_fn(|k| Seen::gather(observations, triples, k));
    let mut motions = Motions::all(start);
    let (mut found, mut is_open) = ([None; LANES], [true; LANES]);
    for _ in 0..stop.max_iterations {
        let mut equations = Equations::ZERO;
        seen.iter().for_each(|seen| equations.add(reprojection, &motions, seen));
        let (step, is_regular) = equations.solve();
        let step = step.map(|value| -value);
        motions = Motions::from_steps(&step).compose(&motions);
        for lane in 0..LANES {
            let is_below = |limit: f64| step.iter().all(|value| value.0[lane].abs() < limit);
            if is_open[lane] && is_regular[lane] && is_below(stop.tolerance) {
                found[lane] = Some(orthonormalise(&motions.lane(lane)));
            }
            is_open[lane] &= found[lane].is_none() && is_regular[lane] && is_below(DIVERGED);
        }
        if !is_open.contains(&true) {
            break;
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::reprojection::{Views, Weights};
    use crate::motion::test_scene::{RIG, exact_observations, true_motion};
    use crate::test_support::uniform;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn bits(motion: Se3) -> [u64; 12] {
        let numbers: Vec<f64> = motion.rotation.into_iter().flatten().chain(motion.translation_m).collect();
        std::array::from_fn(|i| numbers[i].to_bits())
    }

    #[test]
    fn eight_at_a_time_give_the_bits_of_one_at_a_time() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let (mut found, mut refused) = (0, 0);
        for views in [Views::Left, Views::Stereo] {
            let reprojection = Reprojection { rig: &RIG, views, weights: Weights::Equal };
            // A third as they are, a third seen elsewhere, a third behind the camera or close to it. One triple is
            // degenerate.
            let mut observations = exact_observations(&true_motion(), 90, 4);
            for observation in &mut observations[30..60] {
                observation.seen_px = [0; 3].map(|_| uniform(&mut rng, 0.0, 1226.0));
            }
            for observation in &mut observations[60..] {
                observation.point_m[2] = uniform(&mut rng, -2.0, 2.0);
            }
            for batch in 0..400 {
                let reach = [90, 60, 30][batch % 3];
                let mut triples = [[0; 3]; LANES].map(|triple| triple.map(|_: usize| rng.next_u32() as usize % reach));
                triples[3] = [batch % 90; 3];
                for (max_iterations, tolerance) in [(20, 1e-4), (3, 1e-9)] {
                    let stop = Stop { max_iterations, tolerance };
                    let together = fit_triples(&reprojection, &Se3::IDENTITY, &observations, &triples, stop);
                    let portable = fit_portable(&reprojection, &Se3::IDENTITY, &observations, &triples, stop);
                    for (lane, triple) in triples.iter().enumerate() {
                        let chosen = triple.iter().map(|&i| (&observations[i], 1.0));
                        let alone = reprojection.fit(&Se3::IDENTITY, chosen, stop);
                        assert_eq!(together[lane].map(bits), alone.map(bits), "{views:?} {triple:?}");
                        assert_eq!(portable[lane].map(bits), alone.map(bits), "{views:?} {triple:?}");
                        *(if alone.is_some() { &mut found } else { &mut refused }) += 1;
                    }
                }
            }
        }
        assert!(found > 1000 && refused > 1000, "{found} {refused}");
    }
}
