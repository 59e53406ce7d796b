//! A row of the events table: one candidate of one live frame, and what became of it.

/// A row of the events table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct EventRow {
    pub frame: usize,
    pub member: usize,
    pub rank: u32,
    pub node: Option<u32>,
    /// Of a recogniser without likelihoods its score; none for a new place that it does not know.
    pub log_likelihood: Option<f64>,
    pub new_place_log_likelihood: Option<f64>,
    pub posterior: Option<f64>,
    pub matches: Option<u32>,
    pub inliers: Option<u32>,
    pub decision: &'static str,
    pub error_m: Option<f64>,
    pub correct: Option<bool>,
}
