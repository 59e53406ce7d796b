//! 95 % bands of the curves, along one road.

use crate::evaluate::share;
use furrow_model::LostStretch;

/// The part of a traversal that is judged, as distances travelled in metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Span {
    pub(super) from_m: f64,
    pub(super) to_m: f64,
}

/// Resolution at which a road is looked at, metres.
pub(in crate::evaluate) const CELL_M: f64 = 0.1;

/// The bands of the three variants at one distance; `None` of too little road, and of lengths of lost stretches where
/// there is none.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Bands {
    pub survival: Option<[f64; 2]>,
    pub length_biased: Option<[f64; 2]>,
    pub per_gap: Option<[f64; 2]>,
}

/// A cell of the route.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Cell {
    /// Distance driven since the last localisation; 0 where not lost.
    pub since_m: f64,
    /// The length of the lost stretch that it lies in; 0 where not lost.
    inside_m: f64,
}

/// The bands at each distance of `grid`: the route is cut into cells, each knowing how lost the robot was there. Lost
/// stretches stand for themselves.
pub(super) fn bands(stretches: &[LostStretch], span: Span, grid: &[f64]) -> Vec<Bands> {
    let cells = cells(stretches, span);
    let road_m = (span.to_m - span.from_m).round().max(0.0) as usize;
    let share = |of: fn(&Cell) -> f64, distance_m: f64| {
        let mut metres = vec![0.0; road_m];
        for (i, _) in cells.iter().enumerate().filter(|(_, cell)| of(cell) > distance_m) {
            let metre = ((i as f64 + 0.5) * CELL_M) as usize;
            if let Some(metre) = metres.get_mut(metre.min(road_m.saturating_sub(1))) {
                *metre += 1.0 / cells.len() as f64;
            }
        }
        share::interval(&metres)
    };
    let bands = |distance_m: &f64| {
        let longer = stretches.iter().filter(|stretch| stretch.length_m() > *distance_m).count();
        let gaps = longer as f64 / stretches.len().max(1) as f64;
        Bands {
            survival: share(|cell| cell.since_m, *distance_m),
            length_biased: share(|cell| cell.inside_m, *distance_m),
            per_gap: share::of_things(gaps, stretches.len(), road_m),
        }
    };
    grid.iter().map(bands).collect()
}

pub(super) fn cells(stretches: &[LostStretch], span: Span) -> Vec<Cell> {
    let count = ((span.to_m - span.from_m) / CELL_M).round() as usize;
    let cell = |cell: usize| {
        let here_m = span.from_m + (cell as f64 + 0.5) * CELL_M;
        let inside = stretches.iter().find(|stretch| stretch.from_m < here_m && here_m < stretch.to_m);
        inside
            .map_or(Cell::default(), |stretch| Cell { since_m: here_m - stretch.from_m, inside_m: stretch.length_m() })
    };
    (0..count).map(cell).collect()
}
