//! Stereo visual odometry on grey images, and the pair estimators that verification uses
//! (Geiger, Ziegler and Stiller 2011, "StereoScan"; the thesis, sections 2.3 and 3.5).
//!
//! Images in, motions out: this crate reads no file and no clock, and only `chain` uses more than one thread.
//!
//! A tour, in the order in which a frame is processed. A folder uses only the folders above it:
//! - `params`: [`OdometryParams`], [`VerifyParams`] and the records inside them, each with its unit and default;
//! - `features`: [`FrameFeatures`], the blob and corner features of one image: filters, non-maximum suppression,
//!   descriptors of 32 bytes, and the indices that matching searches. Extract once, compare often;
//! - `matching`: mutually best matches, their refinement to a fraction of a pixel, and [`StereoFrame`], the left-right
//!   matches of one stereo pair. Everything up to here needs one moment only: callers may prepare frames in parallel;
//! - `motion`: two stereo frames. Matches around the circle of four views, Gauss-Newton on the reprojection error
//!   inside RANSAC, and [`Odometry`], which gives one [`Motion`] or one [`MotionFailure`] per frame;
//! - `chain`: [`ChainBuilder`], the steps of a trajectory: a second try for doubtful steps, and stretches of several
//!   steps compared from end to end;
//! - `verification`: [`verify_three_view`] and [`verify_four_view`], a live stereo pair against a candidate;
//!   [`verify_two_view`], a single live image against a candidate.
//!
//! Beside them: `se3` (small motions and the adjoint), `sampling` (RANSAC's samples), and [`compare`], which measures
//! the error of a trajectory against a reference and uses nothing else of this crate.
//!
//! Equal images and [`params`](OdometryParams) give equal bits on every x86-64 machine and for every number of threads:
//! sampling is seeded, sums have one order, and no transcendental function of the platform is called.

mod chain;
pub mod compare;
mod features;
mod matching;
mod motion;
mod params;
mod sampling;
mod se3;
#[cfg(test)]
mod test_support;
mod verification;

pub use chain::ChainBuilder;
pub use features::FrameFeatures;
pub use matching::{SideVotes, StereoFrame};
pub use motion::{Motion, MotionFailure, Odometry, estimate};
pub use params::{
    BucketParams, MatcherParams, MatchingScale, OdometryParams, RansacParams, SecondTryParams, StereoParams,
    SupportParams, TwoViewParams, VerifyParams,
};
pub use verification::{
    Correspondence, PairEstimate, TwoViewEstimate, TwoViewMatch, verify, verify_four_view, verify_three_view,
    verify_two_view,
};

/// Raised whenever equal images and parameters would give other numbers. Part of the key of whatever is computed with
/// this crate.
pub const ALGORITHM_VERSION: u32 = 7;
