//! A text that is no name of a site, of a weather, of a day.

/// A text that names none of the things it should.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("'{given}' is no {what}: expected {expected}")]
pub struct BadName {
    pub(super) given: String,
    pub(super) what: &'static str,
    pub(super) expected: &'static str,
}
