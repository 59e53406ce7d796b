//! The numbers of a cell, each defined once (SPEC 4). Reports only draw them.

mod lost;
mod score;
mod sweep;

pub use lost::{Event, lost_distance};
pub use score::{Judge, Judged, LiveMoment};
pub use sweep::{Answered, SweepPoint, average_precision, jumps, precision_recall, recall_at};

use crate::deciding::EventRow;
use furrow_model::outcome::event;
use furrow_model::{Evaluation, GroundTruthScore};

/// The version of these definitions, part of every cell's key.
pub(crate) const VERSION: &str = "evaluate/1";

/// What became of one live frame.
struct Fate<'a> {
    accepted: Option<&'a EventRow>,
    returned: bool,
    best_is_right: bool,
}

/// Evaluates the events of a pass of which `frames` live frames were offered to the localisers.
pub(crate) fn evaluate(rows: &[EventRow], judge: &Judge, seed: u64) -> Evaluation {
    let moments = judge.moments();
    let fates: Vec<Fate<'_>> = by_frame(rows, moments.len()).into_iter().map(fate).collect();
    let count = |wanted: &dyn Fn(&Fate<'_>) -> bool| fates.iter().filter(|fate| wanted(fate)).count() as u32;
    let returned = count(&|fate| fate.returned);
    let good = count(&|fate| fate.accepted.is_some());
    let events: Vec<Event> = moments
        .iter()
        .zip(&fates)
        .map(|(moment, fate)| Event { travelled_m: moment.travelled_m, localised: fate.accepted.is_some() })
        .collect();
    let (start_m, end_m) = (
        moments.first().map_or(0.0, |moment| moment.travelled_m),
        moments.last().map_or(0.0, |moment| moment.travelled_m),
    );
    Evaluation {
        frames: moments.len() as u32,
        returned,
        new_place: moments.len() as u32 - returned,
        rejected: returned - good,
        good,
        percent_good: (returned > 0).then(|| 100.0 * f64::from(good) / f64::from(returned)),
        distance_source: judge.distance_source().to_owned(),
        lost: lost_distance(&events, start_m, end_m, seed),
        ground_truth: judge.source().map(|source| score(source, &fates, judge)),
    }
}

/// The rows of each frame; rows come in the order of frames.
fn by_frame(rows: &[EventRow], frames: usize) -> Vec<&[EventRow]> {
    let mut rest = rows;
    (0..frames)
        .map(|frame| {
            let (these, others) = rest.split_at(rest.partition_point(|row| row.frame == frame));
            rest = others;
            these
        })
        .collect()
}

fn fate(rows: &[EventRow]) -> Fate<'_> {
    // The most likely answer of all experiences, before any verification; a new place is right nowhere.
    let best = rows.iter().filter(|row| row.rank == 0).max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood));
    Fate {
        accepted: rows.iter().find(|row| row.decision == event::ACCEPTED),
        returned: rows.iter().any(|row| row.inliers.is_some()),
        best_is_right: best.is_some_and(|row| row.correct == Some(true)),
    }
}

fn score(source: &str, fates: &[Fate<'_>], judge: &Judge) -> GroundTruthScore {
    let (mut correct, mut wrong, mut missed, mut rightly_refused, mut mapped, mut recalled) = (0, 0, 0, 0, 0, 0);
    let mut errors_m = Vec::new();
    for (frame, fate) in fates.iter().enumerate() {
        let Some(has_place) = judge.has_mapped_place(frame) else { continue };
        mapped += u32::from(has_place);
        recalled += u32::from(has_place && fate.best_is_right);
        match fate.accepted.map(|row| (row.correct, row.error_m)) {
            // An answer whose true position nobody knows is neither right nor wrong.
            Some((None, _)) => {}
            Some((Some(right), error_m)) => {
                correct += u32::from(right);
                wrong += u32::from(!right);
                errors_m.extend(error_m);
            }
            None if has_place => missed += 1,
            None => rightly_refused += 1,
        }
    }
    let share = |part: u32, whole: u32| (whole > 0).then(|| f64::from(part) / f64::from(whole));
    let mean_square = errors_m.iter().map(|error| error * error).sum::<f64>() / errors_m.len().max(1) as f64;
    GroundTruthScore {
        source: source.to_owned(),
        correct,
        wrong,
        missed,
        rightly_refused,
        precision: share(correct, correct + wrong),
        recall: share(correct, mapped),
        recall_at_1: share(recalled, mapped),
        position_rmse_m: (!errors_m.is_empty()).then(|| mean_square.sqrt()),
        position_max_m: errors_m.iter().copied().reduce(f64::max),
    }
}
