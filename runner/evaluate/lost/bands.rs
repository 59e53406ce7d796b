//! 95 % bands of the curves by a moving-block bootstrap along the route.

use crate::evaluate::bootstrap::{Blocks, percentiles};
use furrow_model::LostStretch;

/// The part of a traversal that is judged, as distances travelled in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub(super) from_m: f64,
    pub(super) to_m: f64,
}

/// Blocks, metres.
const BLOCK_M: f64 = 10.0;
/// Resolution at which blocks are drawn, metres.
pub(in crate::evaluate) const CELL_M: f64 = 0.1;

/// A band at one distance.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Band {
    pub low: f64,
    pub high: f64,
}

/// The bands of the three variants at one distance.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bands {
    pub survival: Band,
    pub length_biased: Band,
    pub per_gap: Band,
}

/// A cell of the route.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cell {
    /// Distance driven since the last localisation; 0 where not lost.
    pub since_m: f64,
    /// The length of the lost stretch that it lies in; 0 where not lost.
    inside_m: f64,
    /// The length of the stretch that begins in it; 0 where none does.
    begins_m: f64,
}

/// The bands at each distance of `grid`: the route is cut into cells, each knowing how lost the robot was there, and
/// put together anew from blocks of 10 m that begin anywhere.
pub(super) fn bands(stretches: &[LostStretch], span: Span, grid: &[f64], seed: u64) -> Vec<Bands> {
    let cells = cells(stretches, span);
    if cells.is_empty() {
        return vec![Bands::default(); grid.len()];
    }
    let blocks = Blocks::draw(cells.len(), (BLOCK_M / CELL_M) as usize, seed);
    let gaps = blocks.sums(|cell| u32::from(cells[cell].begins_m > 0.0));
    grid.iter()
        .map(|&distance_m| {
            let share = |of: fn(&Cell) -> f64| {
                let longer = blocks.sums(|cell| u32::from(of(&cells[cell]) > distance_m));
                band(longer.into_iter().map(|cells| f64::from(cells) / blocks.cells() as f64).collect())
            };
            let long_gaps = blocks.sums(|cell| u32::from(cells[cell].begins_m > distance_m));
            // A replicate without any lost stretch says nothing about their lengths.
            let per_gap = long_gaps.iter().zip(&gaps).filter(|(_, gaps)| **gaps > 0);
            Bands {
                survival: share(|cell| cell.since_m),
                length_biased: share(|cell| cell.inside_m),
                per_gap: band(per_gap.map(|(long, gaps)| f64::from(*long) / f64::from(*gaps)).collect()),
            }
        })
        .collect()
}

pub(super) fn cells(stretches: &[LostStretch], span: Span) -> Vec<Cell> {
    let count = ((span.to_m - span.from_m) / CELL_M).round() as usize;
    let mut cells: Vec<Cell> = (0..count)
        .map(|cell| {
            let here_m = span.from_m + (cell as f64 + 0.5) * CELL_M;
            let inside = stretches.iter().find(|stretch| stretch.from_m < here_m && here_m < stretch.to_m);
            inside.map_or(Cell::default(), |stretch| Cell {
                since_m: here_m - stretch.from_m,
                inside_m: stretch.length_m(),
                begins_m: 0.0,
            })
        })
        .collect();
    for stretch in stretches.iter().filter(|_| count > 0) {
        let cell = (((stretch.from_m - span.from_m) / CELL_M) as usize).min(count - 1);
        cells[cell].begins_m = cells[cell].begins_m.max(stretch.length_m());
    }
    cells
}

/// The middle 95 % of the replicates; empty, nothing is known, and the band is the value itself.
fn band(replicates: Vec<f64>) -> Band {
    percentiles(replicates)
        .map_or(Band { low: f64::INFINITY, high: f64::NEG_INFINITY }, |[low, high]| Band { low, high })
}
