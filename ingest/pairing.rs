//! Pairing left and right frames by header stamp, as they come.
//!
//! Two frames are a pair where each is the other's nearest and they are at most half a period apart; of two that are
//! equally near, the earlier counts. So the result does not depend on the order in which frames come, as long as they
//! come within the buffer's reach, and pairs never cross.

pub use furrow_catalog::images::Side;

use std::collections::VecDeque;

/// A frame is settled once this many frames of each side, itself included, have come: then its neighbours are known.
const SETTLED_AFTER: usize = 8;
/// At most this many frames of one side wait for a side that lags or has stopped.
const MOST_WAITING: usize = 64;
/// Settled stamps of each side that the period is estimated from, with those that wait.
const REMEMBERED: usize = 32;
/// A gap that someone has to be told of: 10 s.
const LONG_GAP_NS: i128 = 10_000_000_000;
/// Gaps that are remembered.
const MOST_GAPS: usize = 16;
/// The period where fewer than two frames of each side were seen: 30 Hz.
const UNKNOWN_PERIOD_NS: i64 = 33_333_333;

/// A frame with its header stamp.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Frame<T> {
    /// Header stamp, nanoseconds since 1970.
    pub stamp_ns: i64,
    /// What came with it.
    pub image: T,
}

/// A left and a right frame of one moment. The left stamp names the pair.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Pair<T> {
    /// The left frame.
    pub left: Frame<T>,
    /// The right frame.
    pub right: Frame<T>,
}

/// What happened to the frames of a recording.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct PairingReport {
    /// Pairs handed out.
    pub pairs: u64,
    /// Frames without a partner, in order of their stamps.
    pub unpaired: Vec<(i64, Side)>,
    /// Frames whose stamp their side had already; the first was kept.
    pub duplicates: u64,
    /// Frames whose stamp is before that of the frame before them on their side.
    pub out_of_order: u64,
    /// Of those, frames that came too late to be paired; they are unpaired.
    pub late: u64,
    /// Frames that each side lost before the recorder (left, right), counted in gaps of more than 1.5 periods.
    pub dropped: [u64; 2],
    /// The period, nanoseconds: the median step of the last stamps.
    pub period_ns: Option<i64>,
    /// The largest distance between the stamps of a pair, nanoseconds.
    pub largest_offset_ns: i64,
    /// The first gaps between left stamps that someone has to be told of.
    pub gaps: Vec<Gap>,
}

/// A long gap between the stamps of one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gap {
    /// The stamp before it, nanoseconds.
    pub from_ns: i64,
    /// The stamp behind it, nanoseconds.
    pub to_ns: i64,
    /// Whether the clock was set forward, so that no frames are missing.
    pub is_clock: bool,
}

impl PairingReport {
    /// Adds what happened behind a step of the clock.
    pub fn append(&mut self, later: Self) {
        self.pairs += later.pairs;
        self.unpaired.extend(later.unpaired);
        self.duplicates += later.duplicates;
        self.out_of_order += later.out_of_order;
        self.late += later.late;
        self.dropped = [0, 1].map(|side| self.dropped[side].saturating_add(later.dropped[side]));
        self.period_ns = self.period_ns.or(later.period_ns);
        self.largest_offset_ns = self.largest_offset_ns.max(later.largest_offset_ns);
        self.gaps.extend(later.gaps);
    }
}

/// Pairs frames as they come: [`push`](Pairer::push) frames, [`pop`](Pairer::pop) pairs, [`finish`](Pairer::finish),
/// and pop the rest.
#[derive(Debug)]
pub struct Pairer<T> {
    sides: [SideQueue<T>; 2],
    ready: VecDeque<Pair<T>>,
    report: PairingReport,
}

/// One side: frames that wait, in order, and stamps that are settled.
#[derive(Debug)]
struct SideQueue<T> {
    waiting: VecDeque<Frame<T>>,
    settled_ns: VecDeque<i64>,
    last_pushed_ns: Option<i64>,
    /// Stamps before which the clock was set forward.
    set_forward_ns: VecDeque<i64>,
}

impl<T> Default for Pairer<T> {
    fn default() -> Self {
        let queue = || SideQueue {
            waiting: VecDeque::new(),
            settled_ns: VecDeque::new(),
            last_pushed_ns: None,
            set_forward_ns: VecDeque::new(),
        };
        Self { sides: [queue(), queue()], ready: VecDeque::new(), report: PairingReport::default() }
    }
}

impl<T> Pairer<T> {
    /// A pairer that has seen nothing.
    pub fn new() -> Self {
        Self::default()
    }

    /// Takes a frame, in order of arrival.
    pub fn push(&mut self, side: Side, stamp_ns: i64, image: T) {
        let queue = &mut self.sides[side as usize];
        let before = queue.last_pushed_ns.replace(stamp_ns);
        self.report.out_of_order += u64::from(before.is_some_and(|before| stamp_ns < before));
        let waits = queue.waiting.binary_search_by_key(&stamp_ns, |frame| frame.stamp_ns);
        match waits {
            Ok(_) => self.report.duplicates += 1,
            Err(_) if queue.settled_ns.contains(&stamp_ns) => self.report.duplicates += 1,
            Err(_) if queue.settled_ns.back().is_some_and(|&last| stamp_ns < last) => {
                self.report.late += 1;
                self.report.unpaired.push((stamp_ns, side));
            }
            Err(place) => queue.waiting.insert(place, Frame { stamp_ns, image }),
        }
        while self.next_is_settled() {
            self.settle();
        }
    }

