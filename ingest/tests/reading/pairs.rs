//! Pairing against brute force, and on a real recording.

use crate::golden_data::{data, files_below};
use furrow_ingest::message::{CompressedImage, Image};
use furrow_ingest::pairing::{Pairer, PairingReport, Side};
use furrow_ingest::recording::open;
use furrow_ingest::topics::find_stereo;
use proptest::prelude::*;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

const PERIOD: i64 = 100_000_000;
const JITTER: std::ops::Range<i64> = -4_000_000..4_000_000;

/// Pushes frames in this order; pairs and report.
fn pair(frames: &[(Side, i64)]) -> (Vec<(i64, i64)>, PairingReport) {
    let mut pairer = Pairer::new();
    let mut pairs = Vec::new();
    let mut take = |pairer: &mut Pairer<(Side, i64)>| {
        while let Some(pair) = pairer.pop() {
            assert_eq!(
                (pair.left.image, pair.right.image),
                ((Side::Left, pair.left.stamp_ns), (Side::Right, pair.right.stamp_ns))
            );
            pairs.push((pair.left.stamp_ns, pair.right.stamp_ns));
        }
    };
    for &(side, stamp_ns) in frames {
        pairer.push(side, stamp_ns, (side, stamp_ns));
        take(&mut pairer);
    }
    let report = pairer.finish().clone();
    take(&mut pairer);
    (pairs, report)
}

/// All pairs of frames that are each other's nearest and at most half a period apart, found by looking at every two.
fn brute_force(left: &BTreeSet<i64>, right: &BTreeSet<i64>, period: i64) -> Vec<(i64, i64)> {
    let nearest = |to: i64, of: &BTreeSet<i64>| of.iter().copied().min_by_key(|&stamp| ((stamp - to).abs(), stamp));
    let mut pairs = Vec::new();
    for &l in left {
        for &r in right {
            let mutual = nearest(l, right) == Some(r) && nearest(r, left) == Some(l);
            if mutual && (l - r).abs() <= period / 2 {
                pairs.push((l, r));
            }
        }
    }
    pairs
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(300) })]

    /// Offsets stay below 0.4 periods and jitter below 0.04 periods, so that the estimate of the period (the median of
    /// dozens of steps) decides no pair; dropping, duplicating and shuffling are free within the buffer's reach.
    #[test]
    fn pairs_are_those_of_brute_force(
        frames in prop::collection::vec((0_u8..20, 0_u8..20, JITTER, JITTER), 12..150),
        offset in -36_000_000_i64..36_000_000,
        swaps in prop::collection::vec((0_usize..400, 1_usize..5), 0..40),
    ) {
        let mut order = Vec::new();
        for (i, &(keep_left, keep_right, jitter_left, jitter_right)) in frames.iter().enumerate() {
            let stamp = 1_700_000_000_000_000_000 + i as i64 * PERIOD;
            let left = (keep_left, Side::Left, stamp + jitter_left);
            let right = (keep_right, Side::Right, stamp + offset + jitter_right);
            for (keep, side, stamp) in [left, right] {
                // One in twenty is dropped, one in twenty comes twice.
                order.extend(std::iter::repeat_n((side, stamp), match keep { 0 => 0, 1 => 2, _ => 1 }));
            }
        }
        for &(at, by) in &swaps {
            let at = at % order.len();
            let to = (at + by).min(order.len() - 1);
            order.swap(at, to);
        }
        let stamps = |side: Side| order.iter().filter(|frame| frame.0 == side).map(|frame| frame.1).collect();
        let (left, right): (BTreeSet<i64>, BTreeSet<i64>) = (stamps(Side::Left), stamps(Side::Right));
        let expected = brute_force(&left, &right, PERIOD);
        let (pairs, report) = pair(&order);
        prop_assert_eq!(&pairs, &expected);
        prop_assert!(pairs.windows(2).all(|two| two[0].0 < two[1].0 && two[0].1 < two[1].1));
        prop_assert_eq!(report.pairs as usize, pairs.len());
        let lefts = left.iter().filter(|&&l| !pairs.iter().any(|pair| pair.0 == l)).map(|&l| (l, Side::Left));
        let rights = right.iter().filter(|&&r| !pairs.iter().any(|pair| pair.1 == r)).map(|&r| (r, Side::Right));
        let mut unpaired: Vec<(i64, Side)> = lefts.chain(rights).collect();
        unpaired.sort_unstable();
        prop_assert_eq!(report.unpaired, unpaired);
        prop_assert_eq!(report.duplicates as usize, order.len() - left.len() - right.len());
        prop_assert_eq!(report.late, 0);
    }

    #[test]
    fn any_stamps_at_all_end(frames in prop::collection::vec((any::<bool>(), any::<i64>()), 0..200)) {
        let side = |left: bool| if left { Side::Left } else { Side::Right };
        let frames: Vec<_> = frames.iter().map(|&(left, ns)| (side(left), ns)).collect();
        let (pairs, report) = pair(&frames);
        let taken = 2 * pairs.len() + report.unpaired.len() + report.duplicates as usize;
        prop_assert_eq!(taken, frames.len());
    }
}

