//! The likelihood of one word's state, and of a whole observation at a place that showed no word.

use super::params::{FabMapParams, WordDependence};
use crate::chow_liu::ChowLiuTree;
use crate::presence::Presence;

/// ln P(z | z_p) at some kind of place: `[z][z_p]`, index 1 for present.
type LogTable = [[f64; 2]; 2];

/// One word's log-likelihoods.
#[derive(Debug, Clone)]
struct Word {
    parent: u32,
    /// At a place whose image did not show the word.
    unseen: LogTable,
    /// How much larger where it did: r(z, z_p) of openFABMAP.
    gain: LogTable,
    /// At the average place.
    mean_field: LogTable,
}

/// All words' log-likelihoods.
#[derive(Debug, Clone)]
pub(super) struct WordModel {
    words: Vec<Word>,
    /// Each word's children in the tree.
    children: Vec<Vec<u32>>,
    /// The observation of no word at all.
    nothing_seen: Everywhere,
}

/// Log-likelihoods of an observation that do not depend on the map.
#[derive(Debug, Clone, Copy)]
pub(super) struct Everywhere {
    /// At a place whose image showed no word.
    pub(super) unseen: f64,
    /// At the average place.
    pub(super) mean_field: f64,
}

/// What an observation changes at the places that hold a word, against the observation of nothing.
#[derive(Debug, Clone, Default)]
pub(super) struct Observation {
    pub(super) changes: Vec<(u32, f64)>,
    seen: Vec<bool>,
}

impl WordModel {
    pub(super) fn new(tree: &ChowLiuTree, params: &FabMapParams) -> Self {
        let words: Vec<Word> = (0..tree.words()).map(|word| Word::new(tree, word, params)).collect();
        let mut children = vec![Vec::new(); words.len()];
        let mut nothing_seen = Everywhere { unseen: 0.0, mean_field: 0.0 };
        for (index, word) in (0..).zip(&words) {
            if word.parent != index {
                children[word.parent as usize].push(index);
            }
            nothing_seen.unseen += word.unseen[0][0];
            nothing_seen.mean_field += word.mean_field[0][0];
        }
        Self { words, children, nothing_seen }
    }

    pub(super) fn words(&self) -> usize {
        self.words.len()
    }

    /// What a place gains by holding `word` when nothing is observed.
    pub(super) fn gain_of_nothing(&self, word: u32) -> f64 {
        self.words[word as usize].gain[0][0]
    }

    /// Works out what `query` changes: only its words and their unseen children differ from the observation of nothing,
    /// so the cost does not grow with the vocabulary.
    pub(super) fn observe(&self, query: &Presence, observation: &mut Observation) -> Everywhere {
        let Observation { changes, seen } = observation;
        changes.clear();
        seen.resize(self.words.len(), false);
        query.words().iter().for_each(|&word| seen[word as usize] = true);
        let mut everywhere = self.nothing_seen;
        let mut change = |index: u32, z: usize, parent_z: usize| {
            let word = &self.words[index as usize];
            everywhere.unseen += word.unseen[z][parent_z] - word.unseen[0][0];
            everywhere.mean_field += word.mean_field[z][parent_z] - word.mean_field[0][0];
            changes.push((index, word.gain[z][parent_z] - word.gain[0][0]));
        };
        for &index in query.words() {
            change(index, 1, usize::from(seen[self.words[index as usize].parent as usize]));
            let unseen_children = self.children[index as usize].iter().filter(|&&child| !seen[child as usize]);
            unseen_children.for_each(|&child| change(child, 0, 1));
        }
        query.words().iter().for_each(|&word| seen[word as usize] = false);
        everywhere
    }
}

impl Word {
    fn new(tree: &ChowLiuTree, word: usize, params: &FabMapParams) -> Self {
        let p_present = tree.p_present()[word];
        let given_parent = [tree.p_present_given_parent_absent()[word], tree.p_present_given_parent_present()[word]];
        let p_z_given_e = [params.p_detect_absent, params.p_detect_present];
        // P(e = 1 | L), Bayes' rule with the detector on L and the word's frequency as prior.
        let p_exists = |seen: bool| {
            let [absent, present] = p_z_given_e.map(|p| if seen { p } else { 1.0 - p });
            present * p_present / (present * p_present + absent * (1.0 - p_present))
        };
        let table = |p_exists: f64| -> LogTable {
            let p = |z: usize, parent_z: usize| {
                let p_z = |e: usize| match params.words {
                    WordDependence::NaiveBayes => state(p_z_given_e[e], z),
                    WordDependence::ChowLiu => {
                        // P(z | e, z_p) = beta / (alpha + beta), Cummins and Newman 2008, eqs 8 to 11.
                        let alpha =
                            state(p_present, z) * state(p_z_given_e[e], 1 - z) * state(given_parent[parent_z], 1 - z);
                        let beta =
                            state(p_present, 1 - z) * state(p_z_given_e[e], z) * state(given_parent[parent_z], z);
                        beta / (alpha + beta)
                    }
                };
                libm::log((1.0 - p_exists) * p_z(0) + p_exists * p_z(1))
            };
            [[p(0, 0), p(0, 1)], [p(1, 0), p(1, 1)]]
        };
        let (unseen, seen) = (table(p_exists(false)), table(p_exists(true)));
        let gain = std::array::from_fn(|z| std::array::from_fn(|parent_z| seen[z][parent_z] - unseen[z][parent_z]));
        Self { parent: tree.parent()[word], unseen, gain, mean_field: table(p_present) }
    }
}

/// The probability of state `z` where that of state 1 is `p`.
fn state(p: f64, z: usize) -> f64 {
    if z == 1 { p } else { 1.0 - p }
}
