//! Stereo odometry: the motion between two frames, and from each frame to the next.

use super::circle::{match_frames, match_near};
use super::consensus::find_consensus;
use super::failure::MotionFailure;
use super::observe::observe;
use super::reprojection::{Reprojection, Views, Weights};
use crate::features::FrameFeatures;
use crate::matching::{Match, StereoFrame};
use crate::params::OdometryParams;
use furrow_model::{GreyImage, Se3, StereoRig};

/// An accepted motion between two frames.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    /// The current left camera's pose in the previous one's frame.
    pub previous_from_current: Se3,
    /// Matches that entered the fit, after outlier removal, bucketing and refinement.
    pub matches: usize,
    /// Matches that agree with the motion.
    pub inliers: usize,
    /// Root mean square length of the inliers' residuals (u left, v, u right), in px.
    pub rms_px: f64,
    /// Covariance of a small step (rotation x y z in rad, translation x y z in m) of the current camera in its own
    /// frame: the true pose is `previous_from_current` times the motion of that step. It comes from the residuals of
    /// the matches and from [`OdometryParams::calibration_error`].
    pub covariance: [[f64; 6]; 6],
}

/// Odometry of one rig. It keeps the previous frame and nothing else: each step depends on two frames, the rig and the
/// parameters only.
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

    /// Prepares a frame: features of both images and their left-right matches. It needs no other frame, so callers can
    /// do it in parallel. [`Odometry::push_frame`] then takes the frames in order.
    pub fn prepare(&self, left: &GreyImage, right: &GreyImage) -> StereoFrame {
        let extract = |image| FrameFeatures::extract(image, &self.params.matcher);
        StereoFrame::new(extract(left), extract(right), &self.rig, &self.params.stereo)
    }

    /// The motion from the frame pushed before to this one, given as rectified images. `None` for the first frame.
    pub fn push(&mut self, left: &GreyImage, right: &GreyImage) -> Option<Result<Motion, MotionFailure>> {
        let frame = self.prepare(left, right);
        self.push_frame(frame)
    }

    /// [`Odometry::push`] with a prepared frame.
    pub fn push_frame(&mut self, current: StereoFrame) -> Option<Result<Motion, MotionFailure>> {
        let motion = self.previous.as_ref().map(|previous| estimate(previous, &current, &self.rig, &self.params));
        self.previous = Some(current);
        motion
    }
}

/// The motion between two frames of one rig: match, refine, RANSAC, accept or refuse.
pub fn estimate(
    previous: &StereoFrame,
    current: &StereoFrame,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Result<Motion, MotionFailure> {
    fit_matches(previous, current, &match_frames(previous, current, rig, params), params.min_inlier_share, rig, params)
}

/// The motion between two frames, searched only near `previous_from_current`: more matches are found where features
/// look alike, and fewer of them must agree.
pub(crate) fn estimate_near(
    previous: &StereoFrame,
    current: &StereoFrame,
    previous_from_current: &Se3,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Result<Motion, MotionFailure> {
    let matched = match_near(previous, current, &previous_from_current.inverse(), rig, params);
    fit_matches(previous, current, &matched, params.second_try.min_inlier_share, rig, params)
}

/// RANSAC on the refined matches, and whether its result is accepted.
fn fit_matches(
    previous: &StereoFrame,
    current: &StereoFrame,
    matched: &[Match],
    min_inlier_share: f64,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Result<Motion, MotionFailure> {
    let observations: Vec<_> = matched.iter().filter_map(|m| observe(previous, current, m, rig, params)).collect();
    let (matches, needed) = (observations.len(), params.ransac.min_inliers);
    if matches < needed {
        return Err(MotionFailure::TooFewMatches { matches, needed });
    }
    let reprojection = Reprojection { rig, views: Views::Stereo, weights: Weights::Noise };
    let found =
        find_consensus(&reprojection, &observations, &Se3::IDENTITY, &params.ransac, |m| params.is_plausible(m))
            .ok_or(MotionFailure::NotConverged { matches })?;
    let inliers = found.inliers.len();
    // The share is that of all matches, also of those that could not be refined: they are evidence against the motion.
    let needed = needed.max((min_inlier_share * matched.len() as f64).ceil() as usize);
    if inliers < needed {
        return Err(MotionFailure::TooFewInliers { matches, inliers, needed });
    }
    let previous_from_current = found.after_from_before.inverse();
    let systematic_m = params.calibration_error * previous_from_current.distance_m();
    let systematic = |i: usize, j: usize| if i == j && i >= 3 { systematic_m * systematic_m } else { 0.0 };
    let covariance: [[f64; 6]; 6] =
        std::array::from_fn(|i| std::array::from_fn(|j| found.covariance[(i, j)] + systematic(i, j)));
    let std_m = (3..6).map(|i| covariance[i][i].sqrt()).fold(0.0, f64::max);
    if std_m > params.max_std_m {
        return Err(MotionFailure::TooUncertain { matches, inliers, std_m, limit_m: params.max_std_m });
    }
    Ok(Motion { previous_from_current, matches, inliers, rms_px: found.rms_px, covariance })
}