#[test]
fn dropped_frames_are_counted_by_side() {
    let keep = |i: &i64| ![20, 40, 41, 42].contains(i);
    let left = (0..100).filter(keep).map(|i| (Side::Left, i * PERIOD));
    let mut frames: Vec<_> = left.chain((0..100).map(|i| (Side::Right, i * PERIOD + 5))).collect();
    frames.sort_by_key(|frame| frame.1);
    let (pairs, report) = pair(&frames);
    assert_eq!(
        (pairs.len(), report.dropped, report.period_ns, report.largest_offset_ns),
        (96, [4, 0], Some(PERIOD), 5)
    );
    assert_eq!(report.unpaired, [20, 40, 41, 42].map(|i| (i * PERIOD + 5, Side::Right)));
}

#[test]
fn a_side_that_stops_does_not_fill_the_memory() {
    let mut pairer = Pairer::new();
    let held = std::rc::Rc::new(());
    let mut most = 0;
    for i in 0..2000 {
        pairer.push(Side::Left, i * PERIOD, held.clone());
        if i < 50 {
            pairer.push(Side::Right, i * PERIOD, held.clone());
        }
        while pairer.pop().is_some() {}
        most = most.max(std::rc::Rc::strong_count(&held));
    }
    assert!(most <= 80, "{most} frames were held");
    let report = pairer.finish();
    assert_eq!((report.pairs, report.unpaired.len()), (50, 1950));
}

#[test]
fn the_first_frames_of_a_short_recording_are_paired() {
    let frames = [(Side::Left, 0), (Side::Right, 40_000), (Side::Left, PERIOD), (Side::Right, PERIOD)];
    assert_eq!(pair(&frames).0, [(0, 40_000), (PERIOD, PERIOD)]);
    assert_eq!(pair(&frames[..2]).0, [(0, 40_000)]);
}

/// A recording beside its loose files: `NAME.bag` and `NAME/timestamps.csv`, which says which frames are missing.
#[test]
fn golden_a_real_recording_pairs_all_but_the_frames_that_its_table_lacks() {
    let Some(folder) = data() else { return };
    for table in files_below(&folder).iter().filter(|path| path.ends_with("timestamps.csv")) {
        let bag = table.parent().unwrap().with_extension("bag");
        let text = std::fs::read_to_string(table).unwrap();
        let mut lines = text.lines();
        if !bag.exists() || lines.next() != Some("frame,left_time,right_time,left_present,right_present") {
            continue;
        }
        let (mut both, mut alone) = (Vec::new(), Vec::new());
        for line in lines {
            let cells: Vec<&str> = line.split(',').collect();
            let (left, right) = (seconds_of_day_ns(cells[1]), seconds_of_day_ns(cells[2]));
            match (cells[3], cells[4]) {
                ("1", "1") => both.push((left, right)),
                ("1", _) => alone.push((left, Side::Left)),
                (_, "1") => alone.push((right, Side::Right)),
                _ => {}
            }
        }
        let recording = open(&bag).unwrap();
        let topics = find_stereo(recording.topics(), None, None).unwrap();
        let (mut pairer, mut pairs) = (Pairer::new(), Vec::new());
        let read = recording.read::<()>(&[&topics.left_image, &topics.right_image], &mut |_| (), &mut |message| {
            let encoding = message.topic.encoding;
            let stamp_ns = if topics.compressed {
                CompressedImage::decode(encoding, message.bytes).unwrap().header.stamp_ns
            } else {
                Image::decode(encoding, message.bytes).unwrap().header.stamp_ns
            };
            pairer.push(if message.topic.name == topics.left_image { Side::Left } else { Side::Right }, stamp_ns, ());
            pairs.extend(std::iter::from_fn(|| pairer.pop()).map(|pair| (pair.left.stamp_ns, pair.right.stamp_ns)));
            ControlFlow::Continue(())
        });
        assert!(read.is_ok());
        let report = pairer.finish().clone();
        pairs.extend(std::iter::from_fn(|| pairer.pop()).map(|pair| (pair.left.stamp_ns, pair.right.stamp_ns)));
        eprintln!("{}: {report:?}", bag.display());
        const DAY_NS: i64 = 86_400_000_000_000;
        let of_day: Vec<(i64, i64)> = pairs.iter().map(|(l, r)| (l % DAY_NS, r % DAY_NS)).collect();
        assert_eq!(of_day, both, "{}", bag.display());
        alone.sort_unstable();
        let unpaired: Vec<(i64, Side)> = report.unpaired.iter().map(|&(ns, side)| (ns % DAY_NS, side)).collect();
        assert_eq!(unpaired, alone, "{}", bag.display());
        assert_eq!(report.pairs as usize, both.len());
    }
}

/// `2011-09-26 14:05:35.500923136` as nanoseconds since midnight.
fn seconds_of_day_ns(text: &str) -> i64 {
    let (_, time) = text.split_once(' ').unwrap();
    let (time, fraction) = time.split_once('.').unwrap();
    let seconds = time.split(':').fold(0, |sum, part| sum * 60 + part.parse::<i64>().unwrap());
    seconds * 1_000_000_000 + format!("{fraction:0<9}").parse::<i64>().unwrap()
}
