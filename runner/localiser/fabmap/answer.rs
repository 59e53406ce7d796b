//! What a query is answered.

use super::word_model::Observation;
use crate::ranking::best_first;

/// Where the query was most likely taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Best {
    /// At the place of this number.
    Place(usize),
    /// Somewhere that is not in the map.
    NewPlace,
}

/// The answer to a query, and the memory for the next one.
#[derive(Debug, Clone, Default)]
pub struct Answer {
    /// Natural log-likelihood of the query at each place. Complete sums over all words, so comparable between queries
    /// of one codebook.
    pub log_likelihoods: Vec<f64>,
    /// Natural log-likelihood of the query at a new place.
    pub new_place_log_likelihood: f64,
    /// Posterior of each place; with the new place's they sum to 1.
    pub posteriors: Vec<f64>,
    /// Posterior of the new place.
    pub new_place_posterior: f64,
    pub(super) observation: Observation,
    pub(super) sample_log_likelihoods: Vec<f64>,
}

impl Answer {
    /// The most likely place, ties to the lowest number; the new place where it is at least as likely.
    pub fn best(&self) -> Best {
        let mut best = (self.new_place_log_likelihood, Best::NewPlace);
        for (place, &log_likelihood) in self.log_likelihoods.iter().enumerate() {
            if log_likelihood > best.0 {
                best = (log_likelihood, Best::Place(place));
            }
        }
        best.1
    }

    /// The `count` most likely places (fewer where the map is smaller), most likely first, ties to the lowest number.
    /// The new place is not among them.
    pub fn ranked(&self, count: usize) -> Vec<usize> {
        best_first(&self.log_likelihoods, count).into_iter().map(|ranked| ranked.place).collect()
    }

    /// [`Self::best`] by posterior: the same without a motion model, and what [`super::Track`] makes of it with one.
    pub fn most_probable(&self) -> Best {
        let place =
            self.probable(1).first().copied().filter(|place| self.posteriors[*place] > self.new_place_posterior);
        place.map_or(Best::NewPlace, Best::Place)
    }

    /// [`Self::ranked`] by posterior.
    pub fn probable(&self, count: usize) -> Vec<usize> {
        best_first(&self.posteriors, count).into_iter().map(|ranked| ranked.place).collect()
    }

    /// Posteriors with equal priors, smoothed: `smoothing * softmax + (1 - smoothing) / n`, n counting the new place.
    pub(super) fn fill_posteriors(&mut self, smoothing: f64) {
        let highest = self.log_likelihoods.iter().copied().fold(self.new_place_log_likelihood, f64::max);
        self.posteriors.clear();
        self.posteriors.extend(self.log_likelihoods.iter().map(|log_likelihood| exp_below(log_likelihood - highest)));
        self.new_place_posterior = exp_below(self.new_place_log_likelihood - highest);
        self.smooth(smoothing);
    }

    /// Posteriors with a prior for each place and the new one, smoothed alike. Where the prior rules out everything
    /// that is likely at all (a smoothing of 1 and a robot that was carried away), it counts for nothing.
    pub(super) fn fill_posteriors_behind(&mut self, places: &[f64], new_place: f64, smoothing: f64) {
        let weights = self.log_likelihoods.iter().zip(places).map(|(likelihood, &prior)| likelihood + libm::log(prior));
        let new_place = self.new_place_log_likelihood + libm::log(new_place);
        self.posteriors.clear();
        self.posteriors.extend(weights);
        let highest = self.posteriors.iter().copied().fold(new_place, f64::max);
        if highest == f64::NEG_INFINITY {
            return self.fill_posteriors(smoothing);
        }
        self.posteriors.iter_mut().for_each(|posterior| *posterior = exp_below(*posterior - highest));
        self.new_place_posterior = exp_below(new_place - highest);
        self.smooth(smoothing);
    }

    /// Makes the posteriors sum to 1, with the share `1 - smoothing` spread evenly.
    fn smooth(&mut self, smoothing: f64) {
        let total = self.posteriors.iter().sum::<f64>() + self.new_place_posterior;
        let floor = (1.0 - smoothing) / (self.posteriors.len() + 1) as f64;
        self.posteriors.iter_mut().for_each(|posterior| *posterior = smoothing * *posterior / total + floor);
        self.new_place_posterior = smoothing * self.new_place_posterior / total + floor;
    }
}

/// ln of the mean of exp over `values`, without overflow.
pub(super) fn log_mean_exp(values: &[f64]) -> f64 {
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let sum: f64 = values.iter().map(|value| exp_below(value - highest)).sum();
    highest + libm::log(sum / values.len() as f64)
}

/// exp of a number that is not positive; exactly 0 where it cannot change a sum that holds a 1.
fn exp_below(exponent: f64) -> f64 {
    if exponent < -745.0 { 0.0 } else { libm::exp(exponent) }
}
