//! Scores against a ground truth: precision, recall, recall@K, false acceptances, position error.

use super::fate::Fate;
use super::judge::Judge;
use super::recalled::{recall_within, route_recalled};
use super::sweep::{Answered, average_precision, precision_recall, recall_at, recall_at_full_precision};
use furrow_model::GroundTruthScore;

pub(super) fn score(source: &str, fates: &[Fate<'_>], judge: &Judge) -> GroundTruthScore {
    let (mut correct, mut wrong, mut missed, mut rightly_refused, mut wrong_off_map) = (0, 0, 0, 0, 0);
    let (mut errors_m, mut answers, mut ranks) = (Vec::new(), Vec::new(), Vec::new());
    let (mut mapped_errors_m, mut route) = (Vec::new(), Vec::new());
    let start_m = judge.moments().first().map_or(0.0, |moment| moment.travelled_m);
    for (frame, fate) in fates.iter().enumerate() {
        let Some(has_place) = judge.has_mapped_place(frame) else { continue };
        if has_place {
            ranks.push(fate.first_right);
            mapped_errors_m.extend(fate.accepted.and_then(|row| row.error_m));
            let right = fate.accepted.is_some_and(|row| row.correct == Some(true));
            route.push((judge.moments()[frame].travelled_m - start_m, right));
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
    let at = |k: u32| recall_at(k, &ranks).filter(|_| judge.members() == 1);
    let none = Some(0.0);
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
        recall_of_answers: precision_recall.last().map(|point| point.recall).or(none).filter(|_| mapped > 0),
        recall_at_full_precision: (mapped > 0).then(|| recall_at_full_precision(&precision_recall)),
        recall_at_1: at(1),
        recall_at_5: at(5),
        recall_at_10: at(10),
        recall_at_20: at(20),
        recall_within: recall_within(&mapped_errors_m, ranks.len()),
        route_recalled: route_recalled(&route),
        average_precision: (mapped > 0).then(|| average_precision(&precision_recall)),
        precision_recall,
        position_rmse_m: (!errors_m.is_empty()).then(|| mean_square.sqrt()),
        position_max_m: errors_m.iter().copied().reduce(f64::max),
    }
}
