//! Where the numbers of cells and contrasts come from.

use crate::figures::contrast_rows::live;
use crate::input::ContrastInput;
use crate::wording;
use furrow_model::metric::CURVES;
use furrow_model::{AtThreshold, Contrast, ContrastTraversal, Difference, GroundTruthScore, Outcome};
use serde::Serialize;
use std::collections::BTreeSet;

/// Where one cell's numbers come from.
#[derive(Serialize)]
pub(super) struct CellLineage {
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
    /// The metrics that are curves, in words.
    curves: Vec<[String; 2]>,
    events: String,
}

impl CellLineage {
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
            thresholds: e.thresholds.iter().map(threshold_text).collect::<Vec<_>>().join("; "),
            keyframes: format!("{} m, {} rad", outcome.keyframes.distance_m, outcome.keyframes.yaw_rad),
            distance_source: wording::shown(&e.distance_source),
            route: wording::tenths(e.lost.route_m),
            truth: e.ground_truth.as_ref().map(|truth| wording::shown(&truth.source)),
            curves: e.ground_truth.as_ref().map(curves).unwrap_or_default(),
            events: outcome.events.to_string(),
        }
    }
}

/// Recall by tolerance and along the route.
fn curves(truth: &GroundTruthScore) -> Vec<[String; 2]> {
    let within = truth.recall_within.iter().map(|p| format!("{} m {}", p.metres, wording::percent(p.recall)));
    let route = truth.route_recalled.iter();
    let route = route.map(|p| format!("at least {:.0}\u{202f}%: {}", 100.0 * p.recall, wording::percent(p.share)));
    let all = CURVES.iter().zip([within.collect::<Vec<_>>(), route.collect()]);
    all.filter(|(_, points)| !points.is_empty())
        .map(|(curve, points)| [format!("{}: {}", curve.heading, curve.meaning), points.join("; ")])
        .collect()
}

/// Such as `12 inliers: 30 good (28 right, 2 wrong), lost on 20 %, longest 4.0 m`.
fn threshold_text(at: &AtThreshold) -> String {
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

/// Where one contrast's numbers come from.
#[derive(Serialize)]
pub(super) struct ContrastLineage {
    number: usize,
    of: String,
    over: String,
    setting: String,
    live: String,
    frames: u32,
    /// What is subtracted: the measure, the contender's number, the other's.
    differences: Vec<[String; 3]>,
    errors: Vec<[String; 2]>,
    truth: Option<String>,
    traversals: Vec<Pair>,
}

/// The two cells of a contrast on one live traversal.
#[derive(Serialize)]
struct Pair {
    slot: String,
    traversal: String,
    /// The beginnings of the cells' keys, and whether the page has a lineage of them.
    cells: [(String, bool); 2],
}

/// The lineage of every contrast; `cells` are those that the page has a lineage of, by the beginnings of their keys.
pub(super) fn contrast_lineages(input: &ContrastInput, cells: &BTreeSet<String>) -> Vec<ContrastLineage> {
    let pair = |traversal: &ContrastTraversal| Pair {
        slot: traversal.slot.to_string(),
        traversal: traversal.traversal.to_string(),
        cells: traversal.cells.map(|cell| (cell.short(), cells.contains(&cell.short()))),
    };
    let lineage = |(i, contrast): (usize, &Contrast)| ContrastLineage {
        number: i + 1,
        of: wording::shown(&contrast.of),
        over: wording::shown(&contrast.over),
        setting: wording::shown(&contrast.setting),
        live: live(contrast, &input.found),
        frames: contrast.frames,
        differences: differences(contrast),
        errors: errors(&contrast.good),
        truth: contrast.truth.as_deref().map(wording::shown),
        traversals: contrast.live.iter().map(pair).collect(),
    };
    input.found.iter().enumerate().map(lineage).collect()
}

/// What the interval of good localisations rests on.
fn errors(good: &Difference) -> Vec<[String; 2]> {
    let blocks = good.blocks.zip(good.block_m).map(|(blocks, metres)| {
        ["Independent stretches".to_owned(), format!("{blocks}, of {metres:.1} m each, for good localisations")]
    });
    let error = |name: &str, error: Option<f64>| {
        error.map(|error| [format!("Standard error {name}"), format!("{error:.1} good localisations")])
    };
    let within = error("by the spread within traversals", good.error_within);
    let between = error("by the spread between traversals", good.error_between);
    blocks.into_iter().chain(within).chain(between).collect()
}

fn differences(contrast: &Contrast) -> Vec<[String; 3]> {
    let line = |name: &str, difference: &Difference, text: &dyn Fn(f64) -> String| {
        [name.to_owned(), text(difference.of), text(difference.over)]
    };
    let count = |value: f64| format!("{value:.0}");
    let right = contrast.right.as_ref().map(|right| line("right localisations", right, &count));
    let rest = [
        line("good localisations", &contrast.good, &count),
        line("lost", &contrast.lost_fraction, &wording::percent),
        line("lost-distance area", &contrast.area_m, &|metres| format!("{metres:.2} m")),
    ];
    right.into_iter().chain(rest).collect()
}
