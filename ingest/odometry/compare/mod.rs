//! The error of a track against a reference, as evo 1.38 (Grupp 2017) and the KITTI benchmark (Geiger, Lenz and Urtasun
//! 2012) define it. Tracks are all it knows: it uses nothing else of this crate.
//!
//! In order: [`Track::parse`] text, [`associate`] stamps, [`align()`] the estimate, then [`position_errors`] (evo's
//! APE, the ATE of Sturm et al. 2012), [`step_errors`] (RPE) and [`errors_per_length`] (KITTI).

mod align;
mod errors;
mod pairs;
mod track;

pub use align::{Alignment, align};
pub use errors::{LengthError, PoseErrors, Spread, errors_per_length, position_errors, step_errors};
pub use pairs::{Delta, associate};
pub use track::{Track, TrackError};
