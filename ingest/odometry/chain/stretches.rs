//! Stretches of the chain, compared from end to end as soon as they are complete: short ones of a few steps, and long
//! ones of a few short ones.

use super::reconcile::reconcile;
use crate::matching::StereoFrame;
use crate::motion::{Motion, MotionFailure, estimate_near};
use crate::params::OdometryParams;
use furrow_model::{Se3, Step, StereoRig, Trajectory};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Short stretches per long one: at this distance the ends still share most of what they see.
const SHORT_IN_LONG: usize = 2;

/// A short stretch ends after this many metres: the distance of neighbouring frames at street speed, at which most
/// matches are still found.
const LENGTH_M: f64 = 0.4;
/// It also ends after this many radians of rotation, in whatever directions.
const TURN_RAD: f64 = 0.1;

/// The numbers of the steps that end a short stretch, ascending. The first stretch begins with step 0; the steps after
/// the last end do not make a complete stretch yet.
fn find_ends(steps: &[Step]) -> Vec<usize> {
    let (mut length_m, mut turn_rad) = (0.0, 0.0);
    let mut ends = Vec::new();
    for (i, step) in steps.iter().enumerate() {
        length_m += step.earlier_from_later.distance_m();
        turn_rad += step.earlier_from_later.angle_rad();
        if length_m >= LENGTH_M || turn_rad >= TURN_RAD {
            ends.push(i);
            (length_m, turn_rad) = (0.0, 0.0);
        }
    }
    ends
}

/// The stretches that are not complete yet.
#[derive(Debug, Clone)]
pub(crate) struct Stretches {
    short: Begin,
    long: Begin,
    /// Complete short stretches of the long one.
    short_count: usize,
}

/// Where a stretch begins.
#[derive(Debug, Clone)]
struct Begin {
    frame: Arc<StereoFrame>,
    /// The number of the step that begins there.
    step: usize,
}

/// A complete stretch.
struct Stretch {
    steps: Range<usize>,
    ends: [Arc<StereoFrame>; 2],
}

impl Begin {
    /// The stretch from here to the end of step `last`, which leads to `frame`. The next one begins there.
    fn complete(&mut self, last: usize, frame: &Arc<StereoFrame>) -> Stretch {
        let begun = std::mem::replace(self, Begin { frame: frame.clone(), step: last + 1 });
        Stretch { steps: begun.step..last + 1, ends: [begun.frame, frame.clone()] }
    }
}

impl Stretches {
    /// Both begin at the first frame.
    pub fn new(first: &Arc<StereoFrame>) -> Self {
        let begin = Begin { frame: first.clone(), step: 0 };
        Self { short: begin.clone(), long: begin, short_count: 0 }
    }

    /// Corrects the steps of every stretch of `chain` that ends in one of its `newest` frames, short ones first. If the
    /// ends of a stretch cannot be matched, its steps stay as they are.
    pub fn reconcile(
        &mut self,
        chain: &mut Trajectory,
        newest: &[Arc<StereoFrame>],
        rig: &StereoRig,
        params: &OdometryParams,
    ) {
        // Step k leads to frame k + 1.
        let before = chain.frames() - newest.len();
        let (mut short, mut long) = (Vec::new(), Vec::new());
        let origin = self.short.step;
        for end in find_ends(&chain.steps[origin..]) {
            let (last, frame) = (origin + end, &newest[origin + end + 1 - before]);
            short.push(self.short.complete(last, frame));
            self.short_count += 1;
            if self.short_count == SHORT_IN_LONG {
                long.push(self.long.complete(last, frame));
                self.short_count = 0;
            }
        }
        // A stretch of one step is that step.
        short.retain(|stretch| stretch.steps.len() > 1);
        for stretches in [short, long] {
            let steps = &chain.steps;
            let wholes: Vec<_> = stretches.par_iter().map(|stretch| stretch.measure(steps, rig, params)).collect();
            for (stretch, whole) in stretches.into_iter().zip(wholes) {
                if let Ok(whole) = whole {
                    reconcile(&mut chain.steps[stretch.steps], &whole);
                }
            }
        }
    }
}

impl Stretch {
    /// The motion from one end to the other, searched near that of the steps.
    fn measure(&self, steps: &[Step], rig: &StereoRig, params: &OdometryParams) -> Result<Motion, MotionFailure> {
        let steps = &steps[self.steps.clone()];
        let composed = steps.iter().fold(Se3::IDENTITY, |pose, step| pose.compose(&step.earlier_from_later));
        let [begin, end] = &self.ends;
        estimate_near(begin, end, &composed, rig, params)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stretches_end_when_they_are_long_or_turned_enough() {
        let make_step = |earlier_from_later| Step {
            from_ns: 0,
            to_ns: 1,
            earlier_from_later,
            matches: 100,
            inliers: 80,
            valid: true,
            covariance: None,
        };
        let forward = make_step(Se3 { translation_m: [0.0, 0.0, 0.15], ..Se3::IDENTITY });
        let turn = make_step(Se3::from_quaternion([0.0, 0.06, 0.0, 1.0], [0.0; 3]));
        let steps = [forward, forward, forward, forward, turn, forward, forward];
        assert_eq!(find_ends(&steps), [2, 4]);
        assert!(find_ends(&[]).is_empty());
    }
}
