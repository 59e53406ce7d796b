//! The numbers of a cell, each defined once; reports only draw them. Reads the store; knows no plan and no stage.
//! [`truth`] and `judge` say where frames really were and which candidates are right, `lost` the lost stretches,
//! `score`, `sweep` and `recalled` precision and recall, [`contrast`] with `paired` and `holm` the differences of two
//! cells, `spread` and `share` with `student` how sure a number is.

pub mod contrast;
#[cfg(test)]
mod coverage;
pub(crate) mod event_row;
mod fate;
mod holm;
mod judge;
mod lost;
pub(crate) mod paired;
mod recalled;
mod score;
mod share;
mod spread;
mod student;
mod sweep;
pub mod tracks;
pub mod truth;

pub use judge::{Judge, Judged, LiveMoment};
pub use lost::{Event, Stretches, lost_distance};
pub(crate) use share::share_of;
pub use sweep::{Answered, average_precision, jumps, precision_recall, recall_at};

use event_row::EventRow;
use fate::Fate;
use furrow_model::outcome::event;
use furrow_model::{AtThreshold, Censored, Evaluation};
use score::score;

/// What was decided at one threshold.
pub(crate) struct Decided {
    pub threshold: u32,
    pub rows: Vec<EventRow>,
}

/// How a traversal is evaluated.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    pub censored: Censored,
}

/// Evaluates a traversal by what was `decided` at the threshold in use, and at others beside it.
pub(crate) fn evaluate(decided: &Decided, others: &[Decided], judge: &Judge, rules: Rules) -> Evaluation {
    let moments = judge.moments();
    let fates = fates(&decided.rows, moments.len());
    let returned = fates.iter().filter(|fate| fate.verified.is_some()).count() as u32;
    let good = fates.iter().filter(|fate| fate.accepted.is_some()).count() as u32;
    Evaluation {
        frames: moments.len() as u32,
        returned,
        new_place: moments.len() as u32 - returned,
        rejected: returned - good,
        good,
        good_interval: good_interval(&fates, judge),
        percent_of_frames: percent(good, moments.len() as u32).unwrap_or_default(),
        percent_good: percent(good, returned),
        jumps: jumps(&localisations(&fates, judge)) as u32,
        distance_source: judge.distance_source().to_owned(),
        lost: lost(&fates, judge, rules).curves(),
        thresholds: others.iter().map(|other| at_threshold(other, judge, rules)).collect(),
        ground_truth: judge.source().map(|source| score(source, &fates, judge)),
    }
}

fn at_threshold(decided: &Decided, judge: &Judge, rules: Rules) -> AtThreshold {
    let fates = fates(&decided.rows, judge.moments().len());
    let accepted: Vec<&EventRow> = fates.iter().filter_map(|fate| fate.accepted).collect();
    let (good, returned) = (accepted.len() as u32, fates.iter().filter(|fate| fate.verified.is_some()).count() as u32);
    let judged = |right| accepted.iter().filter(|row| row.correct == Some(right)).count() as u32;
    let lost = lost(&fates, judge, rules);
    AtThreshold {
        inliers: decided.threshold,
        good,
        percent_good: percent(good, returned),
        lost_fraction: lost.fraction(),
        max_lost_m: lost.max_m(),
        correct: judge.source().map(|_| judged(true)),
        wrong: judge.source().map(|_| judged(false)),
    }
}

fn percent(good: u32, returned: u32) -> Option<f64> {
    (returned > 0).then(|| 100.0 * f64::from(good) / f64::from(returned))
}

fn lost(fates: &[Fate<'_>], judge: &Judge, rules: Rules) -> Stretches {
    let moments = judge.moments();
    let event = |(moment, fate): (&LiveMoment, &Fate<'_>)| Event {
        travelled_m: moment.travelled_m,
        localised: fate.accepted.is_some(),
    };
    let events: Vec<Event> = moments.iter().zip(fates).map(event).collect();
    let end_m = |moment: Option<&LiveMoment>| moment.map_or(0.0, |moment| moment.travelled_m);
    Stretches::of(&events, end_m(moments.first()), end_m(moments.last()), rules.censored)
}

/// How many good localisations another road like this one may give; `None` of too little road.
fn good_interval(fates: &[Fate<'_>], judge: &Judge) -> Option<[u32; 2]> {
    let frames = judge.moments().iter().zip(fates);
    let frames: Vec<(f64, bool)> = frames.map(|(moment, fate)| (moment.travelled_m, fate.accepted.is_some())).collect();
    let of_frames = |share: f64| (share * frames.len() as f64).round() as u32;
    share_of(&frames).1.map(|ends| ends.map(of_frames))
}

/// Distance travelled, live and along the map, of every good localisation.
fn localisations(fates: &[Fate<'_>], judge: &Judge) -> Vec<(f64, f64)> {
    let along = |row: &EventRow| {
        let place_m = judge.node_travelled_m(row.member, row.node?)?;
        Some((judge.moments().get(row.frame)?.travelled_m, place_m))
    };
    fates.iter().filter_map(|fate| fate.accepted).filter_map(along).collect()
}

/// The fate of each frame; rows come in the order of frames.
fn fates(rows: &[EventRow], frames: usize) -> Vec<Fate<'_>> {
    let mut rest = rows;
    (0..frames)
        .map(|frame| {
            let (these, others) = rest.split_at(rest.partition_point(|row| row.frame == frame));
            rest = others;
            fate(these)
        })
        .collect()
}

fn fate(rows: &[EventRow]) -> Fate<'_> {
    let mut hypotheses: Vec<&EventRow> = rows.iter().collect();
    // A new place that comes without a likelihood is the answer, so it is first.
    let likelihood = |row: &EventRow| row.log_likelihood.unwrap_or(f64::INFINITY);
    hypotheses.sort_by(|a, b| likelihood(b).total_cmp(&likelihood(a)));
    // The last of equals is kept, so from behind the more likely wins a tie of inliers.
    let verified = hypotheses.iter().rev().copied().filter(|row| row.inliers.is_some());
    Fate {
        accepted: rows.iter().find(|row| row.decision == event::ACCEPTED),
        verified: verified.max_by_key(|row| row.inliers),
        first_right: hypotheses.iter().position(|row| row.correct == Some(true)).map(|place| place as u32),
    }
}
