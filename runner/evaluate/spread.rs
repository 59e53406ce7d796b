//! How far a sum along the road may lie from what other traversals of the same road would give.
//!
//! **One traversal.** What lies side by side is alike, so the sum of n metres has a variance of n times the series'
//! spectral density at frequency zero. It is estimated from the first few cosines of the series (equally weighted:
//! Müller 2004; Lazarus, Lewis, Stock and Watson 2018), which makes (sum - truth) / error Student's t with as many
//! degrees of freedom as cosines, however short the road. Each square is multiplied by 1 + (ω λ)², the ratio between
//! the densities at 0 and at its frequency for an autoregression of correlation length λ (Andrews and Monahan 1992). λ
//! is estimated from the series by its initial positive autocorrelations (Geyer 1992), and taken for
//! [`ALIKE_M`] at least, since a short road cannot tell that it is alike over long stretches.
//!
//! **Several traversals.** Their sums are independent, so it is Student's t over them: what differs from one
//! traversal to the next counts. Unequal lengths make it careful, never careless (Bakirov and Székely 2005).
//!
//! Nothing is taken for more certain than if every metre stood alone. The simulation in `coverage` holds all of this to
//! its promise: of equal contenders about one in twenty looks different at most.

use std::f64::consts::{PI, SQRT_2};

/// Road within this distance is taken for alike, whatever a series shows: a correlation length (1 / e), metres.
pub(super) const ALIKE_M: f64 = 10.0;
/// One traversal below this has no interval: six stretches that are alike. Metres.
pub(super) const LEAST_M: usize = 60;
/// Cosines: a series' lowest frequencies, one for every two correlation lengths.
const MOST_COSINES: u32 = 8;
const LEAST_COSINES: u32 = 2;

/// The variance of a sum.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Spread {
    /// Of the sum, in its unit squared.
    pub variance: f64,
    /// Degrees of freedom of Student's t.
    pub degrees: u32,
    /// Stretches of road, or traversals, that count as independent: one more than the degrees of freedom.
    pub blocks: u32,
    /// The mean length of these, metres.
    pub block_m: f64,
    /// What follows from the spread within traversals alone; `None` where one is too short to tell.
    pub within: Option<f64>,
    /// What follows from the spread between traversals; `None` of a single one.
    pub between: Option<f64>,
}

/// The variance of the sum over all traversals, each a value per metre of road; `None` of too little road: a single
/// traversal below [`LEAST_M`].
pub(super) fn spread(traversals: &[Vec<f64>]) -> Option<Spread> {
    let driven: Vec<&Vec<f64>> = traversals.iter().filter(|series| !series.is_empty()).collect();
    let road_m: usize = driven.iter().map(|series| series.len()).sum();
    let alone: f64 = driven.iter().flat_map(|series| series.iter()).map(|value| value * value).sum();
    let along: Option<Vec<(f64, u32)>> = driven.iter().map(|series| along(series)).collect();
    let within = along.as_ref().map(|all| all.iter().map(|(variance, _)| variance).sum::<f64>());
    let between = between(&driven);
    let (variance, degrees) = match (between, along.as_deref()) {
        (Some(between), _) => (between, driven.len() as u32 - 1),
        (None, Some([one])) => *one,
        _ => return None,
    };
    let blocks = degrees + 1;
    let block_m = road_m as f64 / f64::from(blocks);
    Some(Spread { variance: variance.max(alone), degrees, blocks, block_m, within, between })
}

/// From the sums of several traversals.
fn between(traversals: &[&Vec<f64>]) -> Option<f64> {
    let sums: Vec<f64> = traversals.iter().map(|series| series.iter().sum()).collect();
    let count = sums.len() as f64;
    let mean = sums.iter().sum::<f64>() / count;
    let squares: f64 = sums.iter().map(|sum| (sum - mean) * (sum - mean)).sum();
    (sums.len() > 1).then(|| count * squares / (count - 1.0))
}

