//! Neighbour support: a match whose neighbours in the image moved otherwise is dropped (Geiger et al. 2011, III A).

use crate::params::SupportParams;

/// A match as its neighbours see it: place, flow and disparity in image px.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FlowSample {
    pub at_px: [f32; 2],
    pub flow_px: [f32; 2],
    pub disparity_px: f32,
}

/// For each sample whether enough of its nearest neighbours agree with it. Neighbours are looked for in the 3x3 cells around.
pub(crate) fn supported(samples: &[FlowSample], params: &SupportParams) -> Vec<bool> {
    let grid = Grid::new(samples);
    let mut nearest: Vec<(f32, usize)> = Vec::new();
    let agrees = |a: &FlowSample, b: &FlowSample| {
        (a.flow_px[0] - b.flow_px[0]).abs() <= params.flow_tolerance_px
            && (a.flow_px[1] - b.flow_px[1]).abs() <= params.flow_tolerance_px
            && (a.disparity_px - b.disparity_px).abs() <= params.disparity_tolerance_px
    };
    let check = |(i, sample): (usize, &FlowSample)| {
        nearest.clear();
        grid.for_each_near(sample, |j| {
            if j != i {
                let [du, dv] = [0, 1].map(|k| samples[j].at_px[k] - sample.at_px[k]);
                insert(&mut nearest, (du * du + dv * dv, j), params.neighbours);
            }
        });
        nearest.iter().filter(|&&(_, j)| agrees(sample, &samples[j])).count() >= params.supporters
    };
    samples.iter().enumerate().map(check).collect()
}

/// Puts `neighbour` into the ascending list of the `most` nearest.
fn insert(nearest: &mut Vec<(f32, usize)>, neighbour: (f32, usize), most: usize) {
    if nearest.len() >= most && nearest.last().is_none_or(|last| last.0 <= neighbour.0) {
        return;
    }
    let place = nearest.iter().rposition(|n| n.0 <= neighbour.0).map_or(0, |i| i + 1);
    nearest.insert(place, neighbour);
    nearest.truncate(most);
}

/// How many samples a cell should hold on average, so that 3x3 cells hold the nearest ones asked for.
const SAMPLES_PER_CELL: f32 = 4.0;
/// Smallest side of a cell.
const LEAST_CELL_PX: f32 = 8.0;

/// Samples by square cells.
struct Grid {
    side_px: f32,
    columns: usize,
    rows: usize,
    /// Where each cell begins in `members`; one more at the end.
    starts: Vec<u32>,
    members: Vec<u32>,
}

impl Grid {
    fn new(samples: &[FlowSample]) -> Self {
        let extent_px = |k: usize| samples.iter().fold(1.0_f32, |most, s| most.max(s.at_px[k]));
        let area = extent_px(0) * extent_px(1);
        let side_px = (area * SAMPLES_PER_CELL / samples.len().max(1) as f32).sqrt().max(LEAST_CELL_PX);
        let cells = |k: usize| cell(extent_px(k), side_px) + 1;
        let mut grid = Self { side_px, columns: cells(0), rows: cells(1), starts: Vec::new(), members: Vec::new() };
        let of: Vec<usize> = samples.iter().map(|s| grid.cell_of(s)).collect();
        grid.starts = vec![0; grid.columns * grid.rows + 1];
        of.iter().for_each(|&cell| grid.starts[cell + 1] += 1);
        for cell in 1..grid.starts.len() {
            grid.starts[cell] += grid.starts[cell - 1];
        }
        grid.members = (0..samples.len() as u32).collect();
        grid.members.sort_by_key(|&i| of[i as usize]);
        grid
    }

    fn cell_of(&self, sample: &FlowSample) -> usize {
        cell(sample.at_px[1], self.side_px) * self.columns + cell(sample.at_px[0], self.side_px)
    }

    fn for_each_near(&self, sample: &FlowSample, mut visit: impl FnMut(usize)) {
        let around = |at: usize, size: usize| (at.saturating_sub(1), (at + 2).min(size));
        let (first, last) = around(cell(sample.at_px[0], self.side_px), self.columns);
        let (top, bottom) = around(cell(sample.at_px[1], self.side_px), self.rows);
        for row in top..bottom {
            let cells = row * self.columns;
            let members = self.starts[cells + first] as usize..self.starts[cells + last] as usize;
            self.members[members].iter().for_each(|&i| visit(i as usize));
        }
    }
}

fn cell(px: f32, side_px: f32) -> usize {
    (px.max(0.0) / side_px) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_lone_dissenter_and_a_loner_are_dropped() {
        let sample = |u: f32, flow: f32| FlowSample { at_px: [u, 20.0], flow_px: [flow, 0.0], disparity_px: 8.0 };
        let samples = [sample(10.0, 3.0), sample(20.0, 4.0), sample(30.0, 3.5), sample(25.0, 60.0), sample(900.0, 3.0)];
        assert_eq!(supported(&samples, &SupportParams::default()), [true, true, true, false, false]);
        assert!(supported(&[], &SupportParams::default()).is_empty());
    }
}
