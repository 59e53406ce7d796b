//! The numbers of every cell, and where each comes from.

use crate::arrange::Setting;
use crate::wording;
use furrow_model::{AtThreshold, Outcome};
use serde::Serialize;

/// A number as shown, and as it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub(crate) struct Datum {
    /// What it is; `good`, `max_lost_m` …
    pub name: &'static str,
    /// All its digits; empty where it does not exist.
    pub value: String,
    /// As people read it.
    pub text: String,
}

impl Datum {
    pub fn count(name: &'static str, value: impl Into<Option<u32>>) -> Self {
        let value = value.into();
        let text = value.map_or_else(|| "–".to_owned(), wording::count);
        Self { name, value: value.map(|value| value.to_string()).unwrap_or_default(), text }
    }

    fn real(name: &'static str, value: impl Into<Option<f64>>, text: fn(Option<f64>) -> String) -> Self {
        let value = value.into();
        Self { name, value: value.map(|value| value.to_string()).unwrap_or_default(), text: text(value) }
    }
}

/// A column's heading; `hint` says more.
#[derive(Serialize)]
pub(crate) struct Heading {
    pub text: &'static str,
    hint: &'static str,
}

#[derive(Serialize)]
pub(crate) struct Row {
    cell: String,
    /// Shown where the table has rows of several settings.
    pub setting: String,
    pub live: String,
    pub experience: String,
    pub numbers: Vec<Datum>,
}

/// A table of one setting's cells, or of all settings that have one cell each.
#[derive(Serialize)]
pub(crate) struct Table {
    pub title: String,
    /// Whether rows are told apart by setting.
    pub by_setting: bool,
    pub headings: Vec<Heading>,
    pub rows: Vec<Row>,
    /// Whether only a row's first cell links to its lineage.
    crowded: bool,
}

const HEADINGS: [Heading; 7] = [
    Heading { text: "frames", hint: "live frames offered" },
    Heading { text: "good", hint: "good localisations: a place was returned and reached the threshold of inliers" },
    Heading { text: "% good", hint: "good localisations in a hundred returned places" },
    Heading { text: "jumps", hint: "consecutive good localisations that lie over 5 m further apart than was driven" },
    Heading { text: "lost", hint: "share of the route driven lost" },
    Heading { text: "longest lost, m", hint: "the longest stretch driven without a localisation" },
    Heading { text: "mean lost, m", hint: "the mean stretch driven without a localisation" },
];
const TRUTH_HEADINGS: [Heading; 9] = [
    Heading { text: "right", hint: "accepted and right, by ground truth" },
    Heading { text: "wrong", hint: "accepted and wrong, by ground truth" },
    Heading { text: "precision", hint: "right / (right + wrong)" },
    Heading { text: "recall", hint: "right / live frames that have a mapped place" },
    Heading { text: "recall@1", hint: "best candidate right before verification, of frames that have a mapped place" },
    Heading { text: "recall@5", hint: "a right one among the five likeliest, before verification" },
    Heading { text: "AP", hint: "area under the precision-recall curve over all thresholds" },
    Heading { text: "false pos.", hint: "share accepted of the frames that have no mapped place" },
    Heading { text: "rmse, m", hint: "root mean square distance of accepted answers to the true position" },
];

const REST_HEADINGS: [Heading; 3] = [
    Heading { text: "returned", hint: "frames answered with a place, not “new place”" },
    Heading { text: "new place", hint: "frames answered “new place”" },
    Heading { text: "rejected", hint: "frames whose place did not reach the threshold" },
];

