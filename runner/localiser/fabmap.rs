//! FAB-MAP 2.0: how likely is each mapped place, and is this a new one? (Cummins and Newman 2008 and 2011, as openFABMAP computes
//! them.)
//!
//! Notation: q a word, p its parent in the tree; z whether a word is seen now; L whether a place's image showed it; e whether the
//! thing behind the word exists there.

mod answer;
mod index;
mod motion;
mod word_model;

use crate::chow_liu::ChowLiuTree;
use crate::presence::Presence;
use index::InvertedIndex;
use serde::{Deserialize, Serialize};
use word_model::WordModel;

pub use answer::{Answer, Best};
pub use motion::{BadMotion, MotionModel, Track};

/// How a new place's likelihood is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum NewPlace {
    /// The average place, where P(e) is the word's frequency.
    MeanField,
    /// The mean likelihood over the sample images.
    Samples,
}

/// How the words of one image hang together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum WordDependence {
    /// Each on its parent in the Chow-Liu tree.
    ChowLiu,
    /// Not at all; for comparison.
    NaiveBayes,
}

/// The observation model.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FabMapParams {
    /// P(z = 1 | e = 1): a thing that is there is seen.
    pub p_detect_present: f64,
    /// P(z = 1 | e = 0): a thing is seen that is not there.
    pub p_detect_absent: f64,
    /// The share of the posterior that is believed; the rest is spread evenly over all places and the new one.
    pub smoothing: f64,
    /// The new place's model.
    pub new_place: NewPlace,
    /// The words' model.
    pub words: WordDependence,
}

impl FabMapParams {
    /// openFABMAP's settings for FAB-MAP 2.0: 0.39, 0, 0.99, samples, Chow-Liu.
    pub const OPENFABMAP: Self = Self {
        p_detect_present: 0.39,
        p_detect_absent: 0.0,
        smoothing: 0.99,
        new_place: NewPlace::Samples,
        words: WordDependence::ChowLiu,
    };
}

/// What can be wrong with a localiser's parameters, samples, places and queries.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum FabMapError {
    /// Parameters outside their ranges.
    #[error(
        "making a FAB-MAP localiser: {0:?}; expected 0 <= p_detect_absent < p_detect_present < 1 and 0 <= smoothing <= 1 \
         (openFABMAP: 0, 0.39, 0.99)"
    )]
    BadParams(FabMapParams),
    /// The new place is to be sampled, but there are no samples.
    #[error("making a FAB-MAP localiser: no sample images came; give the codebook's, or use the mean-field new place")]
    NoSamples,
    /// A presence of another vocabulary.
    #[error(
        "{what} shows word {word} of a codebook of {words} words; compute its words with this codebook's vocabulary"
    )]
    WordOutOfRange {
        /// `sample`, `place` or `query`.
        what: &'static str,
        /// The word.
        word: u32,
        /// Words in the codebook.
        words: usize,
    },
}

/// A sample image that looks like a mapped place. See [`FabMap::samples_like_places`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleOverlap {
    /// Index of the sample.
    pub sample: usize,
    /// Index of the place that it resembles most.
    pub place: usize,
    /// Words in both images over words in either, 0 to 1.
    pub similarity: f64,
}

/// A map of places that answers queries. Places are numbered in the order they are added.
///
/// **The samples must come from other ground than the map.** A sample image of a mapped place explains a revisit as well as the place
/// itself does, so the revisit is called new (PEERS.md: 21 of 50). The caller knows where images come from and must refuse such
/// samples; [`FabMap::samples_like_places`] is the check by content that remains.
#[derive(Debug, Clone)]
pub struct FabMap {
    params: FabMapParams,
    model: WordModel,
    places: InvertedIndex,
    samples: InvertedIndex,
}

impl FabMap {
    /// An empty map. `samples` are the presences of the codebook's sample images; they are not used by the mean-field new place.
    /// Errors: [`FabMapError::BadParams`], [`FabMapError::NoSamples`], [`FabMapError::WordOutOfRange`].
    pub fn new(tree: &ChowLiuTree, params: FabMapParams, samples: &[Presence]) -> Result<Self, FabMapError> {
        let FabMapParams { p_detect_present: present, p_detect_absent: absent, smoothing, new_place, .. } = params;
        if !(0.0 <= absent && absent < present && present < 1.0 && (0.0..=1.0).contains(&smoothing)) {
            return Err(FabMapError::BadParams(params));
        }
        if new_place == NewPlace::Samples && samples.is_empty() {
            return Err(FabMapError::NoSamples);
        }
        let model = WordModel::new(tree, &params);
        let empty = InvertedIndex::new(tree.words());
        let mut map = Self { params, model, places: empty.clone(), samples: empty };
        for sample in samples {
            map.check("a sample image", sample)?;
            map.samples.add(sample, &map.model);
        }
        Ok(map)
    }

    /// Adds a place and returns its number. Error: [`FabMapError::WordOutOfRange`].
    pub fn add_place(&mut self, place: &Presence) -> Result<usize, FabMapError> {
        self.check("a place", place)?;
        Ok(self.places.add(place, &self.model))
    }

    /// Number of places.
    pub fn places(&self) -> usize {
        self.places.len()
    }

    /// Number of words that presences may hold.
    pub fn words(&self) -> usize {
        self.model.words()
    }

    /// Where is `query`? Error: [`FabMapError::WordOutOfRange`].
    pub fn query(&self, query: &Presence) -> Result<Answer, FabMapError> {
        let mut answer = Answer::default();
        self.query_into(query, &mut answer)?;
        Ok(answer)
    }

    /// [`FabMap::query`] into an answer whose memory is used again. Every query stands alone, all places and the new one equally
    /// likely before it; [`Track`] adds a motion model. Error: [`FabMapError::WordOutOfRange`]; `answer` is then unchanged.
    pub fn query_into(&self, query: &Presence, answer: &mut Answer) -> Result<(), FabMapError> {
        self.check("a query", query)?;
        let everywhere = self.model.observe(query, &mut answer.observation);
        self.places.log_likelihoods(everywhere.unseen, &answer.observation, &mut answer.log_likelihoods);
        answer.new_place_log_likelihood = match self.params.new_place {
            NewPlace::MeanField => everywhere.mean_field,
            NewPlace::Samples => {
                self.samples.log_likelihoods(
                    everywhere.unseen,
                    &answer.observation,
                    &mut answer.sample_log_likelihoods,
                );
                answer::log_mean_exp(&answer.sample_log_likelihoods)
            }
        };
        answer.fill_posteriors(self.params.smoothing);
        Ok(())
    }

    /// The samples that share at least `similarity` of their words (Jaccard index, 0 to 1) with some place: they suppress revisits of
    /// it and should be dropped. Images of different places stay far below 0.5.
    pub fn samples_like_places(&self, similarity: f64) -> Vec<SampleOverlap> {
        let best = self.samples.most_similar(&self.places);
        best.into_iter().filter(|overlap| overlap.similarity >= similarity).collect()
    }

    fn check(&self, what: &'static str, presence: &Presence) -> Result<(), FabMapError> {
        let words = self.model.words();
        match presence.beyond(words) {
            Some(word) => Err(FabMapError::WordOutOfRange { what, word, words }),
            None => Ok(()),
        }
    }
}
