//! Stretches of the chain, compared from end to end while their frames are at hand: short ones of a few steps, and long ones of a few of those.

use crate::odometry::{Motion, MotionFailure, estimate_near};
use crate::params::OdometryParams;
use crate::spans::{SpanPolicy, reconcile};
use crate::stereo::StereoFrame;
use furrow_model::{Se3, Step, StereoRig, Trajectory};
use rayon::prelude::*;
use std::ops::Range;
use std::sync::Arc;

/// Short stretches in a long one: about as far as neighbouring frames at street speed share most of what they see.
const SHORT_IN_LONG: usize = 2;

/// Where stretches begin that have no end yet.
#[derive(Debug, Clone)]
pub(crate) struct Stretches {
    short: Begin,
    long: Begin,
    /// Short stretches that the long one has.
    shorts: usize,
}

#[derive(Debug, Clone)]
struct Begin {
    frame: Arc<StereoFrame>,
    /// The number of the step that leads on from there.
    step: usize,
}

/// A stretch with both ends.
struct Stretch {
    steps: Range<usize>,
    ends: [Arc<StereoFrame>; 2],
}

impl Begin {
    /// The stretch from here through step `last`, which leads to `frame`, where the next one begins.
    fn until(&mut self, last: usize, frame: &Arc<StereoFrame>) -> Stretch {
        let begun = std::mem::replace(self, Begin { frame: frame.clone(), step: last + 1 });
        Stretch { steps: begun.step..last + 1, ends: [begun.frame, frame.clone()] }
    }
}

impl Stretches {
    /// Begins at the first frame.
    pub fn new(first: &Arc<StereoFrame>) -> Self {
        let begin = Begin { frame: first.clone(), step: 0 };
        Self { short: begin.clone(), long: begin, shorts: 0 }
    }

    /// Takes the newest frames of `chain` and reconciles the steps of every stretch that ends among them, short ones first. Ends that cannot
    /// be matched leave the steps as they are.
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
        for end in SpanPolicy::default().ends(&chain.steps[origin..]) {
            let (last, frame) = (origin + end, &newest[origin + end + 1 - before]);
            short.push(self.short.until(last, frame));
            self.shorts += 1;
            if self.shorts == SHORT_IN_LONG {
                long.push(self.long.until(last, frame));
                self.shorts = 0;
            }
        }
        // A stretch of one step has been compared already.
        short.retain(|stretch| stretch.steps.len() > 1);
        for stretches in [short, long] {
            let steps = &chain.steps;
            let wholes: Vec<_> = stretches.par_iter().map(|stretch| stretch.whole(steps, rig, params)).collect();
            for (stretch, whole) in stretches.into_iter().zip(wholes) {
                if let Ok(whole) = whole {
                    reconcile(&mut chain.steps[stretch.steps], &whole);
                }
            }
        }
    }
}

impl Stretch {
    /// The motion from one end to the other, looked for where the steps lead.
    fn whole(&self, steps: &[Step], rig: &StereoRig, params: &OdometryParams) -> Result<Motion, MotionFailure> {
        let steps = &steps[self.steps.clone()];
        let composed = steps.iter().fold(Se3::IDENTITY, |pose, step| pose.compose(&step.from_to));
        let [begin, end] = &self.ends;
        estimate_near(begin, end, &composed, rig, params)
    }
}
