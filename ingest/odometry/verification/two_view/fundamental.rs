//! Fundamental matrices: from seven correspondences (Hartley and Zisserman 2004, section 11.1.2), from eight or more by
//! the normalised algorithm (section 11.2), and the error of a correspondence (section 11.4.3).

use super::cubic::real_roots;
use crate::verification::correspondence::Correspondence;
use nalgebra::{Matrix3, SMatrix, SVector, SymmetricEigen, Vector3};

/// Places of both images, moved to mean zero and scaled to a mean distance of sqrt 2 from it. Without that the
/// equations are ill-conditioned.
pub(super) struct Normalised {
    /// (live, candidate), each (x, y).
    points: Vec<[[f64; 2]; 2]>,
    live: Scaling,
    candidate: Scaling,
}

/// x' = (x - mean) * scale.
struct Scaling {
    mean: [f64; 2],
    scale: f64,
}

impl Scaling {
    fn new(points: impl Iterator<Item = [f64; 2]> + Clone) -> Option<Self> {
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
    /// `None` if all places of one image coincide.
    pub fn new(correspondences: &[Correspondence]) -> Option<Self> {
        let live = Scaling::new(correspondences.iter().map(|c| c.live_px))?;
        let candidate = Scaling::new(correspondences.iter().map(|c| c.candidate_px))?;
        let points = correspondences.iter().map(|c| [live.apply(c.live_px), candidate.apply(c.candidate_px)]).collect();
        Some(Self { points, live, candidate })
    }

    /// A matrix for normalised places as one for pixels.
    pub fn to_pixels(&self, matrix: &Matrix3<f64>) -> Matrix3<f64> {
        self.candidate.matrix().transpose() * matrix * self.live.matrix()
    }

    /// The one to three matrices of rank 2 that seven correspondences satisfy. None if their places are degenerate.
    pub fn solve_seven(&self, seven: &[usize; 7]) -> impl Iterator<Item = Matrix3<f64>> {
        self.kernel(seven).into_iter().flat_map(|[a, b]| {
            // det(a + x b) is a cubic in x; its coefficients from its values at 0, 1 and -1.
            let (c0, c3) = (a.determinant(), b.determinant());
            let (plus, minus) = ((a + b).determinant(), (a - b).determinant());
            let (c2, c1) = ((plus + minus) / 2.0 - c0, (plus - minus) / 2.0 - c3);
            real_roots([c3, c2, c1, c0]).map(move |x| a + b * x).filter(|m| m.iter().all(|v| v.is_finite()))
        })
    }

    /// Two matrices whose linear combinations satisfy the equations of seven correspondences.
    fn kernel(&self, seven: &[usize; 7]) -> Option<[Matrix3<f64>; 2]> {
        let equations = SMatrix::<f64, 7, 9>::from_fn(|row, column| equation(&self.points[seven[row]])[column]);
        let lu = equations.full_piv_lu();
        let upper = lu.u();
        let (head, tail) = (upper.fixed_columns::<7>(0).into_owned(), upper.fixed_columns::<2>(7).into_owned());
        let solved = head.solve_upper_triangular(&-tail)?;
        let mut kernel = SMatrix::<f64, 9, 2>::zeros();
        kernel.fixed_rows_mut::<7>(0).copy_from(&solved);
        (kernel[(7, 0)], kernel[(8, 1)]) = (1.0, 1.0);
        lu.q().inv_permute_rows(&mut kernel);
        Some([0, 1].map(|k| as_matrix(&kernel.column(k).into_owned()).normalize()))
    }

    /// The matrix of rank 2 nearest to the least-squares solution for at least eight correspondences.
    pub fn fit_many(&self, chosen: &[usize]) -> Option<Matrix3<f64>> {
        if chosen.len() < 8 {
            return None;
        }
        let mut squares = SMatrix::<f64, 9, 9>::zeros();
        for &i in chosen {
            let row = SVector::<f64, 9>::from(equation(&self.points[i]));
            squares += row * row.transpose();
        }
        let eigen = SymmetricEigen::try_new(squares, f64::EPSILON, EIGEN_ITERATIONS)?;
        let matrix = as_matrix(&eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned());
        let mut svd = matrix.try_svd(true, true, f64::EPSILON, EIGEN_ITERATIONS)?;
        let least = svd.singular_values.imin();
        svd.singular_values[least] = 0.0;
        svd.recompose().ok()
    }
}

/// Decompositions of matrices this small converge within about ten iterations.
const EIGEN_ITERATIONS: usize = 100;

/// candidate^T F live = 0 as an equation in the entries of F by rows.
fn equation(&[[x, y], [u, v]]: &[[f64; 2]; 2]) -> [f64; 9] {
    [u * x, u * y, u, v * x, v * y, v, x, y, 1.0]
}

fn as_matrix(entries: &SVector<f64, 9>) -> Matrix3<f64> {
    Matrix3::from_row_slice(entries.as_slice())
}

/// The squared Sampson error of a correspondence, at most `limit`, px^2 (Hartley and Zisserman 2004, Eq. 11.9). Most
/// errors are above the limit, and need no division.
pub(super) fn squared_error(matrix: &Matrix3<f64>, c: &Correspondence, limit: f64) -> f64 {
    let live = Vector3::new(c.live_px[0], c.live_px[1], 1.0);
    let candidate = Vector3::new(c.candidate_px[0], c.candidate_px[1], 1.0);
    let (line, back) = (matrix * live, matrix.tr_mul(&candidate));
    let slope = line.x * line.x + line.y * line.y + back.x * back.x + back.y * back.y;
    let product = candidate.dot(&line);
    if product * product < limit * slope { product * product / slope } else { limit }
}
