//! The hub's choice among the latest results.

use super::{Candidate, Freshness, Moment, PairAnswer, PairId};
use std::cmp::Ordering;

/// What the hub says at a moment.
#[derive(Debug, Clone, PartialEq)]
pub struct Decision {
    /// The localisation; `None` is lost.
    pub winner: Option<Localisation>,
    /// What would have won without the winner's pair.
    pub runner_up: Option<Localisation>,
    /// Why each registered pair did or did not decide, by rising pair id.
    pub reasons: Vec<(PairId, Reason)>,
}

/// A localisation on offer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Localisation {
    /// The pair that found it.
    pub pair: PairId,
    /// The place.
    pub candidate: Candidate,
    /// The live frame it belongs to.
    pub live: Moment,
    /// Time from that frame to the decision.
    pub age_ns: i64,
    /// Distance travelled from that frame to the decision.
    pub age_m: f64,
}

/// What became of a pair's latest result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// It is the decision.
    Accepted,
    /// Its candidate had too few inliers.
    Rejected,
    /// It said new place.
    NewPlace,
    /// It was good, but another was better.
    Outvoted,
    /// It was good, but too few others were.
    Alone,
    /// It is too old, by time or by distance, whatever it said.
    Stale,
    /// The pair has not answered yet.
    NoResult,
}

pub(super) fn decide(
    latest: impl Iterator<Item = (PairId, Option<(Moment, PairAnswer)>)>,
    freshness: Freshness,
    needed: u32,
    now: Moment,
) -> Decision {
    let mut offers = Vec::new();
    let mut reasons = Vec::new();
    for (pair, latest) in latest {
        let reason = match latest {
            None => Reason::NoResult,
            Some((live, _)) if !freshness.holds(live, now) => Reason::Stale,
            Some((_, PairAnswer::NewPlace)) => Reason::NewPlace,
            Some((_, PairAnswer::Rejected(_))) => Reason::Rejected,
            Some((live, PairAnswer::Accepted(candidate))) => {
                let (age_ns, age_m) = (now.stamp_ns - live.stamp_ns, now.travelled_m - live.travelled_m);
                offers.push(Localisation { pair, candidate, live, age_ns, age_m });
                Reason::Outvoted
            }
        };
        reasons.push((pair, reason));
    }
    if offers.len() < needed as usize {
        let alone = offers.iter().map(|offer| offer.pair).collect::<Vec<_>>();
        reasons.iter_mut().filter(|(pair, _)| alone.contains(pair)).for_each(|(_, reason)| *reason = Reason::Alone);
        offers.clear();
    }
    offers.sort_by(better_first);
    let mut offers = offers.into_iter();
    let winner = offers.next();
    if let Some(winner) = winner {
        reasons.iter_mut().filter(|(pair, _)| *pair == winner.pair).for_each(|(_, reason)| *reason = Reason::Accepted);
    }
    Decision { winner, runner_up: offers.next(), reasons }
}

/// Most inliers, then likelihood, then the newer live frame, then the lower id.
fn better_first(a: &Localisation, b: &Localisation) -> Ordering {
    (b.candidate.inliers.cmp(&a.candidate.inliers))
        .then_with(|| b.candidate.log_likelihood.total_cmp(&a.candidate.log_likelihood))
        .then_with(|| b.live.stamp_ns.cmp(&a.live.stamp_ns))
        .then_with(|| a.pair.cmp(&b.pair))
}
