//! Outlier removal by neighbours: a match is dropped if too few matches near it have a similar flow and disparity
//! (Geiger et al. 2011, section III-A, where neighbours are those of a Delaunay triangulation).

use crate::params::SupportParams;

/// What is compared of a match: place, flow and disparity in image px.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FlowSample {
    pub at_px: [f32; 2],
    pub flow_px: [f32; 2],
    pub disparity_px: f32,
}

/// For each sample whether at least `supporters` of its `neighbours` nearest samples agree with it. Neighbours are
/// searched in the 3x3 cells around it. Of equally near samples all count as nearest.
pub(crate) fn find_supported(samples: &[FlowSample], params: &SupportParams) -> Vec<bool> {
    let grid = Grid::new(samples);
    let mut keep = vec![false; samples.len()];
    let mut scratch = Scratch::default();
    for (place, &member) in grid.members.iter().enumerate() {
        keep[member as usize] = grid.is_supported(place, params, &mut scratch);
    }
    keep
}

/// Work buffers of one sample.
#[derive(Default)]
struct Scratch {
    /// Squared distances of the samples around it.
    distances: Vec<f32>,
    /// The same, but infinite for those that do not agree, so that a selection of the nearest finds agreeing ones.
    agreeing: Vec<f32>,
}

/// Samples per cell on average, so that 3x3 cells hold the nearest ones.
const SAMPLES_PER_CELL: f32 = 4.0;
/// Smallest side of a cell.
const LEAST_CELL_PX: f32 = 8.0;

/// Samples sorted by square cells, in structure-of-arrays layout, so that many are compared at once.
struct Grid {
    side_px: f32,
    columns: usize,
    rows: usize,
    /// Where each cell begins in `members`; one more at the end.
    starts: Vec<u32>,
    members: Vec<u32>,
    /// Of each member: column, row, flow along columns and rows, disparity.
    lanes: [Vec<f32>; 5],
}

impl Grid {
    fn new(samples: &[FlowSample]) -> Self {
        let extent_px = |k: usize| samples.iter().fold(1.0_f32, |most, s| most.max(s.at_px[k]));
        let area = extent_px(0) * extent_px(1);
        let side_px = (area * SAMPLES_PER_CELL / samples.len().max(1) as f32).sqrt().max(LEAST_CELL_PX);
        let [columns, rows] = [0, 1].map(|k| cell(extent_px(k), side_px) + 1);
        let cells: Vec<usize> =
            samples.iter().map(|s| cell(s.at_px[1], side_px) * columns + cell(s.at_px[0], side_px)).collect();
        let mut starts = vec![0; columns * rows + 1];
        cells.iter().for_each(|&cell| starts[cell + 1] += 1);
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut members: Vec<u32> = (0..samples.len() as u32).collect();
        members.sort_by_key(|&i| cells[i as usize]);
        let lane = |field: fn(&FlowSample) -> f32| members.iter().map(|&i| field(&samples[i as usize])).collect();
        let lanes = [
            lane(|s| s.at_px[0]),
            lane(|s| s.at_px[1]),
            lane(|s| s.flow_px[0]),
            lane(|s| s.flow_px[1]),
            lane(|s| s.disparity_px),
        ];
        Self { side_px, columns, rows, starts, members, lanes }
    }

