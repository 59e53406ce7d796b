//! Transport against closed forms.

use furrow_generator::transport::Transport;
use proptest::prelude::*;

type Matrix = [[f64; 3]; 3];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

fn near(a: &Matrix, b: &Matrix, within: f64) -> bool {
    a.iter().flatten().zip(b.iter().flatten()).all(|(a, b)| (a - b).abs() < within)
}

fn diagonal(d: [f64; 3]) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| if i == j { d[i] } else { 0.0 }))
}

/// A rotation by three angles.
fn rotation([a, b, c]: [f64; 3]) -> Matrix {
    let about_z = |t: f64| [[t.cos(), -t.sin(), 0.0], [t.sin(), t.cos(), 0.0], [0.0, 0.0, 1.0]];
    let about_x = |t: f64| [[1.0, 0.0, 0.0], [0.0, t.cos(), -t.sin()], [0.0, t.sin(), t.cos()]];
    product(&product(&about_z(a), &about_x(b)), &about_z(c))
}

fn transposed(a: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| a[j][i]))
}

/// The symmetric matrix with these axes and eigenvalues.
fn symmetric(axes: &Matrix, values: [f64; 3]) -> Matrix {
    product(&product(axes, &diagonal(values)), &transposed(axes))
}

/// In one dimension the map is the ratio of the deviations.
#[test]
fn single_axes_are_stretched_by_the_ratio_of_deviations() {
    let found = Transport::between(&diagonal([4.0, 1.0, 0.25]), &diagonal([1.0, 1.0, 1.0])).at(1.0);
    assert!(near(&found, &diagonal([0.5, 1.0, 2.0]), 1e-9), "{found:?}");
}

fn values(range: std::ops::Range<f64>) -> impl Strategy<Value = [f64; 3]> {
    proptest::array::uniform3(range)
}

proptest! {
    /// Covariances with common axes: the ratio of the deviations along each.
    #[test]
    fn commuting_covariances_have_a_closed_form(angles in values(-3.0..3.0), a in values(0.05..2.0), ratio in values(0.35..1.9)) {
        let axes = rotation(angles);
        let b = std::array::from_fn(|i| a[i] * ratio[i] * ratio[i]);
        let found = Transport::between(&symmetric(&axes, a), &symmetric(&axes, b)).at(1.0);
        prop_assert!(near(&found, &symmetric(&axes, ratio), 1e-7), "{found:?}");
    }

    /// Every symmetric positive map is the best one between a Gaussian and what it makes of it (Brenier), and is found
    /// again.
    #[test]
    fn the_best_map_is_found_again(first in values(-3.0..3.0), second in values(-3.0..3.0), a in values(0.05..2.0), m in values(0.3..3.0)) {
        let (a, map) = (symmetric(&rotation(first), a), symmetric(&rotation(second), m));
        let b = product(&product(&map, &a), &map);
        let found = Transport::between(&a, &b).at(1.0);
        prop_assert!(near(&found, &map, 1e-6), "{found:?} {map:?}");
        prop_assert!(near(&product(&product(&found, &a), &transposed(&found)), &b, 1e-6));
    }

    /// The way is straight from the identity, until a stretch meets its limit; at 0 it is the identity.
    #[test]
    fn the_way_is_straight(angles in values(-3.0..3.0), m in values(0.4..1.9), z in 0.0..1.5_f64) {
        let axes = rotation(angles);
        let transport = Transport::between(&diagonal([1.0; 3]), &symmetric(&axes, m.map(|m| m * m)));
        prop_assert!(near(&transport.at(0.0), &diagonal([1.0; 3]), 1e-12));
        let wanted = m.map(|m: f64| (1.0 + z * (m - 1.0)).clamp(0.1, 4.0));
        prop_assert!(near(&transport.at(z), &symmetric(&axes, wanted), 1e-7));
    }
}

/// Covariances without spread in some direction give numbers, not infinities.
#[test]
fn flat_covariances_are_survived() {
    for (a, b) in [([0.0; 3], [1.0; 3]), ([1.0; 3], [0.0; 3]), ([0.0; 3], [0.0; 3]), ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0])]
    {
        let found = Transport::between(&diagonal(a), &diagonal(b));
        assert!([-0.5, 0.0, 1.0, 2.0].iter().all(|z| found.at(*z).iter().flatten().all(|value| value.is_finite())));
    }
}
