//! Which nodes' features are held while which live frames are verified, so that memory stays within its bound.

use crate::RunError;
use furrow_model::StereoRig;
use std::collections::BTreeSet;
use std::ops::Range;

/// A node: which of the experiences at work, and its place there.
pub(super) type Asked = (usize, u32);

/// Live frames that are verified together, and what becomes of nodes before.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Window {
    pub frames: Range<usize>,
    /// Nodes that are prepared for it.
    pub fresh: Vec<Asked>,
    /// Nodes that no longer fit beside them.
    pub dropped: Vec<Asked>,
}

/// Bytes that a node's features take for each pixel of its image, at the most: the image itself, and what stands out in
/// it. Measured: 6 to 8 in small images, fewer in large ones, whose features are found at half their size.
const NODE_BYTES_PER_PX: u64 = 8;
/// Bytes for each pixel of a live image, while a thread decodes, rectifies and describes it and its partner.
const LIVE_BYTES_PER_PX: u64 = 64;
/// All the rest: the program, codebook, words, answers.
const REST: u64 = 256 << 20;

/// How many nodes seen by `rig` may be held in so many bytes, threads working beside.
///
/// # Errors
/// [`RunError::Memory`] where not even the nodes fit that one live frame asks for, `needed` of them.
pub(super) fn room(bytes: u64, threads: usize, rig: &StereoRig, needed: usize) -> Result<usize, RunError> {
    let pixels = u64::from(rig.width) * u64::from(rig.height);
    let beside = REST + LIVE_BYTES_PER_PX * pixels * threads as u64;
    let node = NODE_BYTES_PER_PX * pixels;
    let least = beside + node * needed as u64;
    if bytes < least {
        return Err(RunError::Memory { bytes, least, nodes: needed, threads });
    }
    Ok(usize::try_from((bytes - beside) / node.max(1)).unwrap_or(usize::MAX))
}

/// Parts the live frames so that never more than `room` nodes are held; `asked` are those of each frame, of which
/// `room` holds any one's.
pub(super) fn windows(asked: &[Vec<Asked>], room: usize) -> Vec<Window> {
    let mut windows = Vec::new();
    let mut begin = 0;
    let (mut wanted, mut held): (BTreeSet<Asked>, BTreeSet<Asked>) = Default::default();
    for frame in 0..=asked.len() {
        let next = asked.get(frame);
        let more: BTreeSet<Asked> = next.into_iter().flatten().filter(|node| !wanted.contains(node)).copied().collect();
        if next.is_some() && (wanted.len() + more.len() <= room || frame == begin) {
            wanted.extend(more);
            continue;
        }
        if begin < frame {
            let fresh: Vec<Asked> = wanted.difference(&held).copied().collect();
            let crowded = held.len() + fresh.len() > room;
            let dropped: Vec<Asked> = held.difference(&wanted).filter(|_| crowded).copied().collect();
            held.extend(&fresh);
            dropped.iter().for_each(|node| _ = held.remove(node));
            windows.push(Window { frames: begin..frame, fresh, dropped });
        }
        begin = frame;
        wanted = next.into_iter().flatten().copied().collect();
    }
    windows
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frames that drift along a route of 40 nodes of two experiences, with one far guess each.
    fn drive() -> Vec<Vec<Asked>> {
        (0..60_u32).map(|frame| vec![(0, frame / 2), (1, frame / 3), (1, (frame * 7919) % 40)]).collect()
    }

    #[test]
    fn every_frame_finds_its_nodes_and_no_more_are_held_than_fit() {
        for room in [3, 5, 17, 1000] {
            let (asked, mut held, mut next) = (drive(), BTreeSet::new(), 0);
            for window in windows(&asked, room) {
                assert_eq!(window.frames.start, next, "frames follow each other");
                next = window.frames.end;
                window.dropped.iter().for_each(|node| assert!(held.remove(node), "{node:?} was not there"));
                window.fresh.iter().for_each(|node| assert!(held.insert(*node), "{node:?} was there already"));
                assert!(held.len() <= room, "{} of {room}", held.len());
                assert!(asked[window.frames].iter().flatten().all(|node| held.contains(node)));
            }
            assert_eq!(next, asked.len());
        }
    }

    #[test]
    fn where_all_fits_there_is_one_window_and_nothing_twice() {
        let all = windows(&drive(), 1000);
        let distinct: BTreeSet<Asked> = drive().into_iter().flatten().collect();
        assert_eq!((all.len(), all[0].fresh.len(), all[0].dropped.len()), (1, distinct.len(), 0));
        assert_eq!(windows(&[], 10), []);
        assert_eq!(windows(&[Vec::new(), Vec::new()], 0).len(), 1);
    }

    #[test]
    fn what_cannot_fit_is_told_with_what_would() {
        let rig = StereoRig { width: 1000, height: 1000, focal_px: 1.0, cu_px: 0.0, cv_px: 0.0, baseline_m: 0.1 };
        // 256 MiB, 128 MB for two threads, 8 MB a node.
        let least = (256 << 20) + 128_000_000 + 3 * 8_000_000;
        assert_eq!(room(least, 2, &rig, 3).unwrap(), 3);
        assert_eq!(room(least + 8_000_000, 2, &rig, 3).unwrap(), 4);
        let error = room(least - 1, 2, &rig, 3).unwrap_err().to_string();
        assert!(error.contains("--memory") && error.contains("421 MB"), "{error}");
    }
}
