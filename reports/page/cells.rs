//! The numbers of every cell.

use super::datum::Datum;
use super::datum::Number::{self, Count, Hundredths, Share, Tenths};
use crate::figures::arrange::Setting;
use furrow_model::metric::metric;
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

/// A column: the name of its metric, and the number of a cell.
type Column<T> = (&'static str, fn(&T) -> Option<Number>);

const COUNTS: [Column<Evaluation>; 8] = [
    ("frames", |e| Some(Count(e.frames))),
    ("good", |e| Some(Count(e.good))),
    ("percent_of_frames", |e| Some(Tenths(e.percent_of_frames))),
    ("percent_good", |e| e.percent_good.map(Tenths)),
    ("jumps", |e| Some(Count(e.jumps))),
    ("lost_fraction", |e| Some(Share(e.lost.lost_fraction))),
    ("max_lost_m", |e| Some(Tenths(e.lost.max_lost_m))),
    ("mean_lost_m", |e| Some(Tenths(e.lost.mean_lost_m))),
];

/// Shown in tables where a ground truth judges some cell.
const JUDGED: [Column<GroundTruthScore>; 13] = [
    ("correct", |t| Some(Count(t.correct))),
    ("wrong", |t| Some(Count(t.wrong))),
    ("precision", |t| t.precision.map(Share)),
    ("recall", |t| t.recall.map(Share)),
    ("recall_of_answers", |t| t.recall_of_answers.map(Share)),
    ("recall_at_full_precision", |t| t.recall_at_full_precision.map(Share)),
    ("recall_at_1", |t| t.recall_at_1.map(Share)),
    ("recall_at_5", |t| t.recall_at_5.map(Share)),
    ("recall_at_10", |t| t.recall_at_10.map(Share)),
    ("recall_at_20", |t| t.recall_at_20.map(Share)),
    ("average_precision", |t| t.average_precision.map(Share)),
    ("false_positive_rate", |t| t.false_positive_rate.map(Share)),
    ("position_rmse_m", |t| t.position_rmse_m.map(Hundredths)),
];

const REST: [Column<Evaluation>; 3] = [
    ("returned", |e| Some(Count(e.returned))),
    ("new_place", |e| Some(Count(e.new_place))),
    ("rejected", |e| Some(Count(e.rejected))),
];

/// As `furrow explain` says it.
fn heading(name: &'static str) -> Heading {
    metric(name)
        .map_or(Heading { text: name, hint: "" }, |metric| Heading { text: metric.heading, hint: metric.meaning })
}

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
    let judged = JUDGED.iter().filter(|_| judged).map(|(name, _)| heading(name));
    let [counts, rest] = [&COUNTS[..], &REST].map(|c| c.iter().map(|(name, _)| heading(name)));
    counts.chain(judged).chain(rest).collect()
}

fn numbers(e: &Evaluation, judged: bool) -> Vec<Datum> {
    let truth = e.ground_truth.as_ref();
    let judged = JUDGED.iter().filter(|_| judged).map(|(name, value)| Datum::new(name, truth.and_then(value)));
    let [counts, rest] = [&COUNTS[..], &REST].map(|c| c.iter().map(|(name, value)| Datum::new(name, value(e))));
    counts.chain(judged).chain(rest).collect()
}