/// A table per setting, or one for all where each has a single cell.
pub(crate) fn of_settings(settings: &[Setting<'_>]) -> Vec<Table> {
    if settings.len() > 1 && settings.iter().all(|setting| setting.cells().count() == 1) {
        return vec![Table { by_setting: true, ..of(settings, String::new()) }];
    }
    settings.iter().map(|setting| of(std::slice::from_ref(setting), setting.title.clone())).collect()
}

/// The table of some settings' cells; columns of ground truth only where a cell has one.
fn of(settings: &[Setting<'_>], title: String) -> Table {
    let truth = settings.iter().flat_map(Setting::cells).any(|cell| cell.outcome.evaluation.ground_truth.is_some());
    let mut rows = Vec::new();
    for setting in settings {
        rows.extend(setting.places().map(|(live, column, cell)| Row {
            cell: cell.outcome.key.short(),
            setting: setting.title.clone(),
            live: live.label.clone(),
            experience: column.label.clone(),
            numbers: numbers(&cell.outcome, truth),
        }));
    }
    let truth_headings = TRUTH_HEADINGS.into_iter().filter(|_| truth);
    let headings = HEADINGS.into_iter().chain(truth_headings).chain(REST_HEADINGS).collect();
    let crowded = settings.iter().any(|setting| setting.crowded);
    Table { title, by_setting: false, headings, rows, crowded }
}

fn numbers(outcome: &Outcome, truth: bool) -> Vec<Datum> {
    let e = &outcome.evaluation;
    let mut numbers = vec![
        Datum::count("frames", e.frames),
        Datum::count("good", e.good),
        Datum::real("percent_good", e.percent_good, wording::tenths),
        Datum::count("jumps", e.jumps),
        Datum::real("lost_fraction", e.lost.lost_fraction, wording::percent),
        Datum::real("max_lost_m", e.lost.max_lost_m, wording::tenths),
        Datum::real("mean_lost_m", e.lost.mean_lost_m, wording::tenths),
    ];
    if truth {
        let t = e.ground_truth.as_ref();
        numbers.extend([
            Datum::count("correct", t.map(|t| t.correct)),
            Datum::count("wrong", t.map(|t| t.wrong)),
            Datum::real("precision", t.and_then(|t| t.precision), wording::percent),
            Datum::real("recall", t.and_then(|t| t.recall), wording::percent),
            Datum::real("recall_at_1", t.and_then(|t| t.recall_at_1), wording::percent),
            Datum::real("recall_at_5", t.and_then(|t| t.recall_at_5), wording::percent),
            Datum::real("average_precision", t.and_then(|t| t.average_precision), wording::percent),
            Datum::real("false_positive_rate", t.and_then(|t| t.false_positive_rate), wording::percent),
            Datum::real("position_rmse_m", t.and_then(|t| t.position_rmse_m), |value| match value {
                Some(value) => format!("{value:.2}"),
                None => "–".to_owned(),
            }),
        ]);
    }
    numbers.extend([
        Datum::count("returned", e.returned),
        Datum::count("new_place", e.new_place),
        Datum::count("rejected", e.rejected),
    ]);
    numbers
}

/// `12 inliers: 30 good (28 right, 2 wrong), lost on 20 %, longest 4.0 m`.
fn at_threshold(at: &AtThreshold) -> String {
    let judged = at.correct.zip(at.wrong).map(|(right, wrong)| format!(" ({right} right, {wrong} wrong)"));
    format!(
        "{} inliers: {} good{}, lost on {}, longest {} m",
        at.inliers,
        at.good,
        judged.unwrap_or_default(),
        wording::percent(at.lost_fraction),
        wording::tenths(at.max_lost_m)
    )
}

/// Where one cell's numbers come from.
#[derive(Serialize)]
pub(crate) struct Lineage {
    cell: String,
    key: String,
    live: String,
    live_traversal: String,
    experience: String,
    members: Vec<(String, String, u32)>,
    codebook: Option<String>,
    codebook_words: u32,
    method: String,
    policy: Option<String>,
    threshold: u32,
    thresholds: String,
    keyframes: String,
    distance_source: String,
    route: String,
    truth: Option<String>,
    events: String,
}

impl Lineage {
    pub fn of(outcome: &Outcome) -> Self {
        let e = &outcome.evaluation;
        Self {
            cell: outcome.key.short(),
            key: outcome.key.to_string(),
            live: outcome.live.to_string(),
            live_traversal: outcome.live_traversal.to_string(),
            experience: wording::shown(&outcome.experience),
            members: outcome.members.iter().map(|m| (m.slot.to_string(), m.id.to_string(), m.nodes)).collect(),
            codebook: outcome.codebook.map(|codebook| codebook.to_string()),
            codebook_words: outcome.codebook_words,
            method: wording::shown(&outcome.method),
            policy: (outcome.members.len() > 1).then(|| wording::shown(&outcome.policy)),
            threshold: outcome.threshold_inliers,
            thresholds: e.thresholds.iter().map(at_threshold).collect::<Vec<_>>().join("; "),
            keyframes: format!("{} m, {} rad", outcome.keyframes.distance_m, outcome.keyframes.yaw_rad),
            distance_source: wording::shown(&e.distance_source),
            route: wording::tenths(e.lost.route_m),
            truth: e.ground_truth.as_ref().map(|truth| wording::shown(&truth.source)),
            events: outcome.events.to_string(),
        }
    }
}
