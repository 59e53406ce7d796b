//! Which experiences are asked, and what it takes to believe them.

use serde::{Deserialize, Serialize};
use std::fmt;

/// How a collective answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Policy {
    /// Every experience is asked; most inliers win (thesis chapter 6).
    #[default]
    All,
    /// So many are asked: those of the time of day nearest to the live traversal's.
    Slot(u32),
    /// So many are asked for each frame: those whose recogniser finds its best place most likely.
    Similar(u32),
    /// Every experience is asked; a localisation counts where at least so many found one (Churchill and Newman 2013).
    Agree(u32),
    /// Every experience is asked, and of their answers only right ones count, by ground truth: what no policy can
    /// surpass.
    Oracle,
}

/// An experience before it is asked about a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Offer {
    /// Minutes between its time of day and the live traversal's, around the clock.
    pub apart_min: u16,
    /// Log-likelihood of its best place; none where it says new place.
    pub log_likelihood: Option<f64>,
}

impl Policy {
    /// Which of the experiences verify their candidates for a frame. Ties go to the earlier.
    pub fn asks(self, offers: &[Offer]) -> Vec<bool> {
        let mut order: Vec<usize> = (0..offers.len()).collect();
        let asked = match self {
            Policy::All | Policy::Agree(_) | Policy::Oracle => return vec![true; offers.len()],
            Policy::Slot(count) => {
                order.sort_by_key(|i| offers[*i].apart_min);
                count
            }
            Policy::Similar(count) => {
                let likely = |i: usize| offers[i].log_likelihood.unwrap_or(f64::NEG_INFINITY);
                order.sort_by(|a, b| likely(*b).total_cmp(&likely(*a)));
                count
            }
        };
        let mut asks = vec![false; offers.len()];
        order.into_iter().take(asked as usize).for_each(|i| asks[i] = true);
        asks
    }

    /// How many experiences must localise before the hub believes the best of them.
    pub fn needed(self) -> u32 {
        if let Policy::Agree(count) = self { count } else { 1 }
    }

    /// How many experiences it speaks of, where it does.
    pub fn count(self) -> Option<u32> {
        match self {
            Policy::Slot(count) | Policy::Similar(count) | Policy::Agree(count) => Some(count),
            Policy::All | Policy::Oracle => None,
        }
    }
}

impl fmt::Display for Policy {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Policy::All => f.write_str("all"),
            Policy::Slot(count) => write!(f, "slot {count}"),
            Policy::Similar(count) => write!(f, "similar {count}"),
            Policy::Agree(count) => write!(f, "agree {count}"),
            Policy::Oracle => f.write_str("oracle"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_in_time_or_in_likelihood_are_asked() {
        let offer = |apart_min, log_likelihood| Offer { apart_min, log_likelihood };
        let offers = [offer(120, Some(-9.0)), offer(0, None), offer(120, Some(-2.0)), offer(240, Some(-5.0))];
        assert_eq!(Policy::Slot(2).asks(&offers), [true, true, false, false]);
        assert_eq!(Policy::Similar(2).asks(&offers), [false, false, true, true]);
        assert_eq!(Policy::Similar(9).asks(&offers), [true; 4]);
        assert_eq!(Policy::Agree(3).asks(&offers), [true; 4]);
        assert_eq!([Policy::Agree(3).needed(), Policy::Oracle.needed()], [3, 1]);
    }
}
