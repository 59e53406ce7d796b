//! Gauss-Newton on triples of observations, eight triples at a time: every lane does what [`Reprojection::fit`] does with its three
//! where all count alike, operation by operation, so the same motion to the last bit. One at a time, the processor waits for roots and quotients.

use crate::motion::{DIVERGED, NEAR_M, Observation, Reprojection, Views, orthonormal};
use furrow_model::Se3;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Triples at a time: two registers of AVX2, so that one computes while the other waits.
pub(crate) const LANES: usize = 8;

/// The motions that fit triples of observations, by their indices, each of weight one; see [`Reprojection::fit`].
pub(crate) fn fit_triples(
    reprojection: &Reprojection,
    start: &Se3,
    observations: &[Observation],
    triples: &[[usize; 3]; LANES],
    (rounds, settled): (usize, f64),
) -> [Option<Se3>; LANES] {
    #[cfg(target_arch = "x86_64")]
    if is_x86_feature_detected!("avx2") {
        // SAFETY: the machine has AVX2, and the function's body is safe code.
        return unsafe { fit_avx2(reprojection, start, observations, triples, (rounds, settled)) };
    }
    fit(reprojection, start, observations, triples, (rounds, settled))
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn fit_avx2(
    reprojection: &Reprojection,
    start: &Se3,
    observations: &[Observation],
    triples: &[[usize; 3]; LANES],
    until: (usize, f64),
) -> [Option<Se3>; LANES] {
    fit(reprojection, start, observations, triples, until)
}

#[inline(always)]
fn fit(
    reprojection: &Reprojection,
    start: &Se3,
    observations: &[Observation],
    triples: &[[usize; 3]; LANES],
    (rounds, settled): (usize, f64),
) -> [Option<Se3>; LANES] {
    let seen: [Seen; 3] = std::array::from_fn(|k| Seen::of(observations, triples, k));
    let mut motions = Motions::all(start);
    let (mut found, mut is_open) = ([None; LANES], [true; LANES]);
    for _ in 0..rounds {
        let mut equations = Equations { matrix: [[ZERO; 6]; 6], vector: [ZERO; 6] };
        seen.iter().for_each(|seen| equations.add(reprojection, &motions, seen));
        let (step, is_regular) = equations.solve();
        let step = step.map(|value| -value);
        motions = Motions::small(&step).compose(&motions);
        for lane in 0..LANES {
            let shorter_than = |limit: f64| step.iter().all(|value| value.0[lane].abs() < limit);
            if is_open[lane] && is_regular[lane] && shorter_than(settled) {
                found[lane] = Some(orthonormal(&motions.of(lane)));
            }
            is_open[lane] &= found[lane].is_none() && is_regular[lane] && shorter_than(DIVERGED);
        }
        if !is_open.contains(&true) {
            break;
        }
    }
    found
}

/// A number of each triple.
#[derive(Debug, Clone, Copy)]
struct Lanes([f64; LANES]);

const ZERO: Lanes = Lanes::all(0.0);

impl Lanes {
    const fn all(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn by(self, other: Self, operation: impl Fn(f64, f64) -> f64) -> Self {
        let mut out = self;
        for (value, other) in out.0.iter_mut().zip(other.0) {
            *value = operation(*value, other);
        }
        out
    }

    /// These numbers, and `other` where those of `depth_m` lie too near.
    #[inline(always)]
    fn unless_near(self, depth_m: Self, other: f64) -> Self {
        self.by(depth_m, |value, depth_m| if depth_m < NEAR_M { other } else { value })
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        self.by(self, |value, _| value.sqrt())
    }
}

impl Add for Lanes {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.by(other, |a, b| a + b)
    }
}

impl Sub for Lanes {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.by(other, |a, b| a - b)
    }
}

impl Mul for Lanes {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.by(other, |a, b| a * b)
    }
}

impl Div for Lanes {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        self.by(other, |a, b| a / b)
    }
}

impl Neg for Lanes {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        self.by(self, |value, _| -value)
    }
}

/// The same one of three observations of each triple.
struct Seen {
    point_m: [Lanes; 3],
    seen_px: [Lanes; 3],
}

impl Seen {
    #[inline(always)]
    fn of(observations: &[Observation], triples: &[[usize; 3]; LANES], k: usize) -> Self {
        let mut seen = Self { point_m: [ZERO; 3], seen_px: [ZERO; 3] };
        for (lane, triple) in triples.iter().enumerate() {
            let observation = &observations[triple[k]];
            for axis in 0..3 {
                seen.point_m[axis].0[lane] = observation.point_m[axis];
                seen.seen_px[axis].0[lane] = observation.seen_px[axis];
            }
        }
        seen
    }
}

/// A rigid transform of each triple; see [`Se3`].
struct Motions {
    rotation: [[Lanes; 3]; 3],
    translation_m: [Lanes; 3],
}

impl Motions {
    fn all(motion: &Se3) -> Self {
        Self {
            rotation: motion.rotation.map(|row| row.map(Lanes::all)),
            translation_m: motion.translation_m.map(Lanes::all),
        }
    }

    fn of(&self, lane: usize) -> Se3 {
        Se3 {
            rotation: self.rotation.map(|row| row.map(|value| value.0[lane])),
            translation_m: self.translation_m.map(|value| value.0[lane]),
        }
    }

    /// As the function of this name of [`motion`](crate::motion).
    #[inline(always)]
    fn small(step: &[Lanes; 6]) -> Self {
        let (one, two) = (Lanes::all(1.0), Lanes::all(2.0));
        let [x, y, z] = [step[0] / two, step[1] / two, step[2] / two];
        let norm = (x * x + y * y + z * z + one).sqrt();
        let [x, y, z, w] = [x / norm, y / norm, z / norm, one / norm];
        let rotation = [
            [one - two * (y * y + z * z), two * (x * y - z * w), two * (x * z + y * w)],
            [two * (x * y + z * w), one - two * (x * x + z * z), two * (y * z - x * w)],
            [two * (x * z - y * w), two * (y * z + x * w), one - two * (x * x + y * y)],
        ];
        Self { rotation, translation_m: [step[3], step[4], step[5]] }
    }

