//! What a place recogniser is: which nodes of an experience each frame of a live traversal may show. Each implements
//! [`Recogniser`] in a file of its own in `stages/matching`, and has a line in the registry there.

use crate::RunError;
use crate::inputs::answers::Matches;
use crate::inputs::contender::Contender;
use crate::inputs::traversals::LiveTraversal;
use crate::inputs::words::{ReadyCodebook, WordTables, Words};
use crate::matrix::{Matrix, Method};
use crate::progress::Progress;
use furrow_catalog::{CatalogError, Objects};
use furrow_localiser::Presence;
use furrow_model::ObjectId;
use serde_json::Value;
use std::sync::Arc;

/// A place recogniser of the registry.
pub(crate) struct RecogniserEntry {
    /// Its name and keys in a matrix file.
    pub method: Method,
    /// Makes it ready as a checked matrix of one setting asks for it.
    pub open: fn(&Matrix) -> Result<Arc<dyn Recogniser>, RunError>,
}

/// A place recogniser as one matrix asks for it.
pub(crate) trait Recogniser: Send + Sync {
    /// All that determines its answers beside images, words and the number of candidates: part of the key of every
    /// cell.
    fn cell_key_part(&self) -> Value;

    /// Whether it needs a codebook and the words of images.
    fn needs_codebook(&self) -> bool {
        false
    }

    /// What is missing to answer this live traversal from these contenders, and what to do.
    fn missing(&self, _live: &LiveTraversal, _contenders: &[&Contender]) -> Option<String> {
        None
    }

    /// The key of its answers, if they are made of words alone.
    fn answers_key(&self, _live: &LiveTraversal, _words: &WordTables) -> Result<Option<ObjectId>, CatalogError> {
        Ok(None)
    }

    /// Itself as it answers frame by frame.
    ///
    /// # Errors
    /// Why it cannot.
    fn frame_by_frame(&self) -> Result<&dyn FrameByFrame, &'static str> {
        Err("live localisation needs a method that answers frame by frame: this one needs the whole traversal at once")
    }

    /// Sees a live traversal, once for all that are to answer it.
    fn look_at<'a>(&'a self, context: &'a dyn Context, live: &'a LiveTraversal) -> Result<Answering<'a>, RunError>;
}

/// Finds or computes what a contender answers the live traversal that was looked at.
pub(crate) type Answering<'a> = Box<dyn Fn(&Contender) -> Result<Matches, RunError> + 'a>;

/// What a recogniser may ask for.
pub(crate) trait Context {
    fn objects(&self) -> &Objects;
    fn progress(&self) -> Progress<'_>;
    /// The codebook of those that need one.
    fn codebook(&self) -> Result<&ReadyCodebook, RunError>;
    /// Finds or computes the words of a live traversal's frames.
    fn live_words(&self, live: &LiveTraversal) -> Result<Words, RunError>;
    /// Finds or computes the words of a contender's nodes.
    fn contender_words(&self, contender: &Contender) -> Result<Words, RunError>;
}

/// A recogniser by words that answers each frame by itself.
pub(crate) trait FrameByFrame {
    /// The index of an experience's places.
    fn index(&self, map: &Words, codebook: &ReadyCodebook) -> Result<Box<dyn PlaceIndex>, RunError>;
}

/// The places of an experience, to be asked about single frames.
pub(crate) trait PlaceIndex: Send + Sync {
    /// The most likely nodes with their log likelihoods, best first; none where the frame shows a new place.
    fn rank(&self, seen: &Presence, candidates: usize) -> Result<Vec<(usize, f64)>, RunError>;
}
