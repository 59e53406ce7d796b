//! Random samples for RANSAC, and how many of them are needed.

use rand::Rng;

/// An index below `count`.
fn draw_index(rng: &mut impl Rng, count: usize) -> usize {
    ((u64::from(rng.next_u32()) * count as u64) >> 32) as usize
}

/// Three different indices below `count`, which is at least three.
pub(crate) fn draw_triple(rng: &mut impl Rng, count: usize) -> [usize; 3] {
    // All three are drawn before the first comparison. Another order would give other samples.
    let mut triple = [draw_index(rng, count), draw_index(rng, count), draw_index(rng, count)];
    while triple[1] == triple[0] {
        triple[1] = draw_index(rng, count);
    }
    while triple[2] == triple[0] || triple[2] == triple[1] {
        triple[2] = draw_index(rng, count);
    }
    triple
}

/// `SIZE` different indices below `count`, which is at least `SIZE`.
pub(crate) fn draw_sample<const SIZE: usize>(rng: &mut impl Rng, count: usize) -> [usize; SIZE] {
    let mut sample = [0; SIZE];
    for i in 0..SIZE {
        sample[i] = loop {
            let index = draw_index(rng, count);
            if !sample[..i].contains(&index) {
                break index;
            }
        };
    }
    sample
}

/// Most iterations that [`iterations_needed`] asks for.
const MOST_ITERATIONS: u32 = 100_000;

/// How many samples of `size` are needed until one of them is free of outliers with probability `confidence`, if
/// `inliers` of `count` are inliers: log(1 - confidence) / log(1 - share^size) (Hartley and Zisserman 2004, Eq. 4.18).
pub(crate) fn iterations_needed(size: usize, inliers: usize, count: usize, confidence: f64) -> u32 {
    let share = inliers as f64 / count as f64;
    let miss = 1.0 - (0..size).map(|_| share).product::<f64>();
    // Repeated multiplication in place of logarithms, whose bits differ between machines.
    let (mut chance, mut iterations) = (1.0, 0);
    while chance > 1.0 - confidence && iterations < MOST_ITERATIONS {
        chance *= miss;
        iterations += 1;
    }
    iterations
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn iterations_follow_the_textbook_formula() {
        // log(1 - 0.99) / log(1 - 0.5^3) = 34.5
        assert_eq!(iterations_needed(3, 50, 100, 0.99), 35);
        assert_eq!(iterations_needed(3, 100, 100, 0.99), 1);
    }
}
