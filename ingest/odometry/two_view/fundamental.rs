//! Fundamental matrices: from seven correspondences (Hartley and Zisserman 2004, 11.1.2), from eight or more (11.2, normalised), and how far
//! a correspondence is from agreeing with one (11.4.3).

use crate::verify::Correspondence;
use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen, Vector3};

/// Places of both images moved to their mean and scaled to a mean distance of sqrt 2, without which the equations are ill-conditioned.
pub(super) struct Normalised {
    /// (live, candidate), each (x, y).
    pub points: Vec<[[f64; 2]; 2]>,
    live: Scaling,
    candidate: Scaling,
}

/// x' = (x - mean) * scale.
struct Scaling {
    mean: [f64; 2],
    scale: f64,
}

impl Scaling {
    fn of(points: impl Iterator<Item = [f64; 2]> + Clone) -> Option<Self> {
        let count = points.clone().count() as f64;
        let mean = [0, 1].map(|k| points.clone().map(|point| point[k]).sum::<f64>() / count);
        let apart = |point: [f64; 2]| ((point[0] - mean[0]).powi(2) + (point[1] - mean[1]).powi(2)).sqrt();
        let spread = points.map(apart).sum::<f64>() / count;
        (spread > 0.0 && spread.is_finite()).then(|| Self { mean, scale: std::f64::consts::SQRT_2 / spread })
    }

    fn apply(&self, point: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|k| (point[k] - self.mean[k]) * self.scale)
    }

    fn matrix(&self) -> Matrix3<f64> {
        let (s, [x, y]) = (self.scale, self.mean);
        Matrix3::new(s, 0.0, -s * x, 0.0, s, -s * y, 0.0, 0.0, 1.0)
    }
}

impl Normalised {
    /// `None` where all places of one image coincide.
    pub fn of(correspondences: &[Correspondence]) -> Option<Self> {
        let live = Scaling::of(correspondences.iter().map(|c| c.live_px))?;
        let candidate = Scaling::of(correspondences.iter().map(|c| c.candidate_px))?;
        let points = correspondences.iter().map(|c| [live.apply(c.live_px), candidate.apply(c.candidate_px)]).collect();
        Some(Self { points, live, candidate })
    }

    /// A matrix of normalised places as one of pixels.
    pub fn to_pixels(&self, matrix: &Matrix3<f64>) -> Matrix3<f64> {
        self.candidate.matrix().transpose() * matrix * self.live.matrix()
    }

    /// The one to three matrices of rank 2 that seven correspondences satisfy; none where their places are degenerate.
    pub fn of_seven(&self, seven: &[usize; 7]) -> impl Iterator<Item = Matrix3<f64>> {
        let equations = SMatrix::<f64, 7, 9>::from_fn(|row, column| equation(&self.points[seven[row]])[column]);
        let lu = equations.full_piv_lu();
        let upper = lu.u();
        let (head, tail) = (upper.fixed_columns::<7>(0).into_owned(), upper.fixed_columns::<2>(7).into_owned());
        // Where there is no solution, nothing finite comes of it.
        let solved = head.solve_upper_triangular(&-tail).unwrap_or_else(|| SMatrix::repeat(f64::NAN));
        let mut kernel = SMatrix::<f64, 9, 2>::zeros();
        kernel.fixed_rows_mut::<7>(0).copy_from(&solved);
        (kernel[(7, 0)], kernel[(8, 1)]) = (1.0, 1.0);
        lu.q().inv_permute_rows(&mut kernel);
        let [a, b] = [0, 1].map(|k| as_matrix(&kernel.column(k).into_owned()).normalize());
        // det(a + x b) is a cubic in x; its coefficients from its values at 0, 1 and -1.
        let (c0, c3) = (a.determinant(), b.determinant());
        let (plus, minus) = ((a + b).determinant(), (a - b).determinant());
        let (c2, c1) = ((plus + minus) / 2.0 - c0, (plus - minus) / 2.0 - c3);
        real_roots([c3, c2, c1, c0]).map(move |x| a + b * x).filter(|m| m.iter().all(|v| v.is_finite()))
    }

    /// The matrix of rank 2 nearest to the least-squares solution for at least eight correspondences.
    pub fn of_many(&self, chosen: &[usize]) -> Option<Matrix3<f64>> {
        if chosen.len() < 8 {
            return None;
        }
        let mut squares = SMatrix::<f64, 9, 9>::zeros();
        for &i in chosen {
            let row = SVector::<f64, 9>::from(equation(&self.points[i]));
            squares += row * row.transpose();
        }
        let eigen = SymmetricEigen::try_new(squares, f64::EPSILON, EIGEN_ROUNDS)?;
        let matrix = as_matrix(&eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned());
        let mut svd = matrix.try_svd(true, true, f64::EPSILON, EIGEN_ROUNDS)?;
        let least = svd.singular_values.imin();
        svd.singular_values[least] = 0.0;
        svd.recompose().ok()
    }
}

