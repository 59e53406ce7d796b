//! The numbers of every cell.

use super::datum::Datum;
use super::datum::Number::{self, Count, Hundredths, Share, Tenths};
use crate::figures::arrange::Setting;
use furrow_model::{Evaluation, GroundTruthScore};
use serde::Serialize;

/// A column's heading; `hint` says more.
#[derive(Serialize)]
pub(super) struct Heading {
    pub text: &'static str,
    hint: &'static str,
}

#[derive(Serialize)]
pub(super) struct Row {
    cell: String,
    /// Shown where the table has rows of several settings.
    pub setting: String,
    pub live: String,
    pub experience: String,
    pub numbers: Vec<Datum>,
}

/// A table of one setting's cells, or of all settings that have one cell each.
#[derive(Serialize)]
pub(super) struct Table {
    pub title: String,
    /// Whether rows are told apart by setting.
    pub by_setting: bool,
    pub headings: Vec<Heading>,
    pub rows: Vec<Row>,
    /// Whether only a row's first cell links to its lineage.
    crowded: bool,
}

/// A column: the name of its numbers, its heading, what that means, and the number of a cell.
type Column<T> = (&'static str, &'static str, &'static str, fn(&T) -> Option<Number>);

const COUNTS: [Column<Evaluation>; 7] = [
    ("frames", "frames", "live frames", |e| Some(Count(e.frames))),
    ("good", "good", "good localisations: the returned place reached the threshold of inliers", |e| {
        Some(Count(e.good))
    }),
    ("percent_good", "% good", "percentage of returned places that are good localisations", |e| {
        e.percent_good.map(Tenths)
    }),
    (
        "jumps",
        "jumps",
        "consecutive good localisations that lie over 5 m further apart than the distance travelled between them",
        |e| Some(Count(e.jumps)),
    ),
    ("lost_fraction", "lost", "fraction of the route travelled while lost", |e| Some(Share(e.lost.lost_fraction))),
    ("max_lost_m", "longest lost, m", "longest distance travelled without a localisation", |e| {
        Some(Tenths(e.lost.max_lost_m))
    }),
    ("mean_lost_m", "mean lost, m", "mean distance travelled without a localisation", |e| {
        Some(Tenths(e.lost.mean_lost_m))
    }),
];

/// Shown in tables where a ground truth judges some cell.
const JUDGED: [Column<GroundTruthScore>; 9] = [
    ("correct", "right", "accepted and right, according to the ground truth", |t| Some(Count(t.correct))),
    ("wrong", "wrong", "accepted and wrong, according to the ground truth", |t| Some(Count(t.wrong))),
    ("precision", "precision", "right / (right + wrong)", |t| t.precision.map(Share)),
    ("recall", "recall", "right / live frames that have a mapped place", |t| t.recall.map(Share)),
    (
        "recall_at_1",
        "recall@1",
        "the best candidate before verification is right; of the frames that have a mapped place",
        |t| t.recall_at_1.map(Share),
    ),
    ("recall_at_5", "recall@5", "one of the five likeliest candidates before verification is right", |t| {
        t.recall_at_5.map(Share)
    }),
    ("average_precision", "AP", "area under the precision-recall curve over all thresholds", |t| {
        t.average_precision.map(Share)
    }),
    ("false_positive_rate", "false pos.", "accepted fraction of the frames that have no mapped place", |t| {
        t.false_positive_rate.map(Share)
    }),
    ("position_rmse_m", "rmse, m", "root mean square distance of accepted localisations to the true position", |t| {
        t.position_rmse_m.map(Hundredths)
    }),
];

const REST: [Column<Evaluation>; 3] = [
    ("returned", "returned", "frames for which a place was returned, not “new place”", |e| Some(Count(e.returned))),
    ("new_place", "new place", "frames answered “new place”", |e| Some(Count(e.new_place))),
    ("rejected", "rejected", "frames whose place did not reach the threshold", |e| Some(Count(e.rejected))),
];

/// A table per setting, or one for all where each has a single cell.
pub(super) fn tables(settings: &[Setting<'_>]) -> Vec<Table> {
    if settings.len() > 1 && settings.iter().all(|setting| setting.cells().count() == 1) {
        return vec![Table { by_setting: true, ..table(settings, String::new()) }];
    }
    settings.iter().map(|setting| table(std::slice::from_ref(setting), setting.title.clone())).collect()
}

/// The table of some settings' cells.
fn table(settings: &[Setting<'_>], title: String) -> Table {
    let judged = settings.iter().flat_map(Setting::cells).any(|cell| cell.outcome.evaluation.ground_truth.is_some());
    let mut rows = Vec::new();
    for setting in settings {
        rows.extend(setting.places().map(|(live, column, cell)| Row {
            cell: cell.outcome.key.short(),
            setting: setting.title.clone(),
            live: live.label.clone(),
            experience: column.label.clone(),
            numbers: numbers(&cell.outcome.evaluation, judged),
        }));
    }
    let crowded = settings.iter().any(|setting| setting.crowded);
    Table { title, by_setting: false, headings: headings(judged), rows, crowded }
}

fn headings(judged: bool) -> Vec<Heading> {
    let judged = JUDGED.iter().filter(|_| judged).map(|(_, text, hint, _)| Heading { text, hint });
    let [counts, rest] = [&COUNTS[..], &REST].map(|c| c.iter().map(|(_, text, hint, _)| Heading { text, hint }));
    counts.chain(judged).chain(rest).collect()
}

fn numbers(e: &Evaluation, judged: bool) -> Vec<Datum> {
    let truth = e.ground_truth.as_ref();
    let judged = JUDGED.iter().filter(|_| judged).map(|(name, .., value)| Datum::new(name, truth.and_then(value)));
    let [counts, rest] = [&COUNTS[..], &REST].map(|c| c.iter().map(|(name, .., value)| Datum::new(name, value(e))));
    counts.chain(judged).chain(rest).collect()
}
