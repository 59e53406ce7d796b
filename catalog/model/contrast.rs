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
    /// Its 95 % paired moving-block bootstrap interval: the same blocks are drawn for both.
    pub interval: [f64; 2],
    /// What that says.
    pub verdict: Verdict,
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
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Verdict::Better => "better",
            Verdict::Worse => "worse",
            Verdict::NotSeparable => "not separable",
        })
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
}
