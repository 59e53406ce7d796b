//! Why no motion was found.

/// Why the motion between two frames is not accepted.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MotionFailure {
    /// The frames have too little in common, or too little texture.
    #[error("only {matches} matches between two frames, at least {needed} are needed")]
    TooFewMatches {
        /// Matches found.
        matches: usize,
        /// Matches needed.
        needed: usize,
    },
    /// No three matches gave a plausible motion, or the fit to the inliers did not converge.
    #[error("the motion fit to {matches} matches did not converge to a plausible step")]
    NotConverged {
        /// Matches tried.
        matches: usize,
    },
    /// Too few matches agree on a motion.
    #[error("only {inliers} of {matches} matches agree on a motion, at least {needed} are needed")]
    TooFewInliers {
        /// Matches tried.
        matches: usize,
        /// Matches that agreed.
        inliers: usize,
        /// Inliers needed.
        needed: usize,
    },
    /// The inliers do not determine the translation.
    #[error(
        "the step has a standard deviation of {std_m:.3} m, at most {limit_m} m is accepted; \
         {inliers} of {matches} matches agree"
    )]
    TooUncertain {
        /// Matches tried.
        matches: usize,
        /// Matches that agreed.
        inliers: usize,
        /// Largest standard deviation of a translation component, metres.
        std_m: f64,
        /// The accepted limit.
        limit_m: f64,
    },
}

impl MotionFailure {
    /// Matches tried and matches that agreed.
    pub fn counts(&self) -> (usize, usize) {
        match *self {
            Self::TooFewMatches { matches, .. } | Self::NotConverged { matches } => (matches, 0),
            Self::TooFewInliers { matches, inliers, .. } | Self::TooUncertain { matches, inliers, .. } => {
                (matches, inliers)
            }
        }
    }
}
