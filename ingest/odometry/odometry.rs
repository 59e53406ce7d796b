//! Stereo odometry: the motion from each frame to the next.

use crate::features::FrameFeatures;
use crate::matching::Match;
use crate::motion::{Reprojection, Views, Weights};
use crate::params::OdometryParams;
use crate::ransac::consensus;
use crate::stereo::StereoFrame;
use crate::temporal::{match_along, match_moments, refined_observation};
use furrow_model::{GreyImage, Se3, StereoRig};

/// A step that can be believed.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The current left camera's pose in the previous one's frame.
    pub previous_from_current: Se3,
    /// Matches that entered the fit, after neighbour support and bucketing.
    pub matches: usize,
    /// Matches that agree with the motion.
    pub inliers: usize,
    /// Root mean square length of the inliers' residuals (u left, v, u right), in px.
    pub rms_px: f64,
    /// Covariance of a small motion (rotation x y z in rad, translation x y z in m) of the current camera in its own frame: the true
    /// pose is `previous_from_current` times that motion. From what the matches disagree by, and what the calibration may be wrong by.
    pub covariance: [[f64; 6]; 6],
}

/// Why a step cannot be believed.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum MotionFailure {
    /// Too little in common, or too little texture.
    #[error("only {matches} matches between two frames, at least {needed} are needed")]
    TooFewMatches {
        /// Matches found.
        matches: usize,
        /// Matches needed.
        needed: usize,
    },
    /// No three matches gave a plausible motion, or the fit to all that agreed did not settle.
    #[error("the motion fit to {matches} matches did not converge to a plausible step")]
    NotConverged {
        /// Matches tried.
        matches: usize,
    },
    /// The matches do not agree.
    #[error("only {inliers} of {matches} matches agree on a motion, at least {needed} are needed")]
    TooFewInliers {
        /// Matches tried.
        matches: usize,
        /// Those that agreed.
        inliers: usize,
        /// Those that were needed.
        needed: usize,
    },
    /// The matches that agree leave the translation open.
    #[error(
        "the step is uncertain by {sigma_m:.3} m (one sigma), at most {limit_m} m is accepted; {inliers} of {matches} matches agree"
    )]
    TooUncertain {
        /// Matches tried.
        matches: usize,
        /// Those that agreed.
        inliers: usize,
        /// Largest standard deviation of a translation component, metres.
        sigma_m: f64,
        /// What was accepted.
        limit_m: f64,
    },
}

impl MotionFailure {
    /// Matches tried and matches that agreed, for the record of the step.
    pub fn counts(&self) -> (usize, usize) {
        match *self {
            Self::TooFewMatches { matches, .. } | Self::NotConverged { matches } => (matches, 0),
            Self::TooFewInliers { matches, inliers, .. } | Self::TooUncertain { matches, inliers, .. } => {
                (matches, inliers)
            }
        }
    }
}

impl OdometryParams {
    /// Whether a vehicle could have made the step.
    pub(crate) fn is_plausible(&self, motion: &Se3) -> bool {
        motion.distance_m() <= self.max_step_m && motion.angle_rad() <= self.max_turn_rad
    }
}

/// Odometry of one rig. Holds the previous frame and nothing else: each step depends on two frames, the rig and the parameters only.
#[derive(Debug, Clone)]
pub struct Odometry {
    rig: StereoRig,
    params: OdometryParams,
    previous: Option<StereoFrame>,
}

impl Odometry {
    /// Starts before the first frame.
    pub fn new(rig: StereoRig, params: OdometryParams) -> Self {
        Self { rig, params, previous: None }
    }

    /// Prepares a frame: features of both images and their left-right matches. Needs no other frame, so that callers can
    /// do it ahead and in parallel; [`Odometry::push_frame`] then takes the frames in order.
    pub fn prepare(&self, left: &GreyImage, right: &GreyImage) -> StereoFrame {
        let extract = |image| FrameFeatures::extract(image, &self.params.matcher);
        StereoFrame::new(extract(left), extract(right), &self.rig, &self.params.stereo)
    }

    /// The motion from the frame pushed before to this one, given as rectified images; `None` for the first frame.
    pub fn push(&mut self, left: &GreyImage, right: &GreyImage) -> Option<Result<Motion, MotionFailure>> {
        let frame = self.prepare(left, right);
        self.push_frame(frame)
    }

    /// [`Odometry::push`] with a frame prepared before.
    pub fn push_frame(&mut self, current: StereoFrame) -> Option<Result<Motion, MotionFailure>> {
        let motion = self.previous.as_ref().map(|previous| estimate(previous, &current, &self.rig, &self.params));
        self.previous = Some(current);
        motion
    }
}

/// The motion between two frames of one rig: match, refine, find what most matches agree on, judge it.
pub fn estimate(
    previous: &StereoFrame,
    current: &StereoFrame,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Result<Motion, MotionFailure> {
    fit(previous, current, &match_moments(previous, current, rig, params), params.min_inlier_share, rig, params)
}

/// The motion between two frames that are about as far apart as `previous_from_current` says: matches are sought nowhere else, so that more are found
/// where things look alike, and fewer need to agree.
pub(crate) fn estimate_near(
    previous: &StereoFrame,
    current: &StereoFrame,
    previous_from_current: &Se3,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Result<Motion, MotionFailure> {
    let matched = match_along(previous, current, &previous_from_current.inverse(), rig, params);
    fit(previous, current, &matched, params.second_try.min_inlier_share, rig, params)
}

fn fit(
    previous: &StereoFrame,
    current: &StereoFrame,
    matched: &[Match],
    min_inlier_share: f64,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Result<Motion, MotionFailure> {
    let observations: Vec<_> =
        matched.iter().filter_map(|m| refined_observation(previous, current, m, rig, params)).collect();
    let (matches, needed) = (observations.len(), params.ransac.min_inliers);
    if matches < needed {
        return Err(MotionFailure::TooFewMatches { matches, needed });
    }
    let reprojection = Reprojection { rig, views: Views::Stereo, weights: Weights::Noise };
    let found = consensus(&reprojection, &observations, &Se3::IDENTITY, &params.ransac, |m| params.is_plausible(m))
        .ok_or(MotionFailure::NotConverged { matches })?;
    let inliers = found.inliers.len();
    // Of all matches that were found, also those that could not be refined: they speak against the motion.
    let needed = needed.max((min_inlier_share * matched.len() as f64).ceil() as usize);
    if inliers < needed {
        return Err(MotionFailure::TooFewInliers { matches, inliers, needed });
    }
    let previous_from_current = found.after_from_before.inverse();
    let systematic_m = params.calibration_error * previous_from_current.distance_m();
    let systematic = |i: usize, j: usize| if i == j && i >= 3 { systematic_m * systematic_m } else { 0.0 };
    let covariance: [[f64; 6]; 6] =
        std::array::from_fn(|i| std::array::from_fn(|j| found.covariance[(i, j)] + systematic(i, j)));
    let sigma_m = (3..6).map(|i| covariance[i][i].sqrt()).fold(0.0, f64::max);
    if sigma_m > params.max_sigma_m {
        return Err(MotionFailure::TooUncertain { matches, inliers, sigma_m, limit_m: params.max_sigma_m });
    }
    Ok(Motion { previous_from_current, matches, inliers, rms_px: found.rms_px, covariance })
}
