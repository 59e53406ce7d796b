//! Both cameras' frames in the order in which they were received, each held until those behind it tell whether its
//! clock was set.

use super::side::{Arrival, SideClock, Verdict, WINDOW};
use crate::pairing::Side;
use std::collections::VecDeque;

/// At most this many frames of both sides are held.
const MOST_HELD: usize = 64;
/// A receive time that goes back by so much was written by a recorder whose own clock was set.
const RECORDER_SET_NS: i128 = 1_000_000_000;

/// A frame that waits: its side and times, and what came with it.
type Held<T> = (Side, Arrival, T);

/// Watches the clocks of both sides.
#[derive(Debug)]
pub(crate) struct ClockWatch<T> {
    held: VecDeque<Held<T>>,
    clocks: [SideClock; 2],
    /// The last receive time of each side, and by how much those that follow are moved on.
    recorders: [Option<(i128, i128)>; 2],
}

impl<T> Default for ClockWatch<T> {
    fn default() -> Self {
        Self { held: VecDeque::new(), clocks: Default::default(), recorders: [None; 2] }
    }
}

impl<T> ClockWatch<T> {
    /// Takes a frame, in the order of receiving.
    pub(crate) fn push(&mut self, side: Side, stamp_ns: i64, receive_ns: i64, item: T) {
        let receive_ns = i128::from(receive_ns);
        let recorder = &mut self.recorders[side as usize];
        let moved = match *recorder {
            Some((last, moved)) if last - receive_ns >= RECORDER_SET_NS => moved + last - receive_ns,
            Some((_, moved)) => moved,
            None => 0,
        };
        *recorder = Some((receive_ns, moved));
        let arrival = Arrival { stamp_ns: i128::from(stamp_ns), receive_ns: receive_ns + moved };
        self.held.push_back((side, arrival, item));
    }

    /// The next frame that is decided; with `is_end`, all are. Frames come out as they went in.
    pub(crate) fn pop(&mut self, is_end: bool) -> Option<(Side, Verdict, T)> {
        let &(side, arrival, _) = self.held.front()?;
        let clock = &mut self.clocks[side as usize];
        let verdict = if clock.is_plain(arrival) {
            Verdict::Passes
        } else {
            let of_side = self.held.iter().filter(|held| held.0 == side).map(|held| held.1);
            let next: Vec<Arrival> = of_side.take(WINDOW).collect();
            if next.len() < WINDOW && !is_end && self.held.len() < MOST_HELD {
                return None;
            }
            clock.judge(&next)
        };
        clock.take(arrival, verdict);
        self.held.pop_front().map(|(side, _, item)| (side, verdict, item))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PERIOD: i64 = 100_000_000;
    const START: i64 = 1_700_000_000_000_000_000;

    /// The places of frames at which a clock steps back, and those at which it steps forward.
    fn steps(frames: &[(i64, i64)]) -> (Vec<usize>, Vec<usize>, Vec<usize>) {
        let (mut watch, mut found) = (ClockWatch::default(), (Vec::new(), Vec::new(), Vec::new()));
        let mut next = 0;
        let mut take = |watch: &mut ClockWatch<usize>, is_end| {
            while let Some((_, verdict, place)) = watch.pop(is_end) {
                assert_eq!(place, next);
                next += 1;
                match verdict {
                    Verdict::Passes => {}
                    Verdict::StepsBack(_) => found.0.push(place),
                    Verdict::StepsForward => found.1.push(place),
                    Verdict::IsStray => found.2.push(place),
                }
            }
        };
        for (place, &(stamp_ns, receive_ns)) in frames.iter().enumerate() {
            watch.push(Side::Left, stamp_ns, receive_ns, place);
            take(&mut watch, false);
        }
        take(&mut watch, true);
        assert_eq!(next, frames.len());
        found
    }

    fn even(frames: usize) -> Vec<(i64, i64)> {
        (0..frames as i64).map(|i| (START + i * PERIOD, START + i * PERIOD + 7_000_000)).collect()
    }

    #[test]
    fn one_stray_stamp_is_no_step() {
        for stray in [0, START - 3_600 * 1_000_000_000, START + 3_600 * 1_000_000_000] {
            let mut frames = even(40);
            frames[20].0 = stray;
            assert_eq!(steps(&frames), (vec![], vec![], vec![20]), "{stray}");
        }
    }

    #[test]
    fn forward_and_back_again_is_a_step() {
        let mut frames = even(40);
        frames[15..25].iter_mut().for_each(|frame| frame.0 += 20 * PERIOD);
        assert_eq!(steps(&frames), (vec![25], vec![15], vec![]));
    }

    proptest! {
        #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

        /// A step back of one frame or more is found where it is, under jitter.
        #[test]
        fn steps_back_are_found(
            at in 2_usize..58, periods in 1.0_f64..400.0,
            jitter in prop::collection::vec(-4_000_000_i64..4_000_000, 60),
            latency in prop::collection::vec(0_i64..9_000_000, 60),
        ) {
            let back = (periods * PERIOD as f64) as i64;
            let frames: Vec<(i64, i64)> = (0..60_usize).map(|i| {
                let taken = START + i as i64 * PERIOD;
                (taken + jitter[i] - if i >= at { back } else { 0 }, taken + latency[i])
            }).collect();
            let (backward, forward, stray) = steps(&frames);
            prop_assert_eq!(backward, vec![at]);
            prop_assert!(forward.is_empty() && stray.is_empty());
        }

        /// Late, lost, doubled and jittered frames, and pauses, are no steps. The last frames are on time: frames that
        /// stay late by the same time to the end are a step as far as anybody can tell.
        #[test]
        fn late_frames_are_no_steps(
            frames in prop::collection::vec((0_u8..20, -4_000_000_i64..4_000_000, 0_i64..900_000_000, 0_u8..8), 8..80),
        ) {
            let mut sent = Vec::new();
            let on_time = std::iter::repeat_n(&(2, 0, 0, 1), WINDOW);
            for (i, &(keep, jitter, late, is_late)) in frames.iter().chain(on_time).enumerate() {
                let taken = START + i as i64 * PERIOD + if i > 40 { 77 * PERIOD } else { 0 };
                let received = taken + if is_late == 0 { late } else { 6_000_000 };
                sent.extend(std::iter::repeat_n((taken + jitter, received), match keep { 0 => 0, 1 => 2, _ => 1 }));
            }
            sent.sort_by_key(|frame| frame.1);
            prop_assert_eq!(steps(&sent), (vec![], vec![], vec![]));
        }
    }
}
