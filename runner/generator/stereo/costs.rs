//! What a match costs: sums of absolute differences over a window, and the best of them.

use furrow_model::GreyImage;
use furrow_model::widest;

/// The window's half width and half height, in pixels of the small images.
pub(super) const WINDOW: [usize; 2] = [4, 3];

/// The best match of a pixel so far.
pub(super) struct Best {
    pub cost: Vec<u16>,
    pub at: Vec<u16>,
    /// The cost one disparity less, and one more.
    pub before: Vec<u16>,
    pub after: Vec<u16>,
}

/// The window's sums at one disparity.
pub(super) struct Costs {
    width: usize,
    pub sums: Vec<u16>,
    differences: Vec<u8>,
    columns: Vec<u16>,
}

impl Costs {
    pub fn of(count: usize, width: usize) -> Self {
        Self { width, sums: vec![0; count], differences: vec![0; count], columns: vec![0; width + 2 * WINDOW[0]] }
    }

    /// Pixels whose partner would lie outside the right image cost the most there is.
    pub fn fill(&mut self, left: &GreyImage, right: &GreyImage, d: usize) {
        let (width, height) = (self.width, self.differences.len() / self.width);
        for (y, differences) in self.differences.chunks_exact_mut(width).enumerate() {
            let (near, far) = differences.split_at_mut(d);
            near.fill(u8::MAX);
            differ(&left.row(y)[d..], &right.row(y)[..width - d], far);
        }
        let row = |y: isize| y.clamp(0, height as isize - 1) as usize * width;
        let (across, down) = (WINDOW[0], WINDOW[1] as isize);
        self.columns.fill(0);
        for y in -down..=down {
            add(&self.differences[row(y)..][..width], &mut self.columns[across..across + width]);
        }
        for y in 0..height {
            let (first, last) = (self.columns[across], self.columns[across + width - 1]);
            self.columns[..across].fill(first);
            self.columns[across + width..].fill(last);
            sum_row(&self.columns, &mut self.sums[y * width..(y + 1) * width]);
            let at = y as isize;
            let (gone, come) = (row(at - down), row(at + down + 1));
            let differences = &self.differences;
            slide(
                &differences[gone..gone + width],
                &differences[come..come + width],
                &mut self.columns[across..across + width],
            );
        }
    }
}

widest!(fn differ(left: &[u8], right: &[u8], out: &mut [u8]) -> () = differ_anywhere);
#[inline(always)]
fn differ_anywhere(left: &[u8], right: &[u8], out: &mut [u8]) {
    out.iter_mut().zip(left).zip(right).for_each(|((out, left), right)| *out = left.abs_diff(*right));
}

fn add(row: &[u8], columns: &mut [u16]) {
    columns.iter_mut().zip(row).for_each(|(sum, value)| *sum += u16::from(*value));
}

widest!(fn slide(gone: &[u8], come: &[u8], columns: &mut [u16]) -> () = slide_anywhere);
#[inline(always)]
fn slide_anywhere(gone: &[u8], come: &[u8], columns: &mut [u16]) {
    for ((sum, gone), come) in columns.iter_mut().zip(gone).zip(come) {
        *sum = *sum + u16::from(*come) - u16::from(*gone);
    }
}

widest!(fn sum_row(columns: &[u16], sums: &mut [u16]) -> () = sum_row_anywhere);
#[inline(always)]
fn sum_row_anywhere(columns: &[u16], sums: &mut [u16]) {
    sums.fill(0);
    let width = sums.len();
    for i in 0..=2 * WINDOW[0] {
        sums.iter_mut().zip(&columns[i..i + width]).for_each(|(sum, value)| *sum += value);
    }
}

/// Keeps what is better at disparity `d`, of a row that begins at `start`; `last` are its costs one disparity before.
pub(super) fn keep(costs: &[u16], last: &[u16], d: u16, best: &mut Best, start: usize) {
    let row = start..start + costs.len();
    keep_row(
        costs,
        last,
        d,
        (&mut best.cost[row.clone()], &mut best.at[row.clone()]),
        (&mut best.before[row.clone()], &mut best.after[row]),
    );
}

widest!(fn keep_row(costs: &[u16], last: &[u16], d: u16, best: (&mut [u16], &mut [u16]), around: (&mut [u16], &mut [u16])) -> () = keep_row_anywhere);
#[inline(always)]
fn keep_row_anywhere(
    costs: &[u16],
    last: &[u16],
    d: u16,
    best: (&mut [u16], &mut [u16]),
    around: (&mut [u16], &mut [u16]),
) {
    let pixels = best.0.iter_mut().zip(best.1).zip(around.0.iter_mut().zip(around.1));
    for ((cost, last), ((best, at), (before, after))) in costs.iter().zip(last).zip(pixels) {
        let better = *cost < *best;
        *after = if better {
            u16::MAX
        } else if *at + 1 == d {
            *cost
        } else {
            *after
        };
        *before = if better { *last } else { *before };
        *at = if better { d } else { *at };
        *best = if better { *cost } else { *best };
    }
}

/// The same for the right image's pixels, without their neighbours.
pub(super) fn keep_right(costs: &[u16], d: u16, best: &mut [u16], at: &mut [u16]) {
    keep_back(costs, d, best, at);
}

widest!(fn keep_back(costs: &[u16], d: u16, best: &mut [u16], at: &mut [u16]) -> () = keep_back_anywhere);
#[inline(always)]
fn keep_back_anywhere(costs: &[u16], d: u16, best: &mut [u16], at: &mut [u16]) {
    for ((cost, best), at) in costs.iter().zip(best).zip(at) {
        let better = *cost < *best;
        *at = if better { d } else { *at };
        *best = if better { *cost } else { *best };
    }
}
