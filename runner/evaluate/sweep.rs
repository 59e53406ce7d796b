//! Precision and recall at every threshold, before any was chosen.

use furrow_model::PrecisionRecall;

/// A live frame's best verified answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Answered {
    /// Its inliers.
    pub inliers: u32,
    /// Whether it is the right place.
    pub correct: bool,
}

/// A point for every number of inliers that occurs, the highest threshold first, so recall never falls. `mapped` frames
/// have a place in the map, answered or not; it must be at least the number of right answers.
pub fn precision_recall(answers: &[Answered], mapped: usize) -> Vec<PrecisionRecall> {
    let mut falling = answers.to_vec();
    falling.sort_unstable_by_key(|answer| std::cmp::Reverse(answer.inliers));
    let (mut accepted, mut correct) = (0, 0);
    let mut points = Vec::new();
    for equal in falling.chunk_by(|a, b| a.inliers == b.inliers) {
        accepted += equal.len();
        correct += equal.iter().filter(|answer| answer.correct).count();
        let recall = if mapped > 0 { correct as f64 / mapped as f64 } else { 0.0 };
        points.push(PrecisionRecall { inliers: equal[0].inliers, precision: correct as f64 / accepted as f64, recall });
    }
    points
}

/// Area under the precision-recall curve as average precision: each step of recall counts with the precision it ends
/// at. No line is drawn between points, which would promise what no threshold gives (Davis and Goadrich 2006).
pub fn average_precision(points: &[PrecisionRecall]) -> f64 {
    let before = std::iter::once(0.0).chain(points.iter().map(|point| point.recall));
    points.iter().zip(before).map(|(point, before)| (point.recall - before) * point.precision).sum()
}

/// The greatest recall among points whose precision is 1; 0 where the highest threshold already accepts a wrong one.
pub fn recall_at_full_precision(points: &[PrecisionRecall]) -> f64 {
    points.iter().take_while(|point| point.precision >= 1.0).last().map_or(0.0, |point| point.recall)
}

/// The share of mapped frames whose right place is among the first `k` on offer. `ranks` holds for every mapped frame
/// the rank of its first right candidate, from 0; none where no candidate is right. `None` without mapped frames.
pub fn recall_at(k: u32, ranks: &[Option<u32>]) -> Option<f64> {
    let found = ranks.iter().filter(|rank| rank.is_some_and(|rank| rank < k)).count();
    (!ranks.is_empty()).then(|| found as f64 / ranks.len() as f64)
}

/// Consecutive localisations between which the place on the route moved more than 5 m further than the robot drove.
/// Each is the distance travelled by the live traversal and along the map's route, metres.
pub fn jumps(localisations: &[(f64, f64)]) -> usize {
    /// How much further.
    const TOO_FAR_M: f64 = 5.0;
    let is_jump = |pair: &&[(f64, f64)]| {
        let [(live, place), (next_live, next_place)] = [pair[0], pair[1]];
        (next_place - place).abs() > (next_live - live).abs() + TOO_FAR_M
    };
    localisations.windows(2).filter(is_jump).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn answers() -> Vec<Answered> {
        let number = |i: u32| (i.wrapping_mul(2_654_435_761) >> 7) % 60;
        (0..300).map(|i| Answered { inliers: number(i), correct: number(i + 1000) < number(i) + 5 }).collect()
    }

    /// Every threshold on its own, by counting.
    #[test]
    fn every_point_is_a_count() {
        let answers = answers();
        let points = precision_recall(&answers, 350);
        assert!(points.len() > 20 && points.windows(2).all(|pair| pair[1].inliers < pair[0].inliers));
        let mut area = 0.0;
        let mut last_right = 0;
        for threshold in (0..100).rev() {
            let accepted: Vec<&Answered> = answers.iter().filter(|answer| answer.inliers >= threshold).collect();
            let right = accepted.iter().filter(|answer| answer.correct).count();
            match points.iter().find(|point| point.inliers == threshold) {
                Some(point) => {
                    assert_eq!(point.precision, right as f64 / accepted.len() as f64);
                    assert_eq!(point.recall, right as f64 / 350.0);
                }
                None => assert_eq!(right, last_right, "no answer has {threshold} inliers"),
            }
            area += (right - last_right) as f64 / 350.0 * right as f64 / accepted.len().max(1) as f64;
            last_right = right;
        }
        assert!((average_precision(&points) - area).abs() < 1e-12);
    }

    #[test]
    fn curves_of_perfect_and_useless_localisers() {
        let all = |correct| -> Vec<Answered> { (1..=10).map(|inliers| Answered { inliers, correct }).collect() };
        assert_eq!(average_precision(&precision_recall(&all(true), 10)), 1.0);
        assert_eq!(average_precision(&precision_recall(&all(true), 20)), 0.5);
        assert_eq!(average_precision(&precision_recall(&all(false), 10)), 0.0);
        assert_eq!(precision_recall(&[], 10), []);
    }

    #[test]
    fn recall_counts_the_first_right_candidate() {
        let ranks = [Some(0), Some(3), None, Some(4), Some(0)];
        assert_eq!([1, 4, 5].map(|k| recall_at(k, &ranks)), [Some(0.4), Some(0.6), Some(0.8)]);
        assert_eq!(recall_at(5, &[]), None);
    }

    #[test]
    fn jumps_are_further_than_driven_and_five_metres() {
        assert_eq!(jumps(&[(0.0, 10.0), (2.0, 16.9), (3.0, 23.0), (9.0, 12.1), (10.0, 2.0)]), 2);
        assert_eq!(jumps(&[(0.0, 10.0)]), 0);
    }
}
