//! What an experience answers a live traversal, whichever place recogniser asks it.

use furrow_model::ObjectId;

/// A node on offer for a live frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Candidate {
    pub node: u32,
    /// Of a recogniser without likelihoods its score; larger is better in any case.
    pub log_likelihood: f64,
    /// None where the recogniser has none.
    pub posterior: Option<f64>,
}

/// What an experience answers one live frame.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FrameMatches {
    pub new_place: bool,
    /// None where the recogniser knows no new place.
    pub new_place_log_likelihood: Option<f64>,
    /// As [`Self::new_place_log_likelihood`].
    pub new_place_posterior: Option<f64>,
    /// The most likely nodes, best first.
    pub candidates: Vec<Candidate>,
}

/// The answers to a live traversal, and the object that holds them.
pub(crate) struct Matches {
    pub table: ObjectId,
    pub frames: Vec<FrameMatches>,
}
