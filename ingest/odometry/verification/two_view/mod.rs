//! Verification without a second camera: the matches between one live image and the candidate's must agree on an
//! epipolar geometry. No distances are known, so there is no pose, and a view from far away along the road may pass
//! where three views would refuse it.

mod consensus;
mod cubic;
mod estimate;
mod fundamental;
#[cfg(test)]
mod tests;

pub use estimate::{TwoViewEstimate, TwoViewMatch, verify_two_view};
