//! Gauss-Newton on triples of observations, eight triples at a time. Each lane computes what `Reprojection::fit`
//! computes with equal weights, operation by operation, so the bits are equal. One triple at a time, the processor
//! would wait for square roots and divisions.

mod equations;
mod fit;
mod lanes;
mod motions;

pub(super) use fit::fit_triples;
pub(super) use lanes::LANES;
