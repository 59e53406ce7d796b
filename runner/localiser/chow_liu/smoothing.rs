//! Probabilities from counts, as openFABMAP computes them.

/// openFABMAP's smoothing of every frequency: `0.01 + 0.98 * ratio`, so that nothing is certain.
pub(super) fn smoothed(count: u32, total: u32) -> f64 {
    0.98 * f64::from(count) / f64::from(total) + 0.01
}

/// openFABMAP's value for a conditional probability whose condition was never seen.
pub(super) const NEVER_SEEN: f64 = 0.01;
