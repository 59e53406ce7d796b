//! An optional motion model: places are numbered along a route, and a robot that was at one is soon near it.

use super::answer::Answer;
use serde::{Deserialize, Serialize};

/// Chances from one query to the next. openFABMAP's model favours the way back where it is asked to favour the way
/// forward, and its rows do not sum to 1; this one is a Markov chain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MotionModel {
    /// Of a robot that changes its place, P(to the next place), against the one before; 0.5 prefers neither.
    pub forward: f64,
    /// P(staying at the place).
    pub stay: f64,
    /// P(to a new place), from any place.
    pub leave: f64,
    /// P(to a mapped place), from a new one; any of them.
    pub come_back: f64,
}

impl MotionModel {
    /// openFABMAP's numbers put right: a third stays, no preferred way, a tenth leaves and comes back.
    pub const DEFAULT: Self = Self { forward: 0.5, stay: 0.3, leave: 0.1, come_back: 0.1 };

    /// Whether all are chances, and staying and leaving exclude each other.
    pub fn is_valid(&self) -> bool {
        let is_chance = |p: f64| (0.0..=1.0).contains(&p);
        [self.forward, self.stay, self.leave, self.come_back].into_iter().all(is_chance)
            && self.stay + self.leave <= 1.0
    }

    /// The chances before a query of `places` places and of a new one, from the posteriors after the one before it.
    /// Places that were added since had no chance then. What would move over an end of the route stays at that end.
    fn predict(&self, before: &Belief, places: usize) -> Belief {
        let Self { forward, stay, leave, come_back } = *self;
        let moved = 1.0 - stay - leave;
        if places == 0 {
            return Belief { places: Vec::new(), new_place: 1.0 };
        }
        let mut after = vec![before.new_place * come_back / places as f64; places];
        for (place, &chance) in before.places.iter().enumerate() {
            after[place] += chance * stay;
            after[(place + 1).min(places - 1)] += chance * moved * forward;
            after[place.saturating_sub(1)] += chance * moved * (1.0 - forward);
        }
        let left: f64 = before.places.iter().sum::<f64>() * leave;
        Belief { places: after, new_place: left + before.new_place * (1.0 - come_back) }
    }
}

impl Default for MotionModel {
    fn default() -> Self {
        Self::DEFAULT
    }
}

/// A motion model outside its range.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[error("{0:?}: expected chances from 0 to 1, and stay + leave at most 1")]
pub struct BadMotion(MotionModel);

/// Chances of all places and of the new one; they sum to 1.
#[derive(Debug, Clone, PartialEq)]
struct Belief {
    places: Vec<f64>,
    new_place: f64,
}

/// Where the robot may be, from query to query.
#[derive(Debug, Clone)]
pub struct Track {
    motion: MotionModel,
    last: Option<Belief>,
}

impl Track {
    /// Before the first query, when all places and the new one are equally likely. Error: [`BadMotion`].
    pub fn new(motion: MotionModel) -> Result<Self, BadMotion> {
        if motion.is_valid() { Ok(Self { motion, last: None }) } else { Err(BadMotion(motion)) }
    }

    /// Says how far the robot has driven since the last answer, in places of the map: it stays at its place where it
    /// has not moved, and is at another after a whole one. `stay` of the motion model is for those who do not know.
    pub fn drive(&mut self, places: f64) {
        let moved = if places.is_finite() { places.clamp(0.0, 1.0) } else { 1.0 };
        self.motion.stay = (1.0 - self.motion.leave) * (1.0 - moved);
    }

    /// Gives an answer the posteriors it has behind all answers before it; `smoothing` as in [`super::FabMapParams`].
    /// Its likelihoods stay as they are. Places may have been added since the last answer, none removed.
    pub fn follow(&mut self, answer: &mut Answer, smoothing: f64) {
        let places = answer.log_likelihoods.len();
        let equal = 1.0 / (places + 1) as f64;
        let prior = match &self.last {
            Some(last) => self.motion.predict(last, places),
            None => Belief { places: vec![equal; places], new_place: equal },
        };
        answer.fill_posteriors_behind(&prior.places, prior.new_place, smoothing);
        self.last = Some(Belief { places: answer.posteriors.clone(), new_place: answer.new_place_posterior });
    }
}
