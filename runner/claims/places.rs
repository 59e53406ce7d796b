//! C6 and C8: where a robot is localised, and what fewer nodes do.

use super::evidence::{Cell, Evidence};
use super::verdict::{Claim, Measured, Verdict, all_of};
use crate::RunError;
use crate::evaluate::share_of;
use furrow_catalog::{Catalog, tables};
use furrow_model::Outcome;
use furrow_model::outcome::event;
use std::collections::{BTreeMap, BTreeSet};

/// The row of the simulated Lindenhof, metres along the route; road lies before and behind it (F10).
const ROW_M: [f64; 2] = [24.0, 134.0];
/// Below this no share is told; metres.
const LEAST_M: usize = 30;

/// C6: the dark, dense row fails; its roads and the open site do not.
pub(super) fn row_and_road(catalog: &Catalog, evidence: &Evidence) -> Result<Claim, RunError> {
    let (id, experiments) = ("C6", "X08, X09");
    let finding =
        "Lindenhof's dark, dense row is hardly localised; the roads at its ends are, and open Backsburg all along.";
    let best = |experiment| {
        let experiment = [experiment];
        let cells: Vec<Cell> = evidence.cells(&experiment).cloned().collect();
        cells.into_iter().max_by_key(|cell| cell.outcome.evaluation.good)
    };
    let (Some(lindenhof), Some(backsburg)) = (best("X08"), best("X09")) else {
        return Ok(Claim::unmeasured(id, experiments, finding, "Lindenhof or Backsburg was not run"));
    };
    let (here, there) = (fates(catalog, &lindenhof.outcome)?, fates(catalog, &backsburg.outcome)?);
    let within = |metres: f64| (ROW_M[0]..ROW_M[1]).contains(&metres);
    let of = |row: bool| here.iter().copied().filter(|(metres, _)| within(*metres) == row).collect::<Vec<_>>();
    let shares = (share(&of(true)), share(&of(false)), share(&there));
    let (Some(row), Some(road), Some(open)) = shares else {
        return Ok(Claim::unmeasured(
            id,
            experiments,
            finding,
            "The traversal at Lindenhof is too short to see row and road",
        ));
    };
    let (verdict, why) = all_of(&[road.exceeds(row), open.exceeds(row)]);
    let text = |m: Measured| format!("{:.0} % [{:.0}, {:.0}]", 100.0 * m.value, 100.0 * m.low, 100.0 * m.high);
    let ours = format!(
        "Frames localised in the row {}, on its roads {}, at Backsburg {}; each with its best vocabulary.",
        text(row),
        text(road),
        text(open)
    );
    let why = format!("Roads and Backsburg each against the row. {why}");
    Ok(Claim { id, experiments, finding, ours, verdict, why })
}

/// Each live frame: metres travelled, and whether it was localised.
fn fates(catalog: &Catalog, outcome: &Outcome) -> Result<Vec<(f64, bool)>, RunError> {
    let table = tables::from_parquet("events", catalog.objects().read(outcome.events)?)?;
    let stamps = tables::i64s(&table, event::LIVE_STAMP_NS)?;
    let metres = tables::f64s(&table, event::TRAVELLED_M)?;
    let accepted =
        crate::inputs::table::strings(&table, event::DECISION)?.into_iter().map(|said| said == event::ACCEPTED);
    let mut frames: BTreeMap<i64, (f64, bool)> = BTreeMap::new();
    for ((stamp, metres), accepted) in stamps.into_iter().zip(metres).zip(accepted) {
        let frame = frames.entry(stamp).or_insert((metres, false));
        frame.1 |= accepted;
    }
    Ok(frames.into_values().collect())
}

/// The share localised with its 95 % interval, from none to all of too little road. `None` below 30 m.
fn share(frames: &[(f64, bool)]) -> Option<Measured> {
    let metres: BTreeSet<i64> = frames.iter().map(|(metres, _)| metres.floor() as i64).collect();
    let (value, interval) = share_of(frames);
    let [low, high] = interval.unwrap_or([0.0, 1.0]);
    (metres.len() >= LEAST_M).then_some(Measured { value, low, high })
}

/// Cells that differ in how far apart keyframes are, the farther first.
fn pairs(evidence: &Evidence) -> Vec<(&Cell, &Cell)> {
    let cells: Vec<&Cell> = evidence.cells(&["X03"]).filter(|cell| cell.is_recorded()).collect();
    let metres = |cell: &Cell| cell.outcome.keyframes.distance_m;
    let mut seen = BTreeSet::new();
    let mut pairs = Vec::new();
    for few in &cells {
        for many in &cells {
            let alike = few.outcome.live_traversal == many.outcome.live_traversal
                && few.outcome.experience == many.outcome.experience
                && few.outcome.threshold_inliers == many.outcome.threshold_inliers;
            if alike && metres(few) > metres(many) && seen.insert((few.outcome.key, many.outcome.key)) {
                pairs.push((*few, *many));
            }
        }
    }
    pairs
}

/// C8, first half: sub-sampling reports fewer localisations.
pub(super) fn subsampling_counts(evidence: &Evidence) -> Claim {
    let (id, experiments) = ("C8 count", "X03");
    let finding = "Sub-sampled experiences report fewer localisations than whole ones.";
    let good = |of: &[&Cell]| of.iter().map(|cell| cell.outcome.evaluation.good).sum::<u32>();
    let pairs = pairs(evidence);
    let verdicts: Vec<Verdict> =
        (pairs.iter()).map(|(few, many)| Measured::good(&many.outcome).exceeds(Measured::good(&few.outcome))).collect();
    if verdicts.is_empty() {
        return Claim::unmeasured(id, experiments, finding, "No experience with keyframes near and far");
    }
    let (verdict, why) = all_of(&verdicts);
    let (few, many): (Vec<&Cell>, Vec<&Cell>) = pairs.into_iter().unzip();
    let ours = format!("Good localisations in all: {} sub-sampled, {} whole.", good(&few), good(&many));
    Claim { id, experiments, finding, ours, verdict, why }
}

/// C8, second half: of what it reports, more is right.
pub(super) fn subsampling_precision(evidence: &Evidence) -> Claim {
    let (id, experiments) = ("C8 precision", "X03");
    let finding = "Sub-sampled experiences report better localisations: a greater share of them is right.";
    let precision = |of: &[&Cell]| {
        let truths = of.iter().filter_map(|cell| cell.outcome.evaluation.ground_truth.as_ref());
        let (right, wrong) = truths.fold((0, 0), |sum, truth| (sum.0 + truth.correct, sum.1 + truth.wrong));
        Measured::share(right, right + wrong).map(|share| (share, wrong))
    };
    let (few, many): (Vec<&Cell>, Vec<&Cell>) = pairs(evidence).into_iter().unzip();
    let (Some((few, few_wrong)), Some((many, many_wrong))) = (precision(&few), precision(&many)) else {
        return Claim::unmeasured(id, experiments, finding, "Nothing accepted, or no ground truth");
    };
    let text = |m: Measured| format!("{:.3} [{:.3}, {:.3}]", m.value, m.low, m.high);
    let ours = format!(
        "Share right {} sub-sampled ({few_wrong} wrong), {} whole ({many_wrong} wrong).",
        text(few),
        text(many)
    );
    let why = "Wilson intervals, as if frames were independent, which makes them too narrow.".to_owned();
    Claim { id, experiments, finding, ours, verdict: few.exceeds(many), why }
}