    #[inline(always)]
    fn apply(&self, [x, y, z]: [Lanes; 3]) -> [Lanes; 3] {
        let row = |i: usize| {
            let [a, b, c] = self.rotation[i];
            a * x + b * y + c * z + self.translation_m[i]
        };
        [row(0), row(1), row(2)]
    }

    #[inline(always)]
    fn compose(&self, other: &Self) -> Self {
        let column = |j: usize| other.rotation.map(|row| row[j]);
        let turned = |row: [Lanes; 3], [x, y, z]: [Lanes; 3]| row[0] * x + row[1] * y + row[2] * z;
        let rotation =
            self.rotation.map(|row| [turned(row, column(0)), turned(row, column(1)), turned(row, column(2))]);
        Self { rotation, translation_m: self.apply(other.translation_m) }
    }
}

/// The normal equations of each triple; of the matrix, its lower triangle.
struct Equations {
    matrix: [[Lanes; 6]; 6],
    vector: [Lanes; 6],
}

impl Equations {
    /// Adds an observation, unless it lies behind the camera.
    #[inline(always)]
    fn add(&mut self, reprojection: &Reprojection, motions: &Motions, seen: &Seen) {
        let rig = reprojection.rig;
        let [focal, cu, cv, baseline] = [rig.focal_px, rig.cu_px, rig.cv_px, rig.baseline_m].map(Lanes::all);
        let [x, y, z] = motions.apply(seen.point_m);
        let depth = z.unless_near(z, 1.0);
        let scale = (focal / depth).unless_near(z, 0.0);
        let [u, v, right_u] = seen.seen_px;
        let slope = |side: Lanes| -scale * side / depth;
        let (of_u, of_v) = (slope(x), slope(y));
        let u_row = [y * of_u, z * scale - x * of_u, -(y * scale), scale, ZERO, of_u];
        let v_row = [y * of_v - z * scale, -(x * of_v), x * scale, ZERO, scale, of_v];
        self.add_row(&u_row, (x * scale + cu - u).unless_near(z, 0.0));
        self.add_row(&v_row, (y * scale + cv - v).unless_near(z, 0.0));
        if reprojection.views == Views::Stereo {
            let beside = x - baseline;
            let of_right = slope(beside);
            let right_row = [y * of_right, z * scale - x * of_right, -(y * scale), scale, ZERO, of_right];
            self.add_row(&right_row, (beside * scale + cu - right_u).unless_near(z, 0.0));
        }
    }

    #[inline(always)]
    fn add_row(&mut self, row: &[Lanes; 6], residual: Lanes) {
        for i in 0..6 {
            self.vector[i] = self.vector[i] + row[i] * residual;
            for j in i..6 {
                self.matrix[j][i] = self.matrix[j][i] + row[i] * row[j];
            }
        }
    }

    /// The solutions by Cholesky's factors, and where there is one.
    #[inline(always)]
    fn solve(mut self) -> ([Lanes; 6], [bool; LANES]) {
        let mut is_regular = [true; LANES];
        let matrix = &mut self.matrix;
        for j in 0..6 {
            for k in 0..j {
                let factor = -matrix[j][k];
                for row in &mut matrix[j..] {
                    row[j] = factor * row[k] + row[j];
                }
            }
            let pivot = matrix[j][j];
            is_regular.iter_mut().zip(pivot.0).for_each(|(is_regular, pivot)| *is_regular &= pivot > 0.0);
            let root = pivot.sqrt();
            matrix[j][j] = root;
            for row in &mut matrix[j + 1..] {
                row[j] = row[j] / root;
            }
        }
        let mut solution = self.vector;
        for i in 0..6 {
            solution[i] = solution[i] / matrix[i][i];
            for row in i + 1..6 {
                solution[row] = -solution[i] * matrix[row][i] + solution[row];
            }
        }
        for i in (0..6).rev() {
            let known = (i + 1..6).fold(ZERO, |sum, row| sum + matrix[row][i] * solution[row]);
            solution[i] = (solution[i] - known) / matrix[i][i];
        }
        (solution, is_regular)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Weights;
    use crate::motion::tests::{RIG, exact, motion, uniform};
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn bits(motion: Se3) -> [u64; 12] {
        let numbers: Vec<f64> = motion.rotation.into_iter().flatten().chain(motion.translation_m).collect();
        std::array::from_fn(|i| numbers[i].to_bits())
    }

    #[test]
    fn eight_at_a_time_are_the_same_bits_as_one_by_one() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let (mut found, mut refused) = (0, 0);
        for views in [Views::Left, Views::Stereo] {
            let reprojection = Reprojection { rig: &RIG, views, weights: Weights::Equal };
            // A third as they are, a third seen elsewhere, a third behind the camera or close to it; one thrice.
            let mut observations = exact(&motion(), 90, 4);
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
                for (rounds, settled) in [(20, 1e-4), (3, 1e-9)] {
                    let together =
                        fit_triples(&reprojection, &Se3::IDENTITY, &observations, &triples, (rounds, settled));
                    let portable = fit(&reprojection, &Se3::IDENTITY, &observations, &triples, (rounds, settled));
                    for (lane, triple) in triples.iter().enumerate() {
                        let chosen = triple.iter().map(|&i| (&observations[i], 1.0));
                        let alone = reprojection.fit(&Se3::IDENTITY, chosen, rounds, settled);
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
