//! Verification: whether a live view shows a candidate place, by the matches that agree on one geometry. It may use all
//! folders but `chain`.

mod correspondence;
mod observe;
mod pair;
mod two_view;

pub use correspondence::Correspondence;
pub use pair::{PairEstimate, verify, verify_four_view, verify_three_view};
pub use two_view::{TwoViewEstimate, TwoViewMatch, verify_two_view};
