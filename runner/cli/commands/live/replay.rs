//! The replay itself: frames are offered to the localisers as the camera took them.

use super::decision::{DecisionView, ReplayView};
use crate::ending::Failure;
use furrow_runner::inputs::traversals::LiveTraversal;
use furrow_runner::live::{LiveHub, Localisers, Seen};
use furrow_runner::localiser::hub::{Moment, PairAnswer, PairId};
use std::sync::Arc;
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

/// How fast frames are offered.
#[derive(Debug, Clone, Copy)]
pub enum Pace {
    /// As they were recorded, faster by a factor; frames that came meanwhile are skipped.
    Clock { speed: f64 },
    /// Each once every localiser has answered the one before.
    Lockstep,
}

/// Replays a traversal; `report` is called with every decision.
pub fn replay(
    traversal: &LiveTraversal,
    localisers: &Arc<Localisers>,
    pace: Pace,
    mut report: impl FnMut(&DecisionView) -> Result<(), Failure>,
) -> Result<ReplayView, Failure> {
    let labels: Vec<String> = localisers.experiences().map(|(_, label, _)| label.to_owned()).collect();
    let mut hub: LiveHub<Seen> = LiveHub::default();
    let (failed, failures) = channel();
    for number in 0..labels.len() {
        let (localisers, failed) = (Arc::clone(localisers), failed.clone());
        hub.add(PairId(number as u32), move |seen| {
            localisers.answer(number, seen).unwrap_or_else(|error| {
                // Nobody listens any more if the replay has ended on another failure.
                drop(failed.send(error));
                PairAnswer::NewPlace
            })
        });
    }
    let poses = traversal.chain.poses();
    let moments = poses.iter().map(|pose| Moment { stamp_ns: pose.stamp_ns, travelled_m: pose.travelled_m });
    let moments: Vec<Moment> = moments.collect();
    let (begun, mut decisions, mut next) = (Instant::now(), Vec::new(), 0);
    while let Some(frame) = wait_for_frame(&moments, next, begun, pace) {
        next = frame + 1;
        let seen = localisers.look_at(&traversal.frames[frame])?;
        hub.offer(moments[frame], seen);
        if matches!(pace, Pace::Lockstep) {
            hub.settle();
        }
        if let Ok(error) = failures.try_recv() {
            return Err(error.into());
        }
        let decision = DecisionView::of(moments[frame], &hub.decide(moments[frame]), &labels);
        report(&decision)?;
        decisions.push(decision);
    }
    hub.settle();
    let wall_s = begun.elapsed().as_secs_f64();
    Ok(ReplayView {
        live: traversal.record.slot,
        threshold_inliers: localisers.threshold(),
        frames: moments.len(),
        looked_at: decisions.len(),
        localised: decisions.iter().filter(|decision| decision.experience.is_some()).count(),
        wall_s,
        steps_per_s: decisions.len() as f64 / wall_s.max(1e-9),
        skipped: hub.skipped().map(|(pair, frames)| (labels[pair.0 as usize].clone(), frames)).collect(),
        experiences: labels,
        decisions,
    })
}

/// The newest frame, from `next` on, that the camera has taken by now. Waits for `next` if it was not taken yet; in
/// lockstep it is always `next`. `None` at the end of the traversal.
fn wait_for_frame(moments: &[Moment], next: usize, begun: Instant, pace: Pace) -> Option<usize> {
    let first = moments.first()?.stamp_ns;
    if next >= moments.len() {
        return None;
    }
    let Pace::Clock { speed } = pace else { return Some(next) };
    let due = |i: usize| Duration::from_secs_f64((moments[i].stamp_ns - first).max(0) as f64 / 1e9 / speed);
    std::thread::sleep(due(next).saturating_sub(begun.elapsed()));
    let now = begun.elapsed();
    Some(next + (next + 1..moments.len()).take_while(|i| due(*i) <= now).count())
}
