//! Roots of cubic polynomials.

/// A leading coefficient below this share of the largest is zero: its root lies at infinity.
const NEGLIGIBLE: f64 = 1e-12;

/// The real roots of a x^3 + b x^2 + c x + d, of lower degree if leading coefficients are zero.
pub(super) fn real_roots([a, b, c, d]: [f64; 4]) -> impl Iterator<Item = f64> {
    let mut roots = [None; 3];
    let largest = [a, b, c, d].into_iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    if a.abs() > NEGLIGIBLE * largest {
        // x = t - b / 3a makes it t^3 + p t + q (Cardano).
        let (b, c, d) = (b / a, c / a, d / a);
        let (p, q, shift) = (c - b * b / 3.0, 2.0 * b * b * b / 27.0 - b * c / 3.0 + d, b / 3.0);
        let discriminant = q * q / 4.0 + p * p * p / 27.0;
        if discriminant > 0.0 {
            let root = discriminant.sqrt();
            roots[0] = Some(libm::cbrt(-q / 2.0 + root) + libm::cbrt(-q / 2.0 - root) - shift);
        } else {
            let radius = 2.0 * (-p / 3.0).sqrt();
            let angle = libm::acos((3.0 * q / (p * radius)).clamp(-1.0, 1.0)) / 3.0;
            let root = |k: f64| radius * libm::cos(angle - k * std::f64::consts::TAU / 3.0) - shift;
            roots = [0.0, 1.0, 2.0].map(|k| Some(root(k)));
        }
    } else if b.abs() > NEGLIGIBLE * largest {
        let root = (c * c - 4.0 * b * d).sqrt();
        roots = [Some((-c + root) / (2.0 * b)), Some((-c - root) / (2.0 * b)), None];
    } else {
        roots[0] = Some(-d / c);
    }
    // The square root of a negative number and a division by zero are not finite: no root.
    roots.into_iter().flatten().filter(|root| root.is_finite())
}

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
