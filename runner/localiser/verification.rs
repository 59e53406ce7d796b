//! How many inliers make a localisation good (thesis, figure 3.5). Counting them belongs to the pair estimator.

/// The lowest threshold: unrelated pairs reach up to 12 inliers by chance.
pub const LEAST_INLIERS: u32 = 12;

/// Share of wrong pairs, in thousandths, that have at most the threshold's inliers.
const PERMILLE: u64 = 999;

/// Why no threshold can be calibrated or scaled.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ThresholdError {
    /// No wrong pair was counted.
    #[error(
        "calibrating the inlier threshold: no wrong pairs came; give a vocabulary traversal with frames more than 10 m apart, \
         or use the uncalibrated threshold"
    )]
    NoPairs,
    /// A factor that scales nothing sensible.
    #[error("scaling the inlier threshold by {0}: expected a positive number such as 0.75 or 1.5")]
    BadFactor(f64),
}

/// The inliers that make a localisation good, with the counts it was calibrated from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Threshold {
    /// Least inliers of a good localisation.
    pub inliers: u32,
    /// `histogram[n]` = number of wrong pairs with n inliers; empty where uncalibrated.
    pub histogram: Vec<u32>,
}

impl Threshold {
    /// max(12, 99.9th percentile) of the inlier counts of pairs that are known to show different places. The percentile
    /// is the smallest count that at least 99.9 % of the pairs do not exceed; with fewer than 1000 pairs that is their
    /// largest count. Error: [`ThresholdError::NoPairs`].
    pub fn calibrate(wrong_pair_inliers: &[u32]) -> Result<Self, ThresholdError> {
        let largest = *wrong_pair_inliers.iter().max().ok_or(ThresholdError::NoPairs)?;
        let mut histogram = vec![0_u32; largest as usize + 1];
        wrong_pair_inliers.iter().for_each(|&inliers| histogram[inliers as usize] += 1);
        let enough = (wrong_pair_inliers.len() as u64 * PERMILLE).div_ceil(1000);
        let mut pairs = 0;
        let reaches = |count: &u32| {
            pairs += u64::from(*count);
            pairs >= enough
        };
        let percentile = histogram.iter().position(reaches).map_or(largest, |inliers| inliers as u32);
        Ok(Self { inliers: percentile.max(LEAST_INLIERS), histogram })
    }

    /// The lowest threshold, where no wrong pairs are at hand.
    pub fn uncalibrated() -> Self {
        Self { inliers: LEAST_INLIERS, histogram: Vec::new() }
    }

    /// The wrong pairs behind the calibration. Below 1000 the percentile rests on a single pair.
    pub fn wrong_pairs(&self) -> u64 {
        self.histogram.iter().map(|&pairs| u64::from(pairs)).sum()
    }

    /// The same calibration with the threshold times `factor`, rounded up, at least 1: to report how results move.
    /// Error: [`ThresholdError::BadFactor`].
    pub fn scaled(&self, factor: f64) -> Result<Self, ThresholdError> {
        if !(factor > 0.0 && factor.is_finite()) {
            return Err(ThresholdError::BadFactor(factor));
        }
        let inliers = (f64::from(self.inliers) * factor).ceil().max(1.0) as u32;
        Ok(Self { inliers, histogram: self.histogram.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_threshold_is_the_least_that_holds_999_permille(counts in proptest::collection::vec(0u32..60, 1..3000)) {
            let threshold = Threshold::calibrate(&counts).unwrap();
            let holds = |limit: u32| counts.iter().filter(|&&count| count <= limit).count() * 1000 >= counts.len() * 999;
            let least = (0..60).find(|&limit| holds(limit)).unwrap();
            prop_assert_eq!(threshold.inliers, least.max(12));
            prop_assert_eq!(threshold.wrong_pairs(), counts.len() as u64);
        }
    }

    #[test]
    fn a_threshold_scales_upward_to_whole_inliers() {
        let threshold = Threshold::uncalibrated();
        assert_eq!([0.75, 1.0, 1.5].map(|factor| threshold.scaled(factor).map(|t| t.inliers)), [Ok(9), Ok(12), Ok(18)]);
    }

    #[test]
    fn nothing_to_calibrate_from_is_an_error() {
        assert_eq!(Threshold::calibrate(&[]), Err(ThresholdError::NoPairs));
        assert!(Threshold::uncalibrated().scaled(f64::NAN).is_err());
    }
}