/// The degrees of freedom of one traversal: so many cosines are used; `None` of too little road.
pub(super) fn cosines(road_m: usize, alike_m: f64) -> Option<u32> {
    let cosines = (road_m as f64 / (2.0 * alike_m)) as u32;
    (road_m >= LEAST_M).then(|| cosines.clamp(LEAST_COSINES, MOST_COSINES))
}

/// From the cosines of one traversal, and how many.
pub(super) fn along(series: &[f64]) -> Option<(f64, u32)> {
    cosines(series.len(), ALIKE_M)?;
    let road_m = series.len() as f64;
    let alike_m = correlation_m(series).max(ALIKE_M);
    let cosines = cosines(series.len(), alike_m)?;
    let square = |j: u32| {
        let per_metre = PI * f64::from(j) / road_m;
        let at = |i: usize| libm::cos(per_metre * (i as f64 + 0.5));
        let amplitude = SQRT_2 * series.iter().enumerate().map(|(i, value)| value * at(i)).sum::<f64>();
        amplitude * amplitude * (1.0 + (per_metre * alike_m) * (per_metre * alike_m))
    };
    Some(((1..=cosines).map(square).sum::<f64>() / f64::from(cosines), cosines))
}

/// The correlation length of a series with a value per metre: half the integral of its autocorrelation, as far as
/// neighbouring pairs of lags are positive; metres.
fn correlation_m(series: &[f64]) -> f64 {
    let mean = series.iter().sum::<f64>() / series.len() as f64;
    let centred: Vec<f64> = series.iter().map(|value| value - mean).collect();
    let at = |lag: usize| centred.iter().zip(&centred[lag..]).map(|(a, b)| a * b).sum::<f64>();
    let power = at(0);
    let all: f64 = series.iter().map(|value| value * value).sum();
    // What is the same everywhere is so up to rounding.
    if power <= 1e-12 * all {
        return 0.0;
    }
    let pairs = (0..series.len() / 2).map(|pair| (at(2 * pair) + at(2 * pair + 1)) / power);
    pairs.take_while(|pair| *pair > 0.0).sum::<f64>() - 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    /// Independent numbers between -1 and 1.
    fn drawn(count: usize) -> Vec<f64> {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        (0..count).map(|_| random.random_range(-1.0..1.0)).collect()
    }

    /// Of a series without any correlation, the variance of the sum is that of its values times their number.
    #[test]
    fn independent_metres_have_the_variance_of_a_sum() {
        let found = spread(&[drawn(4000)]).unwrap();
        assert_eq!((found.degrees, found.blocks, found.between), (8, 9, None));
        // Uniform on -1 to 1: a third each. Eight squares know it to within a factor of three.
        let expected = 4000.0 / 3.0;
        assert!((expected / 3.0..3.0 * expected).contains(&found.variance), "{found:?}");
    }

    /// A moving mean over 25 m: its autocorrelation is a triangle, and the integral of that 25 m.
    #[test]
    fn the_correlation_length_is_half_the_integral_of_the_autocorrelation() {
        let series: Vec<f64> = drawn(40_000).windows(25).map(|window| window.iter().sum()).collect();
        let found = correlation_m(&series);
        assert!((found - 12.5).abs() < 2.5, "{found}");
        assert_eq!((correlation_m(&[1.0 / 80.0; 80]), correlation_m(&[0.0; 80])), (0.0, 0.0));
    }

    #[test]
    fn several_traversals_are_told_by_their_sums() {
        let pass = |value: f64| vec![value; 10];
        let found = spread(&[pass(0.4), pass(0.6), pass(0.5)]).unwrap();
        // Sums 4, 6 and 5: a variance of 1, three times for their sum. Were metres alone, it would be 7.7.
        assert!((found.between.unwrap() - 3.0).abs() < 1e-9 && (found.variance - 7.7).abs() < 1e-9, "{found:?}");
        assert_eq!((found.degrees, found.blocks, found.block_m, found.within), (2, 3, 10.0, None));
        assert_eq!((spread(&[vec![1.0; LEAST_M - 1]]), spread(&[]), spread(&[Vec::new()])), (None, None, None));
    }
}
