//! Stereo visual odometry on grey images, and the pair estimator that verification uses (Geiger, Ziegler and Stiller 2011, "StereoScan";
//! thesis 2.3 and 3.5). Numbers in, numbers out: this crate reads no file, knows no clock, and shares work among threads in `chain` alone.
//!
//! A tour, in the order a frame travels:
//! - `filters`: half resolution, 5x5 Sobel, blob and corner masks, in integers;
//! - `extremes`: non-maximum suppression;
//! - `features`: [`FrameFeatures`], the four classes of features of one image with 32 Sobel bytes each; extract once, compare often;
//! - `index`, `matching`: windows of the image searched for the mutually best partner; `matching_afar` where they are wide;
//! - `stereo`: [`StereoFrame`], one moment: features found both left and right. Everything up to here depends on a single frame, so
//!   callers may run it ahead and on many threads;
//! - `temporal`: two moments: sparse matches, a first motion, dense matches where it points, `support` of neighbours, `bucket`s;
//! - `align`: matches refined to a fraction of a pixel on the full images;
//! - `motion`, `ransac`: Gauss-Newton on the reprojection error, and what most matches agree on; `triples` and `agreement` do both for many
//!   at once;
//! - `odometry`: [`Odometry`], one [`Motion`] or one explicit [`MotionFailure`] per frame;
//! - `chain`: [`ChainBuilder`], the steps of a trajectory, tried again near the `recent` motion where they are not sure; `stretches`: parts of it
//!   compared from end to end; `spans`: what makes the steps agree with them;
//! - [`compare`]: a track against the truth;
//! - `verify`: [`verify_three_view`], a live pair against the left image of a candidate; [`verify_four_view`], against both of them;
//! - `two_view`: [`verify_two_view`], a single live image against a candidate's.
//!
//! Equal images and [`params`](OdometryParams) give equal bits on every x86-64 machine and thread count: sampling is seeded, sums have
//! one order, and no transcendental function of the platform is called.

mod agreement;
mod align;
mod bucket;
mod chain;
pub mod compare;
mod extremes;
mod features;
mod filters;
mod index;
mod matching;
mod matching_afar;
mod matching_wide;
mod motion;
mod odometry;
mod params;
mod ransac;
mod recent;
mod spans;
mod stereo;
mod stretches;
mod support;
mod temporal;
#[cfg(test)]
mod test_images;
mod triples;
mod two_view;
mod verify;

pub use chain::ChainBuilder;
pub use features::FrameFeatures;
pub use odometry::{Motion, MotionFailure, Odometry, estimate};
pub use params::{
    BucketParams, MatcherParams, MatchingScale, OdometryParams, RansacParams, SecondTryParams, StereoParams,
    SupportParams, VerifyParams,
};
pub use stereo::StereoFrame;
pub use two_view::{TwoViewEstimate, TwoViewMatch, TwoViewParams, verify_two_view};
pub use verify::{Correspondence, PairEstimate, verify, verify_four_view, verify_three_view};

/// Raised whenever the same images and parameters would give other numbers: part of the key of whatever is computed with this crate.
pub const ALGORITHM_VERSION: u32 = 7;
