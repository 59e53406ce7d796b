//! Scores against a ground truth: precision, recall, recall@K, false acceptances, position error.

use super::fate::Fate;
use super::judge::Judge;
use super::sweep::{Answered, average_precision, precision_recall, recall_at};
use furrow_model::GroundTruthScore;

pub(super) fn score(source: &str, fates: &[Fate<'_>], judge: &Judge) -> GroundTruthScore {
    let (mut correct, mut wrong, mut missed, mut rightly_refused, mut wrong_off_map) = (0, 0, 0, 0, 0);
    let (mut errors_m, mut answers, mut ranks) = (Vec::new(), Vec::new(), Vec::new());
    for (frame, fate) in fates.iter().enumerate() {
        let Some(has_place) = judge.has_mapped_place(frame) else { continue };
        if has_place {
            ranks.push(fate.first_right);
        }
        if let Some((inliers, correct)) = fate.verified.and_then(|row| row.inliers.zip(row.correct)) {
            answers.push(Answered { inliers, correct });
        }
        match fate.accepted.map(|row| (row.correct, row.error_m)) {
            // An answer whose true position nobody knows is neither right nor wrong.
            Some((None, _)) => {}
            Some((Some(right), error_m)) => {
                correct += u32::from(right);
                wrong += u32::from(!right);
                wrong_off_map += u32::from(!right && !has_place);
                errors_m.extend(error_m);
            }
            None if has_place => missed += 1,
            None => rightly_refused += 1,
        }
    }
    let mapped = ranks.len() as u32;
    let share = |part: u32, whole: u32| (whole > 0).then(|| f64::from(part) / f64::from(whole));
    let mean_square = errors_m.iter().map(|error| error * error).sum::<f64>() / errors_m.len().max(1) as f64;
    let precision_recall = precision_recall(&answers, ranks.len());
    GroundTruthScore {
        source: source.to_owned(),
        mapped,
        correct,
        wrong,
        missed,
        rightly_refused,
        precision: share(correct, correct + wrong),
        recall: share(correct, mapped),
        false_acceptance: share(wrong, correct + wrong),
        false_positive_rate: share(wrong_off_map, wrong_off_map + rightly_refused),
        recall_at_1: recall_at(1, &ranks),
        recall_at_5: recall_at(5, &ranks),
        average_precision: (mapped > 0).then(|| average_precision(&precision_recall)),
        precision_recall,
        position_rmse_m: (!errors_m.is_empty()).then(|| mean_square.sqrt()),
        position_max_m: errors_m.iter().copied().reduce(f64::max),
    }
}
