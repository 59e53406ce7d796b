//! One camera's clock beside the recorder's, from the stamps and receive times of its frames.
//!
//! A frame's lead is its stamp minus its receive time. A message that comes late has a smaller lead than its
//! neighbours, and those that follow have theirs again; where a clock is set, all that follow have another lead.

use std::collections::VecDeque;

/// Frames that are remembered.
const REMEMBERED: usize = 64;
/// Frames before and behind one that decide on it.
pub(super) const WINDOW: usize = 8;
/// The least frames, itself included, that a step back is seen in.
const LEAST: usize = 3;
/// The period where no two frames tell it: 30 Hz.
const UNKNOWN_PERIOD_NS: i128 = 33_333_333;

/// A frame's stamp and when it was received, nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Arrival {
    pub(super) stamp_ns: i128,
    pub(super) receive_ns: i128,
}

impl Arrival {
    fn lead_ns(self) -> i128 {
        self.stamp_ns - self.receive_ns
    }
}

/// What a frame's stamp says about its clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    /// Nothing unusual.
    Passes,
    /// The clock was set back by so many nanoseconds before this frame.
    StepsBack(i64),
    /// The clock was set forward before this frame; no frames are missing.
    StepsForward,
    /// This stamp alone is far from those before and behind.
    IsStray,
}

/// One side's frames since the recording began or the clock was set back.
#[derive(Debug, Default)]
pub(super) struct SideClock {
    seen: VecDeque<Arrival>,
    best_lead_ns: Option<i128>,
}

impl SideClock {
    /// Whether a frame needs no look at those behind it.
    pub(super) fn is_plain(&self, frame: Arrival) -> bool {
        let period = self.period_ns(&[]);
        let Some(last) = self.last_ns().filter(|_| self.seen.len() >= WINDOW / 2) else { return false };
        2 * (frame.stamp_ns - last) >= period && 2 * (frame.stamp_ns - last) <= 3 * period
    }

    /// Judges the first of `next`, which are this side's next frames in the order in which they were received.
    pub(super) fn judge(&self, next: &[Arrival]) -> Verdict {
        let (Some(&frame), Some(last), Some(best)) = (next.first(), self.last_ns(), self.best_lead_ns) else {
            return Verdict::Passes;
        };
        let period = self.period_ns(next);
        let leads = |frames: &[Arrival]| frames.iter().map(|frame| frame.lead_ns()).collect::<Vec<_>>();
        let before: Vec<Arrival> = self.seen.iter().rev().take(WINDOW).copied().collect();
        let before_most = leads(&before).into_iter().max().unwrap_or(best);
        let (all, others) = (leads(next), leads(&next[1..]));
        let ahead = frame.stamp_ns - last;
        if 2 * ahead < period {
            let most = all.iter().copied().max().unwrap_or(before_most);
            // Late frames are followed by frames on time. So few at the end of a recording may all be late.
            let is_lasting = next.len() >= LEAST && 4 * (before_most - most) >= 3 * period;
            if is_lasting {
                return Verdict::StepsBack(i64::try_from(before_most - most).unwrap_or(i64::MAX));
            }
            let first = self.seen.iter().map(|seen| seen.stamp_ns).min().unwrap_or(last);
            return if frame.stamp_ns < first - WINDOW as i128 * period { Verdict::IsStray } else { Verdict::Passes };
        }
        if 2 * ahead > 3 * period {
            let least = all.iter().copied().min().unwrap_or(best);
            // What is ahead of the first few may only show that these came late.
            if self.seen.len() >= WINDOW && 2 * (least - best) >= ahead - period {
                return Verdict::StepsForward;
            }
            let most = others.iter().copied().max().map_or(before_most, |most| most.max(before_most));
            let is_alone = !others.is_empty() && next[1..].iter().all(|other| other.stamp_ns < frame.stamp_ns);
            if is_alone && frame.lead_ns() >= most + 3 * period {
                return Verdict::IsStray;
            }
        }
        Verdict::Passes
    }

    /// Takes a frame as judged.
    pub(super) fn take(&mut self, frame: Arrival, verdict: Verdict) {
        match verdict {
            Verdict::IsStray => return,
            Verdict::StepsBack(_) => *self = Self::default(),
            Verdict::StepsForward | Verdict::Passes => {}
        }
        self.seen.push_back(frame);
        if self.seen.len() > REMEMBERED {
            self.seen.pop_front();
        }
        let lead = frame.lead_ns();
        self.best_lead_ns = Some(self.best_lead_ns.map_or(lead, |best| best.max(lead)));
    }

    fn last_ns(&self) -> Option<i128> {
        self.seen.iter().map(|seen| seen.stamp_ns).max()
    }

    /// The lower median of the steps ahead between stamps.
    fn period_ns(&self, next: &[Arrival]) -> i128 {
        let stamps: Vec<i128> = self.seen.iter().chain(next).map(|frame| frame.stamp_ns).collect();
        let mut steps: Vec<i128> = stamps.windows(2).map(|two| two[1] - two[0]).filter(|step| *step > 0).collect();
        let Some(middle) = steps.len().checked_sub(1).map(|last| last / 2) else { return UNKNOWN_PERIOD_NS };
        *steps.select_nth_unstable(middle).1
    }
}
