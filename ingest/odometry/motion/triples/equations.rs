//! Normal equations of eight triples.

use super::lanes::{LANES, Lanes, ZERO};
use super::motions::Motions;
use crate::motion::observation::Observation;
use crate::motion::reprojection::{Reprojection, Views};

/// One of the three observations of each triple.
pub(super) struct Seen {
    point_m: [Lanes; 3],
    seen_px: [Lanes; 3],
}

impl Seen {
    /// The observation `k` of each triple.
    #[inline(always)]
    pub fn gather(observations: &[Observation], triples: &[[usize; 3]; LANES], k: usize) -> Self {
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

/// The normal equations of each triple. Of the matrix only the lower triangle is used.
pub(super) struct Equations {
    matrix: [[Lanes; 6]; 6],
    vector: [Lanes; 6],
}

impl Equations {
    pub const ZERO: Self = Self { matrix: [[ZERO; 6]; 6], vector: [ZERO; 6] };

    /// Adds an observation, unless it lies behind the camera.
    #[inline(always)]
    pub fn add(&mut self, reprojection: &Reprojection, motions: &Motions, seen: &Seen) {
        let rig = reprojection.rig;
        let [focal, cu, cv, baseline] = [rig.focal_px, rig.cu_px, rig.cv_px, rig.baseline_m].map(Lanes::all);
        let [x, y, z] = motions.apply(seen.point_m);
        let depth = z.unless_near(z, 1.0);
        let scale = (focal / depth).unless_near(z, 0.0);
        let [u, v, right_u] = seen.seen_px;
        let slope = |side: Lanes| -scale * side / depth;
        let (u_by_z, v_by_z) = (slope(x), slope(y));
        let u_row = [y * u_by_z, z * scale - x * u_by_z, -(y * scale), scale, ZERO, u_by_z];
        let v_row = [y * v_by_z - z * scale, -(x * v_by_z), x * scale, ZERO, scale, v_by_z];
        self.add_row(&u_row, (x * scale + cu - u).unless_near(z, 0.0));
        self.add_row(&v_row, (y * scale + cv - v).unless_near(z, 0.0));
        if reprojection.views == Views::Stereo {
            let beside = x - baseline;
            let right_by_z = slope(beside);
            let right_row = [y * right_by_z, z * scale - x * right_by_z, -(y * scale), scale, ZERO, right_by_z];
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

    /// The solutions by Cholesky decomposition, and which lanes have one.
    #[inline(always)]
    pub fn solve(mut self) -> ([Lanes; 6], [bool; LANES]) {
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
