//! The circular moving-block bootstrap (Kunsch 1989): what lies side by side on a route is alike, so blocks are drawn,
//! not single places.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;
use std::iter::Sum;
use std::ops::{Add, Sub};

/// Bootstrap replicates.
pub(super) const REPLICATES: usize = 400;

/// A series put together anew, many times, from blocks of itself that begin anywhere.
pub(super) struct Blocks {
    series: usize,
    block: usize,
    per_replicate: usize,
    starts: Vec<usize>,
}

impl Blocks {
    /// For a series of `series` places, at least one, in blocks of `block`. Blocks go on at the start after the end
    /// (Politis and Romano 1992): the ends of a route then count as much as its middle, and replicates lie about the
    /// sum itself.
    pub fn draw(series: usize, block: usize, seed: u64) -> Self {
        let block = block.clamp(1, series);
        let per_replicate = series.div_ceil(block);
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let starts = (0..REPLICATES * per_replicate).map(|_| random.random_range(0..series)).collect();
        Self { series, block, per_replicate, starts }
    }

    /// Places in a replicate.
    pub fn cells(&self) -> usize {
        self.per_replicate * self.block
    }

    /// The sum of `value` over the places of each replicate.
    pub fn sums<T>(&self, value: impl Fn(usize) -> T) -> Vec<T>
    where
        T: Copy + Default + Add<Output = T> + Sub<Output = T> + Sum,
    {
        let places = self.series + self.block;
        let mut before = vec![T::default(); places + 1];
        for place in 0..places {
            before[place + 1] = before[place] + value(place % self.series);
        }
        let in_block = |start: &usize| before[start + self.block] - before[*start];
        self.starts.chunks(self.per_replicate).map(|replicate| replicate.iter().map(in_block).sum()).collect()
    }
}

/// The ends of the middle 95 % of some replicates; `None` of none.
pub(super) fn percentiles(mut replicates: Vec<f64>) -> Option<[f64; 2]> {
    replicates.sort_by(f64::total_cmp);
    let tail = replicates.len() / 40;
    Some([*replicates.get(tail)?, *replicates.get(replicates.len() - 1 - tail)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where places are independent and blocks single, the interval is the binomial one.
    #[test]
    fn single_blocks_give_the_binomial_interval() {
        let blocks = Blocks::draw(400, 1, 7);
        let sums = blocks.sums(|place| u32::from(place % 4 == 0));
        let [low, high] = percentiles(sums.into_iter().map(f64::from).collect()).unwrap();
        // 100 of 400: a standard deviation of sqrt(400 / 4 * 3 / 4) = 8.7, so 83 to 117.
        assert!((78.0..=88.0).contains(&low) && (112.0..=122.0).contains(&high), "{low} to {high}");
    }

    /// A series that is full in the middle and one that is full at its ends: replicates lie about both sums.
    #[test]
    fn the_ends_count_as_much_as_the_middle() {
        let mean = |value: &dyn Fn(usize) -> bool| {
            let sums = Blocks::draw(400, 100, 7).sums(|place| u32::from(value(place)));
            f64::from(sums.iter().sum::<u32>()) / sums.len() as f64
        };
        let middle = |place: usize| (150..250).contains(&place);
        let (middle, ends) = (mean(&middle), mean(&|place| !middle(place)));
        assert!((middle - 100.0).abs() < 10.0 && (ends - 300.0).abs() < 10.0, "{middle} of 100, {ends} of 300");
    }

    /// A series of long runs is known far worse than its length says.
    #[test]
    fn blocks_as_long_as_runs_widen_the_interval() {
        let width = |block| {
            let sums = Blocks::draw(400, block, 7).sums(|place| u32::from(place / 50 % 2 == 0));
            percentiles(sums.into_iter().map(f64::from).collect()).map(|[low, high]| high - low).unwrap()
        };
        assert!(width(50) > 3.0 * width(1), "{} against {}", width(50), width(1));
        assert_eq!(percentiles(Vec::new()), None);
    }
}
