//! Monge-Kantorovich transport between Gaussians: the linear map with the least mean squared way that carries one onto
//! the other (Pitié and Kokaram 2007), and McCann's displacement interpolation, any part of that way.

use nalgebra::{Matrix3, SymmetricEigen, Vector3};
use serde::{Deserialize, Serialize};

/// Factors by which a map may stretch an axis of colour: beyond, noise becomes texture or texture nothing.
pub const STRETCH: [f64; 2] = [0.1, 4.0];

/// A symmetric positive map of colours, by its axes.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Transport {
    /// By how much each axis is stretched at z = 1.
    pub stretch: [f64; 3],
    /// The axes, unit vectors at right angles.
    pub axes: [[f64; 3]; 3],
}

/// The square root of a symmetric matrix or, with a negative `power`, its inverse; directions without spread count as
/// 1e-12.
fn power(matrix: &Matrix3<f64>, power: i32) -> Matrix3<f64> {
    let eigen = SymmetricEigen::new(*matrix);
    let roots =
        eigen.eigenvalues.map(|value| if power > 0 { value.max(1e-12).sqrt() } else { 1.0 / value.max(1e-12).sqrt() });
    eigen.eigenvectors * Matrix3::from_diagonal(&roots) * eigen.eigenvectors.transpose()
}

fn symmetric(matrix: &Matrix3<f64>) -> Matrix3<f64> {
    (matrix + matrix.transpose()) * 0.5
}

impl Transport {
    /// The transport of covariance `a` onto covariance `b`: A = a^-1/2 (a^1/2 b a^1/2)^1/2 a^-1/2.
    pub fn between(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> Self {
        let matrix = |rows: &[[f64; 3]; 3]| symmetric(&Matrix3::from_fn(|i, j| rows[i][j]));
        let (a, b) = (matrix(a), matrix(b));
        let (root, inverse) = (power(&a, 1), power(&a, -1));
        let middle = power(&symmetric(&(root * b * root)), 1);
        let eigen = SymmetricEigen::new(symmetric(&(inverse * middle * inverse)));
        Self {
            stretch: std::array::from_fn(|i| eigen.eigenvalues[i]),
            axes: std::array::from_fn(|i| {
                let axis: Vector3<f64> = eigen.eigenvectors.column(i).into();
                [axis[0], axis[1], axis[2]]
            }),
        }
    }

    /// The map at part `z` of the way: (1 - z) I + z A, its stretches held to [`STRETCH`]. At z = 0 it is the identity.
    pub fn at(&self, z: f64) -> [[f64; 3]; 3] {
        let stretch = self.stretch.map(|stretch| (1.0 + z * (stretch - 1.0)).clamp(STRETCH[0], STRETCH[1]));
        std::array::from_fn(|i| {
            std::array::from_fn(|j| (0..3).map(|k| stretch[k] * self.axes[k][i] * self.axes[k][j]).sum())
        })
    }
}
