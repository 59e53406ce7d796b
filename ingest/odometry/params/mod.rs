//! Every parameter, with its unit and its default. Plain records: nothing here computes on images or motions.
//!
//! The records are serialisable because keys hash their JSON: a renamed field keeps its stored name.

mod features;
mod matching;
mod motion;
mod verification;

pub use features::{MatcherParams, MatchingScale};
pub use matching::{BucketParams, StereoParams, SupportParams};
pub use motion::{OdometryParams, RansacParams, SecondTryParams};
pub use verification::{TwoViewParams, VerifyParams};

#[cfg(test)]
mod tests;
