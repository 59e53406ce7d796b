//! Pairing the frames of a recording whose clock may have been set back: each stretch between two steps by itself.

use crate::pairing::{Frame, Pairer, PairingReport, Side};
use crate::traversal::clock::{Offsets, Verdict};
use crate::traversal::picture::Picture;
use crate::traversal::selection::FrameSelection;
use std::collections::VecDeque;

/// An image under its own stamp, with the stamp that it is paired by and the time when it was received.
pub(crate) struct Taken {
    pub(crate) pair_ns: i64,
    pub(crate) receive_ns: Option<i64>,
    pub(crate) frame: Frame<Picture>,
}

/// A step of a clock back in time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Step {
    /// Whose clock.
    pub(crate) side: Side,
    /// Before which image of its side, counted from 0 as received.
    pub(crate) image: u64,
    /// By how much, nanoseconds.
    pub(crate) back_ns: i64,
}

/// The stretches of a recording, paired.
#[derive(Default)]
pub(crate) struct Stretches {
    /// The open stretches: a side may be ahead of the other.
    pairers: VecDeque<Pairer<Taken>>,
    /// Stretches that are closed.
    closed: usize,
    /// The stretch of each side's next frame.
    current: [usize; 2],
    images: [u64; 2],
    /// What became of the frames of closed stretches.
    pub(crate) report: PairingReport,
    /// Where clocks were set back.
    pub(crate) steps: Vec<Step>,
    /// Pairs of each stretch so far.
    pub(crate) pairs: Vec<u32>,
    /// Images whose stamp is far from those around it.
    pub(crate) strays: u64,
    /// Receive times of pairs.
    pub(crate) offsets: Offsets,
    ready: VecDeque<(Frame<Picture>, Frame<Picture>)>,
}

impl Stretches {
    /// Takes a frame whose clock nobody watched.
    pub(crate) fn push(&mut self, side: Side, taken: Taken) {
        self.push_judged(side, Verdict::Passes, taken);
    }

    /// Takes a frame with what its stamp says about its clock.
    pub(crate) fn push_judged(&mut self, side: Side, verdict: Verdict, taken: Taken) {
        let image = self.images[side as usize];
        self.images[side as usize] += 1;
        if let Verdict::StepsBack(back_ns) = verdict {
            self.steps.push(Step { side, image, back_ns });
            self.current[side as usize] += 1;
            while self.current.iter().all(|&current| current > self.closed) {
                self.close_first();
            }
        }
        let place = self.current[side as usize] - self.closed;
        while self.pairers.len() <= place {
            self.pairers.push_back(Pairer::new());
        }
        let pairer = &mut self.pairers[place];
        match verdict {
            Verdict::IsStray => {
                self.strays += 1;
                pairer.leave_out(side, taken.pair_ns);
            }
            Verdict::StepsForward => pairer.push_set_forward(side, taken.pair_ns, taken),
            _ => pairer.push(side, taken.pair_ns, taken),
        }
        self.take_pairs();
    }

    /// Settles what waits: no more frames come.
    pub(crate) fn finish(&mut self) {
        while !self.pairers.is_empty() {
            self.close_first();
        }
        self.report.unpaired.sort_unstable();
    }

    /// The next pair, in the recording's order.
    pub(crate) fn pop(&mut self) -> Option<(Frame<Picture>, Frame<Picture>)> {
        self.ready.pop_front()
    }

    /// Whether the pairs so far may be of use: those that are selected are of one stretch.
    pub(crate) fn may_enter(&self, selection: FrameSelection) -> bool {
        self.pairs.len() <= 1 || ranges(&self.pairs).filter(|&(from, to)| selection.touches(from, to)).count() <= 1
    }

    fn close_first(&mut self) {
        if let Some(first) = self.pairers.front_mut() {
            first.finish();
            self.take_pairs();
        }
        if let Some(mut first) = self.pairers.pop_front() {
            self.report.append(first.finish().clone());
        }
        self.closed += 1;
    }

    /// Takes the pairs of the first open stretch; those of later ones have to wait for its end.
    fn take_pairs(&mut self) {
        let Some(first) = self.pairers.front_mut() else { return };
        while let Some(pair) = first.pop() {
            self.pairs.resize(self.closed + 1, 0);
            self.pairs[self.closed] += 1;
            let (left, right) = (pair.left.image, pair.right.image);
            if let Some((left_ns, right_ns)) = left.receive_ns.zip(right.receive_ns) {
                self.offsets.push(left_ns, right_ns);
            }
            self.ready.push_back((left.frame, right.frame));
        }
    }
}

/// The pairs of each stretch that has some: from the first number to before the second.
pub(crate) fn ranges(pairs: &[u32]) -> impl Iterator<Item = (u32, u32)> {
    let ends = pairs.iter().scan(0, |end: &mut u32, pairs| {
        let from = *end;
        *end += pairs;
        Some((from, *end))
    });
    ends.filter(|(from, to)| from < to)
}
