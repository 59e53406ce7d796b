//! One traversal into the store: images → rectified views → odometry, or given motion → recorded experience, as one
//! transaction. Containers and message bytes are read by `recording` and `message`, files of the store by `catalog`.

mod attach;
mod beside;
mod clock;
mod doubt;
mod error;
mod experience;
mod folders;
mod identity;
mod importing;
mod ingest;
mod known;
mod layout_identity;
mod lost;
mod motion;
mod notes;
mod parts;
mod picture;
mod progress;
mod reader;
mod request;
mod rig;
mod selection;
mod sensors;
mod source;
mod stages;
mod stamp_checks;
mod stamps_apart;
mod stored_request;
mod stream;
mod stretches;
mod summary;
mod truth;

pub use attach::{AttachSummary, attach_truth};
pub use beside::notes_of;
pub use error::IngestError;
pub use experience::experience_of;
pub use importing::request_of_dataset;
pub use ingest::ingest;
pub use motion::{MotionSource, distance_source};
pub use progress::{IngestProgress, IngestStage};
pub use request::{Imported, IngestRequest};
pub use selection::FrameSelection;
pub use stored_request::request_from_store;
pub use summary::{IngestSummary, Label, TrajectorySummary, UnpairedFrame};
