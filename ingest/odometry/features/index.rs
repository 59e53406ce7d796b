//! An index of described points for window search: sorted by class, then by bins of the image, each row of bins
//! contiguous.

use std::ops::Range;

/// Blob maxima, blob minima, corner maxima, corner minima: only features of one class are compared.
pub(super) const CLASSES: usize = 4;

/// A bin has 16 columns.
const BIN_COLUMNS_LOG2: u32 = 4;
/// A bin has 4 rows: the stereo search runs along rows.
const BIN_ROWS_LOG2: u32 = 2;

/// Points of a matching image with descriptors of `N` bytes.
#[derive(Debug, Clone)]
pub(crate) struct Index<const N: usize> {
    /// Column of each point, matching px.
    pub u: Vec<i16>,
    /// Row of each point, matching px.
    pub v: Vec<i16>,
    /// Class of each point.
    pub class: Vec<u8>,
    /// Sobel bytes around each point.
    pub descriptors: Vec<[u8; N]>,
    bin_columns: usize,
    bin_rows: usize,
    /// Where each (class, bin row, bin column) begins; one more at the end.
    starts: Vec<u32>,
}

/// A search window in matching px, bounds included: (least, greatest) column and row.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Window {
    pub u: (i32, i32),
    pub v: (i32, i32),
}

impl Window {
    /// The window that reaches `du` columns and `dv` rows to each side of (u, v).
    pub fn around(u: i32, v: i32, du: i32, dv: i32) -> Self {
        Self { u: (u - du, u + du), v: (v - dv, v + dv) }
    }
}

/// The order that [`Index::new`] expects for an image of `width` columns and `height` rows, as a permutation of the
/// points (class, u, v). Points of one bin keep their order.
pub(crate) fn bin_order(points: &[(u8, i16, i16)], width: usize, height: usize) -> Vec<u32> {
    let count = bin_counts(width, height);
    let mut order: Vec<u32> = (0..points.len() as u32).collect();
    order.sort_by_key(|&i| bin(points[i as usize], count));
    order
}

/// Columns and rows of bins.
fn bin_counts(width: usize, height: usize) -> (usize, usize) {
    ((width >> BIN_COLUMNS_LOG2) + 1, (height >> BIN_ROWS_LOG2) + 1)
}

/// The number of a point's bin.
fn bin((class, u, v): (u8, i16, i16), (columns, rows): (usize, usize)) -> usize {
    (usize::from(class) * rows + (v as usize >> BIN_ROWS_LOG2)) * columns + (u as usize >> BIN_COLUMNS_LOG2)
}

impl<const N: usize> Index<N> {
    /// Indexes points that are in [`bin_order`].
    pub fn new(points: &[(u8, i16, i16)], descriptors: Vec<[u8; N]>, width: usize, height: usize) -> Self {
        let (bin_columns, bin_rows) = bin_counts(width, height);
        let mut starts = vec![0; CLASSES * bin_columns * bin_rows + 1];
        for point in points {
            starts[bin(*point, (bin_columns, bin_rows)) + 1] += 1;
        }
        let mut total = 0;
        for start in &mut starts {
            total += *start;
            *start = total;
        }
        Self {
            u: points.iter().map(|p| p.1).collect(),
            v: points.iter().map(|p| p.2).collect(),
            class: points.iter().map(|p| p.0).collect(),
            descriptors,
            bin_columns,
            bin_rows,
            starts,
        }
    }

    /// The points with the given indices, ascending, of the same image.
    pub fn subset(&self, indices: &[u32], (width, height): (usize, usize)) -> Self {
        let indices = || indices.iter().map(|&i| i as usize);
        let points: Vec<_> = indices().map(|i| (self.class[i], self.u[i], self.v[i])).collect();
        Self::new(&points, indices().map(|i| self.descriptors[i]).collect(), width, height)
    }

    /// The number of points.
    pub fn len(&self) -> usize {
        self.class.len()
    }

    /// Calls `visit` with the index of every point of `class` inside `window`, ascending.
    #[inline(always)]
    pub fn for_each_in(&self, class: u8, window: Window, mut visit: impl FnMut(usize)) {
        self.for_each_run(class, window, |run| {
            for i in run {
                let (u, v) = (i32::from(self.u[i]), i32::from(self.v[i]));
                if (u >= window.u.0) & (u <= window.u.1) & (v >= window.v.0) & (v <= window.v.1) {
                    visit(i);
                }
            }
        });
    }

    /// Calls `visit` with runs of points of `class` that hold all points inside `window` and others nearby. Indices
    /// ascend.
    #[inline(always)]
    pub fn for_each_run(&self, class: u8, window: Window, mut visit: impl FnMut(Range<usize>)) {
        let (u0, u1) = (window.u.0.max(0), window.u.1);
        let (v0, v1) = (window.v.0.max(0), window.v.1);
        if u1 < u0 || v1 < v0 {
            return;
        }
        let first_column = u0 as usize >> BIN_COLUMNS_LOG2;
        let last_column = (u1 as usize >> BIN_COLUMNS_LOG2).min(self.bin_columns - 1);
        let last_row = (v1 as usize >> BIN_ROWS_LOG2).min(self.bin_rows - 1);
        if first_column > last_column {
            return;
        }
        for row in v0 as usize >> BIN_ROWS_LOG2..=last_row {
            let bins = (usize::from(class) * self.bin_rows + row) * self.bin_columns;
            visit(self.starts[bins + first_column] as usize..self.starts[bins + last_column + 1] as usize);
        }
    }
}
