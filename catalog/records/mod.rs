//! Every record that is stored, a file per noun. Nothing here knows the index, and nothing is computed here.
//!
//! A record is JSON with its kind and format version in front, keys in the order of the fields, floats in their
//! shortest form that reads back the same, so that equal records are equal bytes.
//!
//! A field that is added, changed or dropped makes a new [`Record::VERSION`]; [`Record::upgrade`] then reads the old
//! form, and a test holds its bytes (`tests/records/forms`). An id is the digest of these bytes: a new version of a
//! kind gives its records new ids.
//!
//! - [`record`]: what a record is: kind, version, bytes;
//! - [`traversal`], [`views`], [`request`], [`notes`], [`duplicates`], [`unreadable`]: what an ingest leaves;
//! - [`experience`], [`outcome`]: the two that [`furrow_model`] defines;
//! - [`codebook`], [`generator`], [`gate`], [`threshold`]: what is trained and measured;
//! - [`run`]: a matrix as resolved against the store.

pub mod codebook;
pub mod duplicates;
pub mod experience;
pub mod gate;
pub mod generator;
pub mod notes;
pub mod outcome;
pub mod record;
pub mod request;
pub mod run;
pub mod threshold;
pub mod traversal;
pub mod unreadable;
pub mod views;

pub use codebook::{CodebookRecord, FeatureParameters};
pub use duplicates::DuplicatesRecord;
pub use gate::{GateRecord, SwitchRecord};
pub use generator::{GeneratorRecord, TrainingDomain};
pub use notes::NotesRecord;
pub use record::{Record, decode, encode, read, record_id};
pub use request::RequestRecord;
pub use run::{BlockedCell, ContrastPair, RunCell, RunContrasts, RunRecord};
pub use threshold::ThresholdRecord;
pub use traversal::{SensorTable, TraversalCounts, TraversalRecord, Unpaired};
pub use unreadable::{UnreadableImage, UnreadableRecord};
pub use views::{Cameras, ViewsRecord};
