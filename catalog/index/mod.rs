//! The SQLite index: which records exist, by place, slot and purpose. Only this folder speaks SQL; it knows no record's
//! bytes and no file but its own. Only the submitting process opens the store's; workers have one of their own in
//! memory.
//!
//! A file per noun: its row, and what is entered and asked of it.

mod check;
mod columns;
mod connection;
mod experiences;
mod generators;
mod outcomes;
mod recordings;
mod runs;
mod sites;
mod superseded;
mod traversals;
mod work;

pub(crate) use connection::Index;
pub use experiences::ExperienceRow;
pub use generators::{GateRow, GeneratorRow};
pub use recordings::{RecordingPart, RecordingRow};
pub use runs::RunRow;
pub use sites::SiteRow;
pub use traversals::{PlaceRow, TraversalRow};
pub use work::{FailureRow, TimingRow};
