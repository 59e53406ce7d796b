//! The motion between two stereo frames: matches around the circle of four views, Gauss-Newton inside RANSAC, one
//! result or one failure. It may use `params`, `features` and `matching`, not `chain` or `verification`.

mod agreement;
mod circle;
mod consensus;
mod covariance;
mod estimate;
mod failure;
mod gauss_newton;
mod linearise;
mod observation;
mod observe;
mod reprojection;
#[cfg(test)]
mod test_scene;
mod triples;

pub(crate) use consensus::find_consensus;
pub(crate) use estimate::estimate_near;
pub use estimate::{Motion, Odometry, estimate};
pub use failure::MotionFailure;
pub(crate) use observation::{Noise, Observation};
pub(crate) use reprojection::{Reprojection, Views, Weights};
