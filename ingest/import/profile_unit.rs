//! What stamps count, and the columns that lists have unless a profile says others.

use serde::Deserialize;

/// What a stamp counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Unit {
    /// Told by the number of digits, as in folders without a profile; in names only.
    #[default]
    Digits,
    /// Seconds, with a fraction.
    S,
    /// Milliseconds.
    Ms,
    /// Microseconds.
    Us,
    /// Nanoseconds.
    Ns,
    /// `2011-09-26 13:02:25.964389445`, in UTC.
    Date,
}

/// The first column.
pub(super) fn first() -> String {
    "1".to_owned()
}

/// The second column.
pub(super) fn second() -> String {
    "2".to_owned()
}
