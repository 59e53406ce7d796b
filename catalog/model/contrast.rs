//! Whether one contender of a matrix beats another on the same live traversals. The runner computes these numbers;
//! reports only draw them.

use crate::{CellKey, TimeSlot, TraversalId};
use serde::{Deserialize, Serialize};
use std::fmt;

/// One contender against another, on one live traversal or pooled over several.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Contrast {
    /// The contender that is asked about, as its cells are labelled.
    pub of: String,
    /// The contender that it should beat.
    pub over: String,
    /// What tells its setting from the matrix' others; not written where there is one only.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub setting: String,
    /// The live traversals; several where this is the pooled difference.
    pub live: Vec<ContrastTraversal>,
    /// Live frames offered to each of the two.
    pub frames: u32,
    /// Good localisations; more are better.
    pub good: Difference,
    /// Right localisations, accepted and right by ground truth; more are better. `None` without a ground truth of every
    /// traversal.
    pub right: Option<Difference>,
    /// Share of the route travelled lost, 0 to 1; less is better.
    pub lost_fraction: Difference,
    /// Area under the lost-distance curve (survival), metres; less is better.
    pub area_m: Difference,
    /// Where the ground truth comes from.
    pub truth: Option<String>,
}

/// A live traversal that two contenders were both judged on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ContrastTraversal {
    /// Its slot.
    pub slot: TimeSlot,
    /// The traversal.
    pub traversal: TraversalId,
    /// The cells of the two.
    pub cells: [CellKey; 2],
}

/// A number of one contender less that of the other.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Difference {
    /// The number of the contender that is asked about.
    pub of: f64,
    /// The other's.
    pub over: f64,
    /// The first less the second.
    pub difference: f64,
    /// What the interval says, before any correction.
    pub verdict: Verdict,
    /// Its 95 % interval: Student's t along the road of a single traversal, or over several. `None` of too little road.
    pub interval: Option<[f64; 2]>,
    /// The chance of a difference as large between two equal contenders; `None` without an interval.
    pub p: Option<f64>,
    /// The same, corrected for the number of contrasts asked (Holm 1979).
    pub p_holm: Option<f64>,
    /// Stretches of road that count as independent, or traversals where there are several: one more than the degrees of
    /// freedom.
    pub blocks: Option<u32>,
    /// The mean length of these, metres.
    pub block_m: Option<f64>,
    /// The standard error of the difference that follows from the spread within traversals; `None` where one is too
    /// short to tell.
    pub error_within: Option<f64>,
    /// And from the spread between them; `None` of a single one.
    pub error_between: Option<f64>,
}

impl Difference {
    /// Whether the verdict, better or worse, does not outlive the correction for the number of contrasts asked.
    pub fn falls_when_corrected(&self) -> bool {
        matches!(self.verdict, Verdict::Better | Verdict::Worse) && self.p_holm.is_some_and(|p| p > 0.05)
    }
}

/// What a difference and its interval say of the contender that is asked about.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// The whole interval lies on the better side of zero.
    Better,
    /// The whole interval lies on the worse side.
    Worse,
    /// The interval holds zero.
    NotSeparable,
    /// There is no interval: one traversal, and a short one.
    TooLittleRoad,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Better => "better",
            Verdict::Worse => "worse",
            Verdict::NotSeparable => "not separable",
            Verdict::TooLittleRoad => "too little road for an interval",
        })
    }
}

/// A chance as people read it: two decimals, three below 0.1, `< 0.001` below that.
pub fn chance(p: f64) -> String {
    match p {
        p if p < 0.001 => "< 0.001".to_owned(),
        p if p < 0.0995 => format!("{p:.3}"),
        p => format!("{p:.2}"),
    }
}

/// A difference with its sign and `digits` decimals: as many more as it takes that what is not zero does not read as
/// zero, since the verdict depends on which side of it a bound lies.
pub fn signed(value: f64, digits: usize) -> String {
    let text = format!("{value:+.digits$}");
    let hidden = value != 0.0 && text.parse() == Ok(0.0) && digits < 9;
    if hidden { signed(value, digits + 1) } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bound_beside_zero_tells_its_side() {
        assert_eq!([0.4, -0.02, 0.0, 2.5, -17.0].map(|value| signed(value, 0)), ["+0.4", "-0.02", "+0", "+2", "-17"]);
        assert_eq!([0.04, -12.0].map(|value| signed(value, 1)), ["+0.04", "-12.0"]);
        assert_eq!(signed(1e-300, 0), "+0.000000000");
    }

    #[test]
    fn chances_have_the_digits_that_matter() {
        assert_eq!([0.0, 0.0124, 0.0999, 0.5, 1.0].map(chance), ["< 0.001", "0.012", "0.10", "0.50", "1.00"]);
    }
}
