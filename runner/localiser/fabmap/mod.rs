//! FAB-MAP 2.0: how likely is each mapped place, and is this a new one? (Cummins and Newman 2008 and 2011, as
//! openFABMAP computes them.)
//!
//! Notation: q a word, p its parent in the tree; z whether a word is seen now; L whether a place's image showed it; e
//! whether the thing behind the word exists there.

mod answer;
mod error;
mod index;
mod motion;
mod params;
mod word_model;

use crate::chow_liu::ChowLiuTree;
use crate::presence::Presence;
use index::InvertedIndex;
use word_model::WordModel;

pub use answer::{Answer, Best};
pub use error::FabMapError;
pub use index::SampleOverlap;
pub use motion::{BadMotion, MotionModel, Track};
pub use params::{FabMapParams, NewPlace, WordDependence};

/// A map of places that answers queries. Places are numbered in the order they are added.
///
/// **The samples must come from other ground than the map.** A sample image of a mapped place explains a revisit as
/// well as the place itself does, so the revisit is called new (21 of 50 in a comparison with openFABMAP). The caller
/// knows where images come from and must refuse such samples; [`FabMap::samples_like_places`] is the check by content
/// that remains.
#[derive(Debug, Clone)]
pub struct FabMap {
    params: FabMapParams,
    model: WordModel,
    places: InvertedIndex,
    samples: InvertedIndex,
}

impl FabMap {
    /// An empty map. `samples` are the presences of the codebook's sample images; they are not used by the mean-field
    /// new place. Errors: [`FabMapError::BadParams`], [`FabMapError::NoSamples`], [`FabMapError::WordOutOfRange`].
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

    /// [`FabMap::query`] into an answer whose memory is used again. Every query stands alone, all places and the new
    /// one equally likely before it; [`Track`] adds a motion model. Error: [`FabMapError::WordOutOfRange`]; `answer` is
    /// then unchanged.
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

    /// The samples that share at least `similarity` of their words (Jaccard index, 0 to 1) with some place: they
    /// suppress revisits of it and should be dropped. Images of different places stay far below 0.5.
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
