//! Reduction of a square window to a patch of 21 x 21 by area, each patch value a whole grey level.

/// Pixels along a side of the patch: 20 gradients lie between them.
pub(super) const PATCH_SIDE: usize = 21;
/// Rows of the window that are worked on side by side.
pub(super) const LANES: usize = 8;

/// Grey levels of the reduced window.
pub(super) type Patch = [[f32; PATCH_SIDE]; PATCH_SIDE];

/// Parts of a window's rows (or columns), one pixel each, that fall into the patch's cells, in order.
pub(super) struct Shares {
    shares: Vec<Share>,
    /// Window pixels per patch pixel where that is a whole number: then all pixels of a cell count alike.
    whole_ratio: Option<usize>,
}

/// One pixel's part in the cell at hand, and in the next one where it lies on the border.
#[derive(Clone, Copy)]
struct Share {
    this_cell: f32,
    next_cell: f32,
    ends_cell: bool,
}

/// Overlaps below this part of a pixel are not counted (OpenCV's INTER_AREA).
const LEAST_OVERLAP: f64 = 1e-3;

impl Shares {
    /// For windows of `side` >= 21 pixels.
    pub fn new(side: usize) -> Self {
        if side.is_multiple_of(PATCH_SIDE) {
            let ratio = side / PATCH_SIDE;
            let share = |i: usize| Share { this_cell: 1.0, next_cell: 0.0, ends_cell: (i + 1).is_multiple_of(ratio) };
            return Self { shares: (0..side).map(share).collect(), whole_ratio: Some(ratio) };
        }
        let ratio = 1.0 / (PATCH_SIDE as f64 / side as f64);
        let mut shares: Vec<Share> = Vec::with_capacity(side);
        for cell in 0..PATCH_SIDE {
            if let Some(last) = shares.last_mut() {
                last.ends_cell = true;
            }
            let start = cell as f64 * ratio;
            let end = start + ratio;
            let extent = ratio.min(side as f64 - start);
            let last_whole = (end.floor() as usize).min(side - 1);
            let first_whole = (start.ceil() as usize).min(last_whole);
            let before = first_whole as f64 - start;
            if before > LEAST_OVERLAP {
                let part = (before / extent) as f32;
                match shares.get_mut(first_whole - 1) {
                    Some(shared) => shared.next_cell = part,
                    None => shares.push(Share { this_cell: part, next_cell: 0.0, ends_cell: false }),
                }
            }
            let whole = Share { this_cell: (1.0 / extent) as f32, next_cell: 0.0, ends_cell: false };
            shares.resize(last_whole.max(shares.len()), whole);
            let after = end - last_whole as f64;
            if after > LEAST_OVERLAP {
                let part = (after.min(1.0).min(extent) / extent) as f32;
                shares.push(Share { this_cell: part, next_cell: 0.0, ends_cell: false });
            }
        }
        if let Some(last) = shares.last_mut() {
            last.ends_cell = true;
        }
        Self { shares, whole_ratio: None }
    }

    /// The whole grey level of a cell's sum: halves up for 2 x 2 pixels, else to even (OpenCV's INTER_AREA).
    #[inline(always)]
    fn grey(&self, sum: f32) -> f32 {
        match self.whole_ratio {
            Some(2) => ((sum + 2.0) * 0.25).floor(),
            Some(ratio) => (sum * (1.0 / (ratio * ratio) as f32)).round_ties_even(),
            None => sum.round_ties_even().min(255.0),
        }
    }
}

/// Eight rows of a window, read column by column.
pub(super) trait Columns {
    /// The next column: whole grey levels of the eight rows.
    fn next_column(&mut self) -> [f32; LANES];
}

/// Reduces the window whose rows `first_row..first_row + 8` are `rows(first_row)`; rows past the window are not looked
/// at. Columns are added up first, then rows, each in its order.
#[inline(always)]
pub(super) fn reduce<C: Columns>(shares: &Shares, rows: impl Fn(usize) -> C) -> Patch {
    let mut patch = [[0.0; PATCH_SIDE]; PATCH_SIDE];
    let mut cell_row = 0;
    let mut sums = [0.0_f32; PATCH_SIDE];
    for first_row in (0..shares.shares.len()).step_by(LANES) {
        let block = reduce_columns(shares, rows(first_row));
        for (lane, share) in shares.shares[first_row..].iter().take(LANES).enumerate() {
            for (sum, column) in sums.iter_mut().zip(&block) {
                *sum += share.this_cell * column[lane];
            }
            if share.ends_cell {
                if let Some(row) = patch.get_mut(cell_row) {
                    for (grey, &sum) in row.iter_mut().zip(&sums) {
                        *grey = shares.grey(sum);
                    }
                }
                cell_row += 1;
                sums = std::array::from_fn(|i| share.next_cell * block[i][lane]);
            }
        }
    }
    patch
}

#[inline(always)]
fn reduce_columns<C: Columns>(shares: &Shares, mut rows: C) -> [[f32; LANES]; PATCH_SIDE] {
    let mut block = [[0.0; LANES]; PATCH_SIDE];
    let mut cells = block.iter_mut();
    let mut sums = [0.0_f32; LANES];
    for share in &shares.shares {
        let greys = rows.next_column();
        for (sum, grey) in sums.iter_mut().zip(greys) {
            *sum += grey * share.this_cell;
        }
        if share.ends_cell {
            if let Some(cell) = cells.next() {
                *cell = sums;
            }
            sums = greys.map(|grey| grey * share.next_cell);
        }
    }
    block
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Eight rows of a window given by a function of its column and row.
    struct Rows<F>(F, usize, usize);

    impl<F: Fn(usize, usize) -> f32> Columns for Rows<F> {
        fn next_column(&mut self) -> [f32; LANES] {
            self.1 += 1;
            std::array::from_fn(|lane| (self.0)(self.1 - 1, self.2 + lane))
        }
    }

    /// Mean grey over a cell's area, pixel by overlapping pixel.
    fn mean(side: usize, cell: [usize; 2], grey: impl Fn(usize, usize) -> f32) -> f64 {
        let ratio = side as f64 / PATCH_SIDE as f64;
        let overlap = |pixel: usize, cell: usize| {
            let (start, end) = (cell as f64 * ratio, (cell + 1) as f64 * ratio);
            (end.min(pixel as f64 + 1.0) - start.max(pixel as f64)).max(0.0)
        };
        let pixels = (0..side).flat_map(|x| (0..side).map(move |y| (x, y)));
        pixels.map(|(x, y)| overlap(x, cell[0]) * overlap(y, cell[1]) * f64::from(grey(x, y))).sum::<f64>()
            / (ratio * ratio)
    }

    #[test]
    fn cells_are_area_means() {
        let grey = |x: usize, y: usize| ((x * 31 + y * 17 + x * y) % 256) as f32;
        for side in [21, 22, 25, 30, 41, 42, 63, 64, 84, 100, 157] {
            let patch = reduce(&Shares::new(side), |row| Rows(grey, 0, row));
            for (y, row) in patch.iter().enumerate() {
                for (x, &value) in row.iter().enumerate() {
                    let want = mean(side, [x, y], grey);
                    assert!((f64::from(value) - want).abs() < 0.501, "side {side} at ({x}, {y}): {value} {want}");
                }
            }
        }
    }
}
