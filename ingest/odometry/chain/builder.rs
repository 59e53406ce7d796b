//! From frames to the chain on which experiences are built.

use super::recent::RecentMotion;
use super::stretches::Stretches;
use crate::matching::StereoFrame;
use crate::motion::{Motion, MotionFailure, estimate, estimate_near};
use crate::params::OdometryParams;
use furrow_model::{Se3, Step, StepCovariance, StereoRig, Trajectory};
use rayon::prelude::*;
use std::sync::Arc;

/// Builds a trajectory from frames in order, in batches of any size: the same frames give the same chain. The frames of
/// a batch are processed on all cores.
///
/// A doubtful step is tried again near the motion that the steps before predict. A step that fails repeats that motion
/// and is marked as not valid, so that the chain has no gap. Then stretches of several steps are compared from end to
/// end, and the steps are corrected to agree with them.
#[derive(Debug, Clone)]
pub struct ChainBuilder {
    rig: StereoRig,
    params: OdometryParams,
    last: Option<Arc<StereoFrame>>,
    recent: RecentMotion,
    stretches: Option<Stretches>,
    trajectory: Trajectory,
}

impl ChainBuilder {
    /// A chain without frames.
    pub fn new(rig: StereoRig, params: OdometryParams) -> Self {
        let (recent, trajectory) = (RecentMotion::default(), Trajectory::default());
        Self { rig, params, last: None, recent, stretches: None, trajectory }
    }

    /// Adds frames that [`Odometry::prepare`](crate::Odometry::prepare) made of this rig's images, each with its stamp
    /// in nanoseconds, ascending.
    pub fn extend(&mut self, frames: Vec<(i64, StereoFrame)>) {
        let (stamps_ns, frames): (Vec<i64>, Vec<_>) =
            frames.into_iter().map(|(ns, frame)| (ns, Arc::new(frame))).unzip();
        let (Some(first), Some(first_ns)) = (self.last.as_ref().or(frames.first()).cloned(), stamps_ns.first()) else {
            return;
        };
        let start_ns = *self.trajectory.start_ns.get_or_insert(*first_ns);
        // Each new frame with the one before it. The chain's first frame has none.
        let new = usize::from(self.last.is_none());
        let before: Vec<&Arc<StereoFrame>> = self.last.iter().chain(&frames).collect();
        let pairs: Vec<_> = before.into_iter().zip(&frames[new..]).collect();
        let motions: Vec<_> =
            pairs.par_iter().map(|(before, after)| estimate(before, after, &self.rig, &self.params)).collect();
        for ((pair, motion), to_ns) in pairs.into_iter().zip(motions).zip(&stamps_ns[new..]) {
            let from_ns = self.trajectory.steps.last().map_or(start_ns, |step| step.to_ns);
            let seconds = 1e-9 * (to_ns - from_ns) as f64;
            let expected = self.recent.predict(seconds);
            let motion = match &expected {
                Some(expected) => retry_if_doubtful(motion, pair, expected, &self.rig, &self.params),
                None => motion,
            };
            if let Ok(motion) = &motion {
                self.recent.add(motion, seconds);
            }
            self.trajectory.steps.push(make_step(from_ns, *to_ns, &motion, &expected.unwrap_or(Se3::IDENTITY)));
        }
        let stretches = self.stretches.get_or_insert_with(|| Stretches::new(&first));
        stretches.reconcile(&mut self.trajectory, &frames, &self.rig, &self.params);
        self.last = frames.into_iter().next_back().or(self.last.take());
    }

    /// The chain.
    pub fn finish(self) -> Trajectory {
        self.trajectory
    }
}

/// `first` if it is sure, else the better one of it and of a second try near the expected motion
/// (previous_from_current).
fn retry_if_doubtful(
    first: Result<Motion, MotionFailure>,
    (before, after): (&Arc<StereoFrame>, &Arc<StereoFrame>),
    expected: &Se3,
    rig: &StereoRig,
    params: &OdometryParams,
) -> Result<Motion, MotionFailure> {
    let policy = &params.second_try;
    let is_sure = |motion: &Motion| {
        motion.inliers >= policy.sure_inliers && motion.inliers as f64 >= policy.sure_share * motion.matches as f64
    };
    if first.as_ref().is_ok_and(is_sure) {
        return first;
    }
    let second = estimate_near(before, after, expected, rig, params);
    let [inliers, inliers_again] = [&first, &second].map(|motion| motion.as_ref().map_or(0, |motion| motion.inliers));
    if inliers < policy.doubtful_inliers || inliers_again > inliers { second } else { first }
}

/// The chain's record of a motion. `expected` (previous_from_current) replaces one that failed.
fn make_step(from_ns: i64, to_ns: i64, motion: &Result<Motion, MotionFailure>, expected: &Se3) -> Step {
    let (earlier_from_later, (matches, inliers)) = match motion {
        Ok(motion) => (motion.previous_from_current, (motion.matches, motion.inliers)),
        Err(failure) => (*expected, failure.counts()),
    };
    let covariance = motion.as_ref().ok().map(|motion| StepCovariance::of(&motion.covariance));
    Step {
        from_ns,
        to_ns,
        earlier_from_later,
        matches: matches as u32,
        inliers: inliers as u32,
        valid: motion.is_ok(),
        covariance,
    }
}
