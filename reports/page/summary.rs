//! The page's first words: what was tried, what came of it, whether it can be believed.

use super::datum::Datum;
use crate::input::ReportInput;
use crate::wording::{self, counted};
use furrow_model::Outcome;
use serde::Serialize;
use std::collections::{BTreeMap, BTreeSet};

/// One cell in words.
#[derive(Serialize)]
struct CellText {
    cell: String,
    live: String,
    experience: String,
    good: Datum,
    frames: Datum,
    never_lost: bool,
    longest_m: String,
    lost: String,
}

/// What one ground truth says, over all its cells.
#[derive(Serialize)]
struct Verdict {
    source: String,
    cells: String,
    accepted: Datum,
    correct: Datum,
    wrong: Datum,
}

/// All that the opening paragraphs need.
#[derive(Serialize)]
pub(super) struct Summary {
    cells: usize,
    cells_text: String,
    lives_text: String,
    experiences_text: String,
    missing_text: String,
    missing: usize,
    best: Option<CellText>,
    worst: Option<CellText>,
    nothing_good: bool,
    verdicts: Vec<Verdict>,
    unjudged: usize,
    unjudged_text: String,
    thresholds: String,
    distance_sources: String,
}

/// The finished cells are ranked by the share of live frames localised, then by the share of the route lost.
pub(super) fn summary(input: &ReportInput) -> Summary {
    let outcomes: Vec<&Outcome> = input.cells.iter().map(|cell| &cell.outcome).collect();
    let mut ranked = outcomes.clone();
    ranked.sort_by(|a, b| localised(b).total_cmp(&localised(a)).then(lost(a).total_cmp(&lost(b))));
    let lives: BTreeSet<_> = outcomes.iter().map(|outcome| (outcome.live, outcome.live_traversal)).collect();
    let experiences: BTreeSet<_> = outcomes.iter().map(|outcome| &outcome.experience).collect();
    let unjudged = outcomes.iter().filter(|outcome| outcome.evaluation.ground_truth.is_none()).count();
    let thresholds: BTreeSet<_> = outcomes.iter().map(|outcome| outcome.threshold_inliers).collect();
    let sources: BTreeSet<_> =
        outcomes.iter().map(|outcome| wording::shown(&outcome.evaluation.distance_source)).collect();
    Summary {
        cells: outcomes.len(),
        cells_text: counted(outcomes.len(), "cell", "cells"),
        lives_text: counted(lives.len(), "live traversal", "live traversals"),
        experiences_text: counted(experiences.len(), "experience", "experiences"),
        missing_text: counted(input.missing.len(), "cell", "cells"),
        missing: input.missing.len(),
        best: ranked.first().map(|outcome| cell_text(outcome)),
        worst: ranked.last().filter(|_| ranked.len() > 1).map(|outcome| cell_text(outcome)),
        nothing_good: outcomes.iter().all(|outcome| outcome.evaluation.good == 0),
        verdicts: verdicts(&outcomes),
        unjudged,
        unjudged_text: counted(unjudged, "cell", "cells"),
        thresholds: thresholds.iter().map(u32::to_string).collect::<Vec<_>>().join(", "),
        distance_sources: sources.into_iter().collect::<Vec<_>>().join(", "),
    }
}

/// Only ranks cells: the page shows the two numbers themselves.
fn localised(outcome: &Outcome) -> f64 {
    f64::from(outcome.evaluation.good) / f64::from(outcome.evaluation.frames.max(1))
}

fn lost(outcome: &Outcome) -> f64 {
    outcome.evaluation.lost.lost_fraction
}

fn cell_text(outcome: &Outcome) -> CellText {
    let e = &outcome.evaluation;
    CellText {
        cell: outcome.key.short(),
        live: outcome.live.to_string(),
        experience: wording::shown(&outcome.experience),
        good: Datum::count("good", e.good),
        frames: Datum::count("frames", e.frames),
        never_lost: e.lost.stretches.is_empty(),
        longest_m: wording::tenths(e.lost.max_lost_m),
        lost: wording::percent(e.lost.lost_fraction),
    }
}

fn verdicts(outcomes: &[&Outcome]) -> Vec<Verdict> {
    let mut by_source: BTreeMap<String, (usize, u32, u32)> = BTreeMap::new();
    for truth in outcomes.iter().filter_map(|outcome| outcome.evaluation.ground_truth.as_ref()) {
        let sums = by_source.entry(wording::shown(&truth.source)).or_default();
        *sums = (sums.0 + 1, sums.1 + truth.correct, sums.2 + truth.wrong);
    }
    let verdict = |(source, (cells, correct, wrong)): (String, (usize, u32, u32))| Verdict {
        source,
        cells: counted(cells, "cell", "cells"),
        accepted: Datum::count("accepted", correct + wrong),
        correct: Datum::count("correct", correct),
        wrong: Datum::count("wrong", wrong),
    };
    by_source.into_iter().map(verdict).collect()
}
