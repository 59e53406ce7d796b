//! The layout for whole-image windows: points sorted by class and strips of the image, in blocks of sixteen whose bytes
//! are in the order in which AVX2 compares them.

use super::index::{CLASSES, Index, Window};
use std::ops::Range;

/// Points per block: as many 16-bit distances as fit a register of AVX2.
pub(crate) const LANES: usize = 16;
/// Bytes whose absolute differences one instruction sums up.
pub(crate) const SUMMED: usize = 8;
/// Bytes per register.
pub(crate) const REGISTER: usize = 32;
/// A strip has 32 rows of the image, so that a window of half the image has long runs of points.
const STRIP_LOG2: u32 = 5;
/// The points of a strip are sorted by columns of 16 pixels.
const COLUMN_LOG2: u32 = 4;
/// Position of the padding of a strip's last block: outside of every window.
const NOWHERE: i16 = i16::MIN;

/// Points with descriptors of `N` bytes.
#[derive(Debug, Clone)]
pub(crate) struct Blocks<const N: usize> {
    /// Column of each point, matching px.
    pub u: Vec<i16>,
    /// Row of each point, matching px.
    pub v: Vec<i16>,
    /// The index that each point has in the [`Index`] it was taken from.
    pub names: Vec<u32>,
    /// The descriptors, block by block. A block has four groups of N / 8 registers. Group g holds the points 4 c + g
    /// for c from 0 to 3, and its register k holds bytes 8 k to 8 k + 7 of each of these four. The sums of absolute
    /// differences of a group's registers add up to the distances of four points, and the four groups, each shifted by
    /// 16 bits, give sixteen distances in order.
    pub bytes: Vec<u8>,
    strips: usize,
    columns: usize,
    /// Where each (class, strip, column) begins. After a strip's last column follows the strip's end.
    starts: Vec<u32>,
}

impl<const N: usize> Blocks<N> {
    /// Bytes of a block.
    pub const BLOCK: usize = LANES * N;

    /// The points of an image of `size` columns and rows.
    pub fn new(index: &Index<N>, (width, height): (usize, usize)) -> Self {
        const { assert!(N.is_multiple_of(SUMMED)) };
        let (strips, columns) = ((height >> STRIP_LOG2) + 1, (width >> COLUMN_LOG2) + 1);
        let strip = |i: u32| {
            let i = i as usize;
            usize::from(index.class[i]) * strips + (index.v[i] as usize >> STRIP_LOG2)
        };
        let column = |i: u32| index.u[i as usize] as usize >> COLUMN_LOG2;
        let mut order: Vec<u32> = (0..index.len() as u32).collect();
        order.sort_by_key(|&i| (strip(i), column(i)));

        let mut blocks = Self {
            u: Vec::new(),
            v: Vec::new(),
            names: Vec::new(),
            bytes: Vec::new(),
            strips,
            columns,
            starts: vec![0; CLASSES * strips * (columns + 1)],
        };
        let mut rest = order.as_slice();
        for number in 0..CLASSES * strips {
            let (here, others) = rest.split_at(rest.partition_point(|&i| strip(i) == number));
            rest = others;
            for at in 0..=columns {
                let before = here.partition_point(|&i| column(i) < at);
                blocks.starts[number * (columns + 1) + at] = (blocks.names.len() + before) as u32;
            }
            blocks.push(index, here);
        }
        blocks
    }

    /// Adds the points of a strip.
    fn push(&mut self, index: &Index<N>, strip: &[u32]) {
        for block in strip.chunks(LANES) {
            let from = self.bytes.len();
            self.bytes.resize(from + Self::BLOCK, 0);
            for (lane, &i) in block.iter().enumerate() {
                let (group, part) = (lane % 4, lane / 4);
                for (k, summed) in index.descriptors[i as usize].chunks_exact(SUMMED).enumerate() {
                    let at = from + (group * (N / SUMMED) + k) * REGISTER + part * SUMMED;
                    self.bytes[at..at + SUMMED].copy_from_slice(summed);
                }
            }
            self.names.extend(block);
            self.u.extend(block.iter().map(|&i| index.u[i as usize]));
            self.v.extend(block.iter().map(|&i| index.v[i as usize]));
            let padded = self.names.len().next_multiple_of(LANES);
            self.names.resize(padded, u32::MAX);
            self.u.resize(padded, NOWHERE);
            self.v.resize(padded, NOWHERE);
        }
    }

    /// Runs of whole blocks that hold all points of `class` inside `window`, and others of that class nearby.
    /// Ascending, each as the range of its points.
    #[inline(always)]
    pub fn runs(&self, class: u8, window: Window) -> impl Iterator<Item = Range<usize>> + '_ {
        let (first, last) = (window.u.0.max(0) as usize >> COLUMN_LOG2, window.u.1.max(-1));
        let last = if last < 0 { 0 } else { (last as usize >> COLUMN_LOG2).min(self.columns - 1) + 1 };
        let strips = if window.v.1 < 0 { 0 } else { (window.v.1 as usize >> STRIP_LOG2).min(self.strips - 1) + 1 };
        let top = window.v.0.max(0) as usize >> STRIP_LOG2;
        let starts =
            move |strip: usize| &self.starts[(usize::from(class) * self.strips + strip) * (self.columns + 1)..];
        (top..strips).filter(move |_| first < last).map(move |strip| {
            let (from, to) = (starts(strip)[first] as usize, starts(strip)[last] as usize);
            if from == to { from..from } else { from / LANES * LANES..to.next_multiple_of(LANES) }
        })
    }
}
