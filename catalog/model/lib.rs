//! The nouns of furrow, as plain data: no file, socket or clock is touched here.
//!
//! A tour, in the order the data comes into being:
//! - [`id`]: what names a thing: BLAKE3 digests with a kind, so that an experience id cannot pass for an image's;
//! - [`slot`]: sites have routes, a traversal is driven at a [`TimeSlot`] for a [`Purpose`];
//! - [`image`]: grey and colour images, row by row;
//! - [`camera`]: calibrations as recorded and the rectified [`StereoRig`];
//! - [`pose`]: rigid transforms, named `b_from_a`;
//! - [`trajectory`]: the chain of odometry steps and keyframing on it;
//! - [`experience`]: immutable versions: nodes on a chain, recorded or generated;
//! - [`outcome`]: what running a cell of a matrix gave;
//! - [`evaluation`]: the numbers in it;
//! - [`contrast`]: whether one contender beats another;
//! - [`seconds`], [`tum`]: stamps and poses as text, as other programs write them;
//! - [`name`]: names that people read, and what may not be in them.
//!
//! Conventions everywhere: camera axes x right, y down, z forward; metres, radians and nanoseconds; `f64` for geometry.

pub mod camera;
pub mod contrast;
pub mod evaluation;
pub mod experience;
pub mod id;
pub mod image;
pub mod name;
pub mod outcome;
pub mod pose;
pub mod seconds;
pub mod slot;
pub mod trajectory;
pub mod tum;
mod wide;

pub use camera::{CameraCalibration, Distortion, StereoRig};
pub use contrast::{Contrast, ContrastPass, Difference, Verdict, signed};
pub use evaluation::{
    AtThreshold, Censored, Evaluation, GroundTruthScore, LostDistance, LostPoint, LostStretch, PrecisionRecall,
};
pub use experience::{Domainness, Experience, ExperienceKind, Node};
pub use id::{CellKey, CodebookId, ExperienceId, ObjectId, RecordingId, RunId, TraversalId};
pub use image::{ColourImage, GreyImage};
pub use name::shown;
pub use outcome::{Member, Outcome};
pub use pose::Se3;
pub use seconds::parse_seconds_ns;
pub use slot::{Purpose, TimeSlot};
pub use trajectory::{KeyframePolicy, Step, StepCovariance, Trajectory};
pub use tum::{TumError, TumPose, parse_tum};
