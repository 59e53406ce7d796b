//! From motions to the chain that experiences sit on.

use crate::odometry::{Motion, MotionFailure, Odometry};
use crate::stereo::StereoFrame;
use furrow_model::{Se3, Step, StepCovariance, Trajectory};

/// Builds a trajectory, frame by frame. A step that failed repeats the last motion and is marked as not valid (SPEC 5).
#[derive(Debug, Clone)]
pub struct ChainBuilder {
    odometry: Odometry,
    last_stamp_ns: Option<i64>,
    last_motion: Se3,
    trajectory: Trajectory,
}

impl ChainBuilder {
    /// Starts before the first frame.
    pub fn new(odometry: Odometry) -> Self {
        Self { odometry, last_stamp_ns: None, last_motion: Se3::IDENTITY, trajectory: Trajectory::default() }
    }

    /// Adds the frame stamped `stamp_ns`; gives the motion that led to it, `None` for the first frame.
    pub fn push(&mut self, stamp_ns: i64, frame: StereoFrame) -> Option<Result<Motion, MotionFailure>> {
        let motion = self.odometry.push_frame(frame);
        if let (Some(from_ns), Some(motion)) = (self.last_stamp_ns, &motion) {
            self.trajectory.steps.push(step(from_ns, stamp_ns, motion, &self.last_motion));
        }
        if let Some(Ok(motion)) = &motion {
            self.last_motion = motion.previous_from_current;
        }
        self.trajectory.start_ns.get_or_insert(stamp_ns);
        self.last_stamp_ns = Some(stamp_ns);
        motion
    }

    /// The chain so far.
    pub fn trajectory(&self) -> &Trajectory {
        &self.trajectory
    }

    /// The chain.
    pub fn finish(self) -> Trajectory {
        self.trajectory
    }
}

/// The chain's record of a motion; `last_motion` (previous_from_current) stands in for one that failed.
pub fn step(from_ns: i64, to_ns: i64, motion: &Result<Motion, MotionFailure>, last_motion: &Se3) -> Step {
    let (from_to, (matches, inliers)) = match motion {
        Ok(motion) => (motion.previous_from_current, (motion.matches, motion.inliers)),
        Err(failure) => (*last_motion, failure.counts()),
    };
    let covariance = motion.as_ref().ok().map(|motion| StepCovariance::of(&motion.covariance));
    Step {
        from_ns,
        to_ns,
        from_to,
        matches: matches as u32,
        inliers: inliers as u32,
        valid: motion.is_ok(),
        covariance,
    }
}
