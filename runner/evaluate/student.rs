//! Student's t with whole degrees of freedom, in closed form (Abramowitz and Stegun 1964, 26.7.3 and 26.7.4).

/// The chance that |t| exceeds `t` with so many degrees of freedom, at least 1.
pub(super) fn two_sided_p(t: f64, degrees: u32) -> f64 {
    let degrees = degrees.max(1);
    let whole = f64::from(degrees);
    let (sin, cos) = (t.abs() / (whole + t * t).sqrt(), (whole / (whole + t * t)).sqrt());
    let is_odd = degrees % 2 == 1;
    // Terms are cos^k times a product of ratios of neighbouring numbers, k rising in steps of two.
    let (mut term, mut k) = if is_odd { (cos, 1) } else { (1.0, 0) };
    let mut sum = 0.0;
    while k + 2 <= degrees {
        sum += term;
        term *= cos * cos * f64::from(k + 1) / f64::from(k + 2);
        k += 2;
    }
    let within =
        if is_odd { std::f64::consts::FRAC_2_PI * (libm::atan2(t.abs(), whole.sqrt()) + sin * sum) } else { sin * sum };
    (1.0 - within).clamp(0.0, 1.0)
}

/// The t that |t| exceeds with a chance of 5 %.
pub(super) fn critical(degrees: u32) -> f64 {
    let (mut low, mut high) = (1.9, 13.0);
    for _ in 0..60 {
        let middle = f64::midpoint(low, high);
        if two_sided_p(middle, degrees) > 0.05 { low = middle } else { high = middle }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tables of Student's t, two-sided.
    #[test]
    fn values_are_those_of_the_tables() {
        let five_percent =
            [(1, 12.706), (2, 4.303), (3, 3.182), (4, 2.776), (5, 2.571), (8, 2.306), (9, 2.262), (30, 2.042)];
        for (degrees, t) in five_percent {
            assert!((critical(degrees) - t).abs() < 6e-4, "{degrees} degrees of freedom: {}", critical(degrees));
        }
        for (degrees, t, p) in [(1, 63.657, 0.01), (2, 9.925, 0.01), (7, 3.499, 0.01), (10, 1.812, 0.1)] {
            assert!((two_sided_p(t, degrees) - p).abs() < 1e-4, "{degrees}: {}", two_sided_p(t, degrees));
        }
        assert_eq!([1, 2, 7].map(|degrees| two_sided_p(0.0, degrees)), [1.0; 3]);
    }
}
