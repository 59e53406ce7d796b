//! How far a track strays from another: the definitions of evo (Grupp 2017) and of the KITTI benchmark (Geiger et al. 2012).
//!
//! The way: [`Track::parse`] text, [`associate`] stamps, [`align`], then [`position_errors`] (APE), [`step_errors`] (RPE) and
//! [`errors_per_length`] (KITTI).

mod align;
mod errors;
mod pairs;
mod track;

pub use align::{Alignment, align};
pub use errors::{LengthError, PoseErrors, Spread, errors_per_length, position_errors, step_errors};
pub use pairs::{Delta, associate};
pub use track::{Track, TrackError};
