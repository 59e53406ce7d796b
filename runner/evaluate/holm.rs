//! Several questions asked at once: Holm's step-down correction (Holm 1979), which needs no independence.

/// The p-values of a family, adjusted: the least level at which all of the family still errs in that share of runs.
pub(super) fn adjusted(p: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..p.len()).collect();
    order.sort_by(|a, b| p[*a].total_cmp(&p[*b]));
    let mut all = vec![1.0; p.len()];
    let mut before: f64 = 0.0;
    for (rank, place) in order.into_iter().enumerate() {
        before = before.max((p.len() - rank) as f64 * p[place]).min(1.0);
        all[place] = before;
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The definition by closed testing (Marcus, Peritz and Gabriel 1976): a hypothesis falls where every set that
    /// holds it falls by Bonferroni. All 2^n sets are gone through.
    #[test]
    fn adjusted_values_are_those_of_closed_testing() {
        let number = |i: u32| f64::from((i.wrapping_mul(2_654_435_761) >> 9) % 1000) / 4000.0;
        for n in 0..=9_u32 {
            let p: Vec<f64> = (0..n).map(|i| number(i + 31 * n) * if i % 3 == 0 { 0.05 } else { 1.0 }).collect();
            for (i, found) in adjusted(&p).into_iter().enumerate() {
                let sets = (1_u32..1 << n).filter(|set| set >> i & 1 == 1);
                let bonferroni = |set: u32| {
                    let least = (0..p.len()).filter(|j| set >> j & 1 == 1).map(|j| p[j]).fold(1.0, f64::min);
                    (f64::from(set.count_ones()) * least).min(1.0)
                };
                let worst = sets.map(bonferroni).fold(0.0, f64::max);
                assert!((found - worst).abs() < 1e-12, "{p:?}: {found} against {worst}");
            }
        }
    }
}