/// Decompositions of matrices this small settle within some ten rounds.
const EIGEN_ROUNDS: usize = 100;

/// candidate^T F live = 0 as an equation in the entries of F by rows.
fn equation(&[[x, y], [u, v]]: &[[f64; 2]; 2]) -> [f64; 9] {
    [u * x, u * y, u, v * x, v * y, v, x, y, 1.0]
}

fn as_matrix(entries: &SVector<f64, 9>) -> Matrix3<f64> {
    Matrix3::from_row_slice(entries.as_slice())
}

/// Squared distance of a correspondence from the places that satisfy `matrix`, to first order, px^2 (Sampson 1982), at most `limit`. Most are
/// farther than that, and not divided to find out.
pub(super) fn squared_error(matrix: &Matrix3<f64>, c: &Correspondence, limit: f64) -> f64 {
    let live = Vector3::new(c.live_px[0], c.live_px[1], 1.0);
    let candidate = Vector3::new(c.candidate_px[0], c.candidate_px[1], 1.0);
    let (line, back) = (matrix * live, matrix.tr_mul(&candidate));
    let slope = line.x * line.x + line.y * line.y + back.x * back.x + back.y * back.y;
    let product = candidate.dot(&line);
    if product * product < limit * slope { product * product / slope } else { limit }
}

/// The real roots of a x^3 + b x^2 + c x + d, falling to lower degrees where leading coefficients vanish.
fn real_roots([a, b, c, d]: [f64; 4]) -> impl Iterator<Item = f64> {
    let mut roots = [f64::NAN; 3];
    let largest = [a, b, c, d].into_iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    if a.abs() > VANISHES * largest {
        // x = t - b / 3a makes it t^3 + p t + q.
        let (b, c, d) = (b / a, c / a, d / a);
        let (p, q, shift) = (c - b * b / 3.0, 2.0 * b * b * b / 27.0 - b * c / 3.0 + d, b / 3.0);
        let discriminant = q * q / 4.0 + p * p * p / 27.0;
        if discriminant > 0.0 {
            let root = discriminant.sqrt();
            roots[0] = libm::cbrt(-q / 2.0 + root) + libm::cbrt(-q / 2.0 - root) - shift;
        } else {
            let radius = 2.0 * (-p / 3.0).sqrt();
            let angle = libm::acos((3.0 * q / (p * radius)).clamp(-1.0, 1.0)) / 3.0;
            roots = [0.0, 1.0, 2.0].map(|k| radius * libm::cos(angle - k * std::f64::consts::TAU / 3.0) - shift);
        }
    } else if b.abs() > VANISHES * largest {
        let root = (c * c - 4.0 * b * d).sqrt();
        roots = [(-c + root) / (2.0 * b), (-c - root) / (2.0 * b), f64::NAN];
    } else {
        roots[0] = -d / c;
    }
    roots.into_iter().filter(|root| root.is_finite())
}

/// A leading coefficient below this share of the largest has its root at infinity.
const VANISHES: f64 = 1e-12;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_roots_and_all_of_them() {
        let cubic =
            |r: [f64; 3]| [1.0, -r[0] - r[1] - r[2], r[0] * r[1] + r[1] * r[2] + r[2] * r[0], -r[0] * r[1] * r[2]];
        for roots in [[1.0, 2.0, 3.0], [-5.0, 0.25, 40.0], [0.0, -1.0, 1.0]] {
            let mut found: Vec<f64> = real_roots(cubic(roots).map(|c| 7.0 * c)).collect();
            found.sort_by(f64::total_cmp);
            let mut expected = roots;
            expected.sort_by(f64::total_cmp);
            assert_eq!(found.len(), 3);
            assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} {expected:?}");
        }
        assert_eq!(real_roots([1.0, 0.0, 0.0, -8.0]).collect::<Vec<_>>(), [2.0]);
        assert_eq!(real_roots([0.0, 1.0, 0.0, -4.0]).collect::<Vec<_>>(), [2.0, -2.0]);
        assert_eq!(real_roots([0.0, 0.0, 2.0, -8.0]).collect::<Vec<_>>(), [4.0]);
        assert_eq!(real_roots([0.0; 4]).count() + real_roots([0.0, 1.0, 0.0, 4.0]).count(), 0);
    }
}
