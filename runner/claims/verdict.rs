//! What a claim came to.

use furrow_model::{Outcome, Verdict as Contrasted, signed};
use serde::Serialize;
use std::fmt;

/// A claim of the thesis and what the store says.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Claim {
    /// Its short name, such as `C1`.
    pub id: &'static str,
    /// The experiments that it is judged by.
    pub experiments: &'static str,
    /// What the thesis found.
    pub finding: &'static str,
    /// What was found here, in numbers, with intervals.
    pub ours: String,
    /// Whether it holds.
    pub verdict: Verdict,
    /// What the verdict rests on, in words.
    pub why: String,
}

/// Whether a claim holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Verdict {
    /// In every comparison, and none is within its intervals.
    Holds,
    /// Some comparison says otherwise, outside its intervals.
    DoesNotHold,
    /// No comparison says otherwise, but intervals touch.
    NotSeparable,
    /// The experiments were not run, or left nothing to compare.
    NotMeasured,
}

impl fmt::Display for Verdict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Holds => "holds",
            Self::DoesNotHold => "does not hold",
            Self::NotSeparable => "not separable",
            Self::NotMeasured => "not measured",
        })
    }
}

impl From<Contrasted> for Verdict {
    /// A claim that the contender asked about is better.
    fn from(verdict: Contrasted) -> Self {
        match verdict {
            Contrasted::Better => Self::Holds,
            Contrasted::Worse => Self::DoesNotHold,
            Contrasted::NotSeparable | Contrasted::TooLittleRoad => Self::NotSeparable,
        }
    }
}

/// A number with the ends of its interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Measured {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

impl Measured {
    /// Good localisations. A traversal too short for an interval tells nothing of another: from none to all frames.
    pub fn good(outcome: &Outcome) -> Self {
        let evaluation = &outcome.evaluation;
        let [low, high] = evaluation.good_interval.unwrap_or([0, evaluation.frames]).map(f64::from);
        Self { value: f64::from(evaluation.good), low, high }
    }

    /// The mean of several; its interval is that of the ends, which is too wide, never too narrow.
    pub fn mean(all: &[Self]) -> Option<Self> {
        let mean = |of: fn(&Self) -> f64| all.iter().map(of).sum::<f64>() / all.len() as f64;
        (!all.is_empty()).then(|| Self { value: mean(|m| m.value), low: mean(|m| m.low), high: mean(|m| m.high) })
    }

    /// A share with its Wilson interval, as if every one of `of` stood alone.
    pub fn share(count: u32, of: u32) -> Option<Self> {
        const Z: f64 = 1.96;
        if of == 0 {
            return None;
        }
        let (n, p) = (f64::from(of), f64::from(count) / f64::from(of));
        let middle = (p + Z * Z / (2.0 * n)) / (1.0 + Z * Z / n);
        let half = Z / (1.0 + Z * Z / n) * (p * (1.0 - p) / n + Z * Z / (4.0 * n * n)).sqrt();
        Some(Self { value: p, low: (middle - half).max(0.0), high: (middle + half).min(1.0) })
    }

    /// `57 [40, 70]`.
    pub fn in_words(self) -> String {
        format!("{:.0} [{:.0}, {:.0}]", self.value, self.low, self.high)
    }

    /// `+12 [+3, +20]`.
    pub fn signed(self) -> String {
        let [value, low, high] = [self.value, self.low, self.high].map(|value| signed(value, 0));
        format!("{value} [{low}, {high}]")
    }

    /// Whether this is greater than `other`.
    pub fn exceeds(self, other: Self) -> Verdict {
        if self.low > other.high {
            Verdict::Holds
        } else if self.high < other.low {
            Verdict::DoesNotHold
        } else {
            Verdict::NotSeparable
        }
    }
}

/// A claim about all of several comparisons, and why, in words.
pub(super) fn all_of(verdicts: &[Verdict]) -> (Verdict, String) {
    let count = |wanted: Verdict| verdicts.iter().filter(|verdict| **verdict == wanted).count();
    let (holds, not, unsure) = (count(Verdict::Holds), count(Verdict::DoesNotHold), count(Verdict::NotSeparable));
    let verdict = match (holds, not, unsure) {
        (0, 0, 0) => Verdict::NotMeasured,
        (_, 1.., _) => Verdict::DoesNotHold,
        (_, 0, 1..) => Verdict::NotSeparable,
        _ => Verdict::Holds,
    };
    let of = match verdicts.len() {
        1 => "One comparison".to_owned(),
        more => format!("{more} comparisons"),
    };
    let why = format!(
        "{of}: {holds} in favour with intervals apart, {not} against with intervals apart, {unsure} with intervals that touch."
    );
    (verdict, why)
}

impl Claim {
    /// One that nothing was measured for.
    pub(super) fn unmeasured(id: &'static str, experiments: &'static str, finding: &'static str, why: &str) -> Self {
        let ours = "Nothing to compare.".to_owned();
        Self { id, experiments, finding, ours, verdict: Verdict::NotMeasured, why: format!("{why}.") }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_contradiction_breaks_a_claim_and_one_doubt_unsettles_it() {
        use Verdict::{DoesNotHold, Holds, NotMeasured, NotSeparable};
        assert_eq!(all_of(&[]).0, NotMeasured);
        assert_eq!(all_of(&[Holds, Holds]).0, Holds);
        assert_eq!(all_of(&[Holds, NotSeparable]).0, NotSeparable);
        assert_eq!(all_of(&[Holds, NotSeparable, DoesNotHold]).0, DoesNotHold);
    }

    #[test]
    fn wilsons_interval_is_that_of_the_books() {
        // Newcombe (1998), table I: 81 of 263, and 15 of 148.
        for (count, of, low, high) in [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605)] {
            let share = Measured::share(count, of).unwrap();
            assert!((share.low - low).abs() < 1e-4 && (share.high - high).abs() < 1e-4, "{share:?}");
        }
        assert_eq!(Measured::share(0, 0), None);
    }
}
