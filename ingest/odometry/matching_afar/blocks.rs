//! The layout behind wide windows: by class and rows of the image, in blocks of sixteen points whose bytes lie as they are compared.

use crate::features::CLASSES;
use crate::index::{Index, Window};
use std::ops::Range;

/// Points of a block: as many as 16-bit distances fit a register of AVX2.
pub(super) const LANES: usize = 16;
/// Bytes whose differences one instruction sums up.
pub(super) const SUMMED: usize = 8;
/// Bytes of a register.
pub(super) const REGISTER: usize = 32;
/// A strip of the image has 32 rows: where a window holds half the image, the runs of points in it are long.
const STRIP_LOG2: u32 = 5;
/// Points of a strip are found by columns of 16.
const COLUMN_LOG2: u32 = 4;
/// Place of what fills up a strip's last block: outside of every window.
const NOWHERE: i16 = i16::MIN;

/// Points with descriptors of `N` bytes.
#[derive(Debug, Clone)]
pub(crate) struct Blocks<const N: usize> {
    /// Column of each point, matching px.
    pub u: Vec<i16>,
    /// Row of each point, matching px.
    pub v: Vec<i16>,
    /// The index that each point has in the layout it was taken from.
    pub names: Vec<u32>,
    /// A block has four groups of N / 8 registers. Of a group's points, 4 c + g for group g, register k holds bytes 8 k to 8 k + 7, point by
    /// point: so the sums over a register's parts add up to the distances of four points, and four groups shifted into each other are those
    /// of sixteen in order.
    pub bytes: Vec<u8>,
    strips: usize,
    columns: usize,
    /// Where each (class, strip, column) begins; a strip's own end behind its last column.
    starts: Vec<u32>,
}

impl<const N: usize> Blocks<N> {
    /// Bytes of a block.
    pub const BLOCK: usize = LANES * N;

    /// The points of an image of `size` columns and rows.
    pub fn of(index: &Index<N>, (width, height): (usize, usize)) -> Self {
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
        for of in 0..CLASSES * strips {
            let (here, others) = rest.split_at(rest.partition_point(|&i| strip(i) == of));
            rest = others;
            for at in 0..=columns {
                let before = here.partition_point(|&i| column(i) < at);
                blocks.starts[of * (columns + 1) + at] = (blocks.names.len() + before) as u32;
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
            let whole = self.names.len().next_multiple_of(LANES);
            self.names.resize(whole, u32::MAX);
            self.u.resize(whole, NOWHERE);
            self.v.resize(whole, NOWHERE);
        }
    }

    /// Runs of whole blocks that hold all points of `class` inside `window`, and others nearby of the same class; ascending, by their first
    /// and last points.
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
