//! The control hub: many localisers, one answer (thesis, chapter 6). It has no clock: moments come in as the live
//! frame's stamp and the distance travelled, so that a recorded traversal gives the same decisions every time.

mod decision;
mod policy;

use std::collections::BTreeMap;

pub use decision::{Decision, Localisation, Reason};
pub use policy::{Offer, Policy};

/// A pair of an experience and the localiser that searches it, numbered by the caller.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct PairId(pub u32);

/// A pair's membership from one registration to its removal. Results of an earlier membership are discarded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Membership {
    /// The pair.
    pub pair: PairId,
    epoch: u64,
}

/// Where the live traversal was when a frame was taken, or when a decision is asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    /// The live frame's header stamp.
    pub stamp_ns: i64,
    /// Distance travelled by the live traversal so far, by odometry.
    pub travelled_m: f64,
}

/// A place that a pair proposed, after verification.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Candidate {
    /// The stamp of the experience's node.
    pub node_stamp_ns: i64,
    /// Its log-likelihood.
    pub log_likelihood: f64,
    /// The inliers of its verification.
    pub inliers: u32,
}

/// What a pair answered a live frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PairAnswer {
    /// A place with enough inliers.
    Accepted(Candidate),
    /// A place with too few.
    Rejected(Candidate),
    /// No place of the experience.
    NewPlace,
}

impl PairAnswer {
    /// What a pair answers whose best verified place is `best`, where a localisation needs `threshold` inliers.
    pub fn of(best: Option<Candidate>, threshold: u32) -> Self {
        match best {
            None => Self::NewPlace,
            Some(best) if best.inliers >= threshold => Self::Accepted(best),
            Some(best) => Self::Rejected(best),
        }
    }
}

/// How old a result may be to count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Freshness {
    /// Largest time since the result's live frame.
    pub max_age_ns: i64,
    /// Largest distance travelled since then.
    pub max_distance_m: f64,
}

impl Freshness {
    /// 1.0 s and 1.0 m, both included.
    pub const DEFAULT: Self = Self { max_age_ns: 1_000_000_000, max_distance_m: 1.0 };

    /// Whether a result of moment `then` still counts at `now`. A result from a later moment does not.
    fn holds(&self, then: Moment, now: Moment) -> bool {
        let (age_ns, distance_m) = (now.stamp_ns.saturating_sub(then.stamp_ns), now.travelled_m - then.travelled_m);
        (0..=self.max_age_ns).contains(&age_ns) && (0.0..=self.max_distance_m).contains(&distance_m)
    }
}

/// What the hub did with a reported result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Receipt {
    /// It is the pair's latest now.
    Kept,
    /// The pair has been removed since, or registered anew.
    Departed,
    /// The pair has answered a later frame already.
    Late,
}

/// A registered pair and its latest result.
#[derive(Debug, Clone)]
struct Member {
    epoch: u64,
    latest: Option<(Moment, PairAnswer)>,
}

/// The hub's state: the registered pairs and the latest result of each.
#[derive(Debug, Clone)]
pub struct Hub {
    freshness: Freshness,
    needed: u32,
    next_epoch: u64,
    members: BTreeMap<PairId, Member>,
}

impl Hub {
    /// A hub without pairs.
    pub fn new(freshness: Freshness) -> Self {
        Self { freshness, needed: 1, next_epoch: 0, members: BTreeMap::new() }
    }

    /// A localisation counts only where at least `count` pairs have a fresh one.
    pub fn needing(self, count: u32) -> Self {
        Self { needed: count, ..self }
    }

    /// Adds a pair. A pair that is registered already begins anew, without its results.
    pub fn register(&mut self, pair: PairId) -> Membership {
        let epoch = self.next_epoch;
        self.next_epoch += 1;
        self.members.insert(pair, Member { epoch, latest: None });
        Membership { pair, epoch }
    }

    /// Removes a pair and its result at once; false where that membership had ended already.
    pub fn deregister(&mut self, membership: Membership) -> bool {
        let current = self.members.get(&membership.pair).is_some_and(|member| member.epoch == membership.epoch);
        current && self.members.remove(&membership.pair).is_some()
    }

    /// The registered pairs, by rising id.
    pub fn pairs(&self) -> impl Iterator<Item = PairId> {
        self.members.keys().copied()
    }

    /// Takes a pair's answer to the live frame of moment `live`. It replaces the pair's earlier one, also where it is
    /// worse or no match, or one old high count would win for ever.
    pub fn report(&mut self, membership: Membership, live: Moment, answer: PairAnswer) -> Receipt {
        let Some(member) = self.members.get_mut(&membership.pair).filter(|member| member.epoch == membership.epoch)
        else {
            return Receipt::Departed;
        };
        if member.latest.is_some_and(|(latest, _)| latest.stamp_ns > live.stamp_ns) {
            return Receipt::Late;
        }
        member.latest = Some((live, answer));
        Receipt::Kept
    }

    /// Decides at moment `now`: the fresh accepted result with most inliers wins (ties: log-likelihood, newer live
    /// frame, lower id), where there are enough of them.
    pub fn decide(&self, now: Moment) -> Decision {
        let latest = self.members.iter().map(|(&pair, member)| (pair, member.latest));
        decision::decide(latest, self.freshness, self.needed, now)
    }

    /// Lockstep: every pair's answer to one live frame, reported in turn, then the decision at that frame.
    pub fn step(&mut self, live: Moment, answers: &[(Membership, PairAnswer)]) -> Decision {
        for &(membership, answer) in answers {
            self.report(membership, live, answer);
        }
        self.decide(live)
    }
}
