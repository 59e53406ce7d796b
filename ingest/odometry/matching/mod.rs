//! Matches between two images: mutually best by descriptor, thinned, checked by their neighbours, refined to a fraction
//! of a pixel. Nothing here knows a motion: it may use `params` and `features`.

mod best;
mod bucket;
mod distance;
mod four_lanes;
mod mutual;
mod patch;
mod refinement;
mod sides;
mod stereo;
mod support;
#[cfg(test)]
mod tests;
mod whole_image;

pub(crate) use best::Match;
pub(crate) use bucket::select_best_of_buckets;
pub(crate) use mutual::match_mutually;
pub(crate) use patch::Patch;
pub(crate) use refinement::UNREFINED_VARIANCE;
pub use sides::SideVotes;
pub use stereo::StereoFrame;
pub(crate) use support::{FlowSample, find_supported};
pub(crate) use whole_image::match_whole_image;
