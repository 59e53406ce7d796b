//! Stretches of the chain, compared from end to end while their frames are at hand.

use furrow_model::{StereoRig, Trajectory};
use furrow_odometry::{OdometryParams, SpanPolicy, StereoFrame, estimate, reconcile};
use rayon::prelude::*;
use std::sync::Arc;

/// The stretch that has no end yet: its first frame, and the number of its first step.
#[derive(Default)]
pub(super) struct Stretches {
    open: Option<(Arc<StereoFrame>, usize)>,
}

impl Stretches {
    /// Takes the newest frames of `chain`, `views`, and reconciles the steps of every stretch that ends among them. Stretches of one step have
    /// been compared already; ends that cannot be matched leave the steps as they are.
    pub fn reconcile(
        &mut self,
        chain: &mut Trajectory,
        views: &[Arc<StereoFrame>],
        rig: &StereoRig,
        params: &OdometryParams,
    ) {
        let Some(first) = views.first() else { return };
        let (mut begin, mut from) = self.open.take().unwrap_or_else(|| (first.clone(), 0));
        // Step k leads to frame k + 1.
        let before = chain.frames() - views.len();
        let mut complete = Vec::new();
        let origin = from;
        for end in SpanPolicy::default().ends(&chain.steps[origin..]) {
            let (last, view) = (origin + end, &views[origin + end + 1 - before]);
            if last > from {
                complete.push((from..last + 1, begin, view.clone()));
            }
            (begin, from) = (view.clone(), last + 1);
        }
        self.open = Some((begin, from));
        let wholes: Vec<_> = complete.par_iter().map(|(_, begin, end)| estimate(begin, end, rig, params)).collect();
        for ((steps, ..), whole) in complete.into_iter().zip(wholes) {
            if let Ok(whole) = whole {
                reconcile(&mut chain.steps[steps], &whole);
            }
        }
    }
}