    /// The members of the 3x3 cells around (u, v): one run of members for each row of cells.
    fn around(&self, u_px: f32, v_px: f32) -> impl Iterator<Item = std::ops::Range<usize>> + '_ {
        let reach = |at: usize, size: usize| (at.saturating_sub(1), (at + 2).min(size));
        let (first, last) = reach(cell(u_px, self.side_px), self.columns);
        let (top, bottom) = reach(cell(v_px, self.side_px), self.rows);
        (top..bottom).map(move |row| {
            let cells = row * self.columns;
            self.starts[cells + first] as usize..self.starts[cells + last] as usize
        })
    }

    /// Whether the member at `place` is supported. It is itself the nearest of its neighbours and of its supporters.
    fn is_supported(&self, place: usize, params: &SupportParams, scratch: &mut Scratch) -> bool {
        let [u, v, flow_u, flow_v, disparity] = [0, 1, 2, 3, 4].map(|k| self.lanes[k][place]);
        let (flow_tolerance, disparity_tolerance) = (params.flow_tolerance_px, params.disparity_tolerance_px);
        scratch.distances.clear();
        scratch.agreeing.clear();
        for run in self.around(u, v) {
            let [us, vs, flows_u, flows_v, disparities] = [0, 1, 2, 3, 4].map(|k| &self.lanes[k][run.clone()]);
            let from = scratch.distances.len();
            scratch.distances.extend(us.iter().zip(vs).map(|(a, b)| (a - u) * (a - u) + (b - v) * (b - v)));
            let others = scratch.distances[from..].iter().zip(flows_u).zip(flows_v).zip(disparities);
            scratch.agreeing.extend(others.map(|(((distance, a), b), c)| {
                let flow = (a - flow_u).abs().max((b - flow_v).abs());
                let agrees = (flow <= flow_tolerance) & ((c - disparity).abs() <= disparity_tolerance);
                if agrees { *distance } else { f32::INFINITY }
            }));
        }
        if scratch.agreeing.len() <= params.supporters {
            return false;
        }
        // The distance of the last supporter that is needed, and how many samples are nearer.
        let last = *scratch.agreeing.select_nth_unstable_by(params.supporters, f32::total_cmp).1;
        let nearer: usize = scratch.distances.iter().map(|&distance| usize::from(distance < last)).sum();
        last < f32::INFINITY && nearer <= params.neighbours
    }
}

fn cell(px: f32, side_px: f32) -> usize {
    (px.max(0.0) / side_px) as usize
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::test_support::uniform;
    use rand::SeedableRng;
    use rand_chacha::ChaCha8Rng;

    #[test]
    fn support_equals_brute_force() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let mut below = |most: f64| uniform(&mut rng, 0.0, most) as f32;
        // Dense enough for the eight nearest to lie within the 3x3 cells.
        let samples: Vec<FlowSample> = (0..600)
            .map(|_| FlowSample {
                at_px: [below(300.0), below(200.0)],
                flow_px: [below(12.0), below(9.0)],
                disparity_px: below(9.0),
            })
            .collect();
        let params = SupportParams::default();
        let agree = |a: f32, b: f32| (a - b).abs() <= 5.0;
        let found = find_supported(&samples, &params);
        let brute = |i: usize| {
            let here = &samples[i];
            let mut others: Vec<(f32, usize)> = (0..samples.len())
                .filter(|&j| j != i)
                .map(|j| ((0..2).map(|k| (samples[j].at_px[k] - here.at_px[k]).powi(2)).sum(), j))
                .collect();
            others.sort_by(|a, b| a.0.total_cmp(&b.0));
            let agrees = |&&(_, j): &&(f32, usize)| {
                let there = &samples[j];
                (0..2).all(|k| agree(here.flow_px[k], there.flow_px[k])) && agree(here.disparity_px, there.disparity_px)
            };
            others[..8].iter().filter(agrees).count() >= 2
        };
        let expected: Vec<bool> = (0..samples.len()).map(brute).collect();
        let different = (0..samples.len()).filter(|&i| found[i] != expected[i]).count();
        assert!(expected.iter().any(|&kept| kept) && expected.iter().any(|&kept| !kept));
        // At the border of the 3x3 cells a farther sample may be taken for the eighth.
        assert!(different <= 6, "{different} of 600 differ");
    }

    #[test]
    fn a_sample_with_another_flow_and_one_without_neighbours_are_dropped() {
        let sample = |u: f32, flow: f32| FlowSample { at_px: [u, 20.0], flow_px: [flow, 0.0], disparity_px: 8.0 };
        let samples = [sample(10.0, 3.0), sample(20.0, 4.0), sample(30.0, 3.5), sample(25.0, 60.0), sample(900.0, 3.0)];
        assert_eq!(find_supported(&samples, &SupportParams::default()), [true, true, true, false, false]);
        assert!(find_supported(&[], &SupportParams::default()).is_empty());
    }
}
