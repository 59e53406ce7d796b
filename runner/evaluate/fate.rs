//! What became of a live frame.

use super::event_row::EventRow;

/// What became of one live frame.
pub(super) struct Fate<'a> {
    pub(super) accepted: Option<&'a EventRow>,
    /// The verified candidate with most inliers, ties to the more likely.
    pub(super) verified: Option<&'a EventRow>,
    /// The place of the first right hypothesis among all experiences', the most likely first, before any verification.
    /// A new place is one of them, and right nowhere.
    pub(super) first_right: Option<u32>,
}