    /// Takes a frame as [`push`](Pairer::push) does; its side's clock was set forward before it, and no frames are
    /// lost.
    pub fn push_set_forward(&mut self, side: Side, stamp_ns: i64, image: T) {
        self.sides[side as usize].set_forward_ns.push_back(stamp_ns);
        self.push(side, stamp_ns, image);
    }

    /// Counts a frame whose stamp cannot be right: it gets no partner.
    pub fn leave_out(&mut self, side: Side, stamp_ns: i64) {
        let before = self.sides[side as usize].last_pushed_ns;
        self.report.out_of_order += u64::from(before.is_some_and(|before| stamp_ns < before));
        self.report.unpaired.push((stamp_ns, side));
    }

    /// The next pair, in order of the left stamp.
    pub fn pop(&mut self) -> Option<Pair<T>> {
        self.ready.pop_front()
    }

    /// Settles what waits: no more frames come.
    pub fn finish(&mut self) -> &PairingReport {
        self.report.period_ns = self.period_ns();
        while self.sides.iter().any(|queue| !queue.waiting.is_empty()) {
            self.settle();
        }
        self.report.unpaired.sort_unstable();
        &self.report
    }

    fn next_is_settled(&self) -> bool {
        let waiting = self.sides.each_ref().map(|queue| queue.waiting.len());
        waiting.iter().all(|&frames| frames > SETTLED_AFTER) || waiting.iter().any(|&frames| frames > MOST_WAITING)
    }

    /// Pairs the earliest waiting frame with the first of the other side, or leaves it without a partner.
    fn settle(&mut self) {
        let heads = self.sides.each_ref().map(|queue| queue.waiting.front().map(|frame| frame.stamp_ns));
        let (side, stamp_ns, partner_ns) = match heads {
            [Some(left), right] if right.is_none_or(|right| left <= right) => (Side::Left, left, right),
            [left, Some(right)] => (Side::Right, right, left),
            _ => return,
        };
        let period_ns = self.period_ns().unwrap_or(UNKNOWN_PERIOD_NS);
        let partner_ns = partner_ns.filter(|&partner_ns| {
            partner_ns.saturating_sub(stamp_ns) <= period_ns / 2
                && self.nearest(other_side(side), stamp_ns) == Some(partner_ns)
                && self.nearest(side, partner_ns) == Some(stamp_ns)
        });
        let frame = self.take(side, period_ns);
        let partner = partner_ns.and_then(|_| self.take(other_side(side), period_ns));
        let (left, right) = match (frame, partner) {
            (Some(frame), Some(partner)) if side == Side::Left => (frame, partner),
            (Some(frame), Some(partner)) => (partner, frame),
            _ => {
                self.report.unpaired.push((stamp_ns, side));
                return;
            }
        };
        self.report.pairs += 1;
        let offset_ns = left.stamp_ns.saturating_sub(right.stamp_ns).saturating_abs();
        self.report.largest_offset_ns = self.report.largest_offset_ns.max(offset_ns);
        self.ready.push_back(Pair { left, right });
    }

    /// Takes the first waiting frame of a side and counts what its side lost before it.
    fn take(&mut self, side: Side, period_ns: i64) -> Option<Frame<T>> {
        let queue = &mut self.sides[side as usize];
        let frame = queue.waiting.pop_front()?;
        if let Some(&last) = queue.settled_ns.back() {
            // In halves of a period, so that a gap of 1.5 periods is compared without rounding.
            let gap_ns = i128::from(frame.stamp_ns) - i128::from(last);
            let (gap, period) = (gap_ns * 2, i128::from(period_ns.max(1)));
            let is_clock = queue.set_forward_ns.front() == Some(&frame.stamp_ns);
            if is_clock {
                queue.set_forward_ns.pop_front();
            } else if gap > 3 * period {
                self.report.dropped[side as usize] += u64::try_from((gap + period) / (2 * period) - 1).unwrap_or(0);
            }
            let is_told = side == Side::Left && (is_clock || (gap > 3 * period && gap_ns >= LONG_GAP_NS));
            if is_told && self.report.gaps.len() < MOST_GAPS {
                self.report.gaps.push(Gap { from_ns: last, to_ns: frame.stamp_ns, is_clock });
            }
        }
        queue.settled_ns.push_back(frame.stamp_ns);
        if queue.settled_ns.len() > REMEMBERED {
            queue.settled_ns.pop_front();
        }
        Some(frame)
    }

    /// The stamp of `side` nearest to `stamp_ns`, the earlier of two.
    fn nearest(&self, side: Side, stamp_ns: i64) -> Option<i64> {
        self.sides[side as usize].stamps().min_by_key(|&other| (other.abs_diff(stamp_ns), other))
    }

    /// The lower median of the steps between the stamps of each side.
    fn period_ns(&self) -> Option<i64> {
        let steps = |queue: &SideQueue<T>| {
            let stamps: Vec<i64> = queue.stamps().collect();
            stamps.windows(2).map(|two| two[1].saturating_sub(two[0])).collect::<Vec<_>>()
        };
        let mut steps = self.sides.each_ref().map(steps).concat();
        let middle = steps.len().checked_sub(1)? / 2;
        Some(*steps.select_nth_unstable(middle).1)
    }
}

fn other_side(side: Side) -> Side {
    if side == Side::Left { Side::Right } else { Side::Left }
}

impl<T> SideQueue<T> {
    /// Settled stamps that are remembered, and those that wait, in order.
    fn stamps(&self) -> impl Iterator<Item = i64> {
        self.settled_ns.iter().copied().chain(self.waiting.iter().map(|frame| frame.stamp_ns))
    }
}
