//! The parts of the image: on a ground robot, where a pixel lies tells much of whether it is sky, canopy or ground.
//!
//! Cell (i, j) has its centre at column (i + 0.5) W / 8 and row (j + 0.5) H / 5; weights fall linearly from centre to
//! centre and go on as they are beyond the outermost centres. The weights of a pixel sum to 1.

use std::ops::Range;

/// Cells along the width.
pub const COLUMNS: usize = 8;
/// Cells along the height.
pub const ROWS: usize = 5;
/// Cells in all, row by row.
pub const CELLS: usize = COLUMNS * ROWS;

/// Where a pixel lies between two centres: the first of them, and how far towards the next, 0 to 1.
pub fn between(pixel: usize, pixels: usize, cells: usize) -> (usize, f32) {
    let place = ((pixel as f64 + 0.5) * cells as f64 / pixels as f64 - 0.5).clamp(0.0, (cells - 1) as f64);
    let first = (place as usize).min(cells - 2);
    (first, (place - first as f64) as f32)
}

/// The columns of an image, cut into stretches that lie between the same two centres.
#[derive(Debug, Clone, Default, PartialEq)]
pub(crate) struct Stretches {
    /// The columns of each stretch and its left cell.
    pub stretches: Vec<(Range<usize>, usize)>,
    /// For each column, how far it is from the left centre to the right one.
    pub share: Vec<f32>,
    width: usize,
}

impl Stretches {
    /// For images of `width` columns; made anew only where the width differs.
    pub fn fit(&mut self, width: usize) {
        if self.width == width {
            return;
        }
        let places: Vec<(usize, f32)> = (0..width).map(|x| between(x, width, COLUMNS)).collect();
        self.share = places.iter().map(|place| place.1).collect();
        self.stretches = (0..COLUMNS - 1)
            .map(|cell| {
                let first = places.partition_point(|place| place.0 < cell);
                (first..places.partition_point(|place| place.0 <= cell), cell)
            })
            .filter(|(columns, _)| !columns.is_empty())
            .collect();
        self.width = width;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn centres_belong_to_their_cells_and_edges_to_the_outermost() {
        // 16 columns per cell of 128: the centre of cell i lies between columns 16 i + 7 and 16 i + 8.
        for i in 0..COLUMNS - 1 {
            let (first, share) = between(16 * i + 8, 128, COLUMNS);
            assert!(first == i && share < 0.05, "{i}: {first} {share}");
        }
        assert_eq!(between(0, 128, COLUMNS), (0, 0.0));
        assert_eq!(between(127, 128, COLUMNS), (COLUMNS - 2, 1.0));
    }

    #[test]
    fn stretches_cover_every_column_once() {
        for width in [1, 5, 8, 97, 640] {
            let mut stretches = Stretches::default();
            stretches.fit(width);
            let columns: Vec<usize> = stretches.stretches.iter().flat_map(|(columns, _)| columns.clone()).collect();
            assert_eq!(columns, (0..width).collect::<Vec<_>>());
        }
    }
}
