//! C1 to C5: what the time of day does, and what generated experiences change about it.

use super::evidence::{Cell, Child, Evidence};
use super::verdict::{Claim, Measured, Verdict, all_of};
use std::collections::BTreeSet;

/// The experiments in which recorded experiences of all hours meet live traversals.
const RECORDED: [&str; 5] = ["X10", "X11", "X12", "X13", "X14"];
/// Those with generated ones.
const GENERATED: [&str; 5] = ["X11", "X12", "X13", "X14", "X15"];

/// C1: an experience localises its own hour best.
pub(super) fn siblings(evidence: &Evidence) -> Claim {
    const FACTOR: f64 = 3.0;
    let (id, experiments) = ("C1", "X10");
    let finding =
        "A huge peak of good localisations on the live traversal's own hour: at least 3 times the mean of its row.";
    let mut rows: Vec<String> = Vec::new();
    let mut verdicts = Vec::new();
    let cells: Vec<&Cell> = evidence.cells(&["X10"]).filter(|cell| cell.is_recorded()).collect();
    for own in cells.iter().filter(|cell| cell.slot() == Some(cell.outcome.live)) {
        let others = cells.iter().filter(|cell| cell.beside(own) && cell.slot() != own.slot());
        let others: Vec<Measured> = others.map(|cell| Measured::good(&cell.outcome)).collect();
        let Some(mean) = Measured::mean(&others) else { continue };
        let (peak, bar) = (Measured::good(&own.outcome), scaled(mean, FACTOR));
        verdicts.push(peak.exceeds(bar));
        let (low, high) = (peak.low / mean.high.max(1.0), peak.high / mean.low.max(1.0));
        rows.push(format!("{} {:.1} [{low:.1}, {high:.1}]", own.outcome.live, peak.value / mean.value.max(1.0)));
    }
    if rows.is_empty() {
        return Claim::unmeasured(id, experiments, finding, "No live traversal met its own hour and others");
    }
    let (verdict, why) = all_of(&verdicts);
    let ours = format!("Own hour over the mean of the others, by live slot: {}.", rows.join(", "));
    Claim { id, experiments, finding, ours, verdict, why }
}

fn scaled(measured: Measured, factor: f64) -> Measured {
    let Measured { value, low, high } = measured;
    Measured { value: factor * value, low: factor * low, high: factor * high }
}

/// A generated experience's cell, its parent's, and that of the recorded slot it mimics, where there is one.
struct Family<'a> {
    cell: &'a Cell,
    child: Child,
    parent: &'a Cell,
    mimicked: Option<&'a Cell>,
}

fn families(evidence: &Evidence) -> Vec<Family<'_>> {
    let mut seen = BTreeSet::new();
    let recorded: Vec<&Cell> = evidence.cells(&RECORDED).filter(|cell| cell.is_recorded()).collect();
    let find = |cell: &Cell, wanted: &dyn Fn(&Cell) -> bool| {
        recorded.iter().copied().find(|other| other.beside(cell) && wanted(other))
    };
    let family = |cell: &'_ Cell| -> Option<(Child, &Cell, Option<&Cell>)> {
        let child = cell.child?;
        let parent = find(cell, &|other| other.outcome.members[0].id == child.parent)?;
        let mimicked = find(cell, &|other| other.slot() == Some(child.mimics) && child.mimics != child.parent_slot);
        Some((child, parent, mimicked))
    };
    (evidence.cells(&GENERATED))
        .filter(|cell| seen.insert(cell.outcome.key))
        .filter_map(|cell| family(cell).map(|(child, parent, mimicked)| Family { cell, child, parent, mimicked }))
        .collect()
}

/// C2: a generated experience of a good parent beats the recorded hour that it mimics.
pub(super) fn better_than_mimicked(evidence: &Evidence) -> Claim {
    let (id, experiments) = ("C2", "X11, X13");
    let finding =
        "A generated experience from a good parent localises at least as well as the recorded hour it mimics.";
    let mut rows = Vec::new();
    let mut verdicts = Vec::new();
    for Family { cell, child, parent, mimicked } in families(evidence) {
        let Some(mimicked) = mimicked else { continue };
        // The claim is about parents that are better than what their children mimic.
        if good(parent).value <= good(mimicked).value {
            continue;
        }
        let (verdict, both) = evidence.more_good(cell, mimicked);
        verdicts.push(verdict);
        let (live, parent) = (cell.outcome.live, child.parent_slot);
        rows.push(format!("live {live}, child of {parent} as {0} against the recorded {0}: {both}", child.mimics));
    }
    if rows.is_empty() {
        return Claim::unmeasured(
            id,
            experiments,
            finding,
            "No generated experience beside its parent and the hour it mimics",
        );
    }
    let (verdict, why) = all_of(&verdicts);
    Claim { id, experiments, finding, ours: format!("Good localisations, {}.", listed(&rows)), verdict, why }
}

/// C3: children track their parents.
pub(super) fn like_parent_like_child(evidence: &Evidence) -> Claim {
    const LEAST: f64 = 0.8;
    let (id, experiments) = ("C3", "X11");
    let finding = "Generated experiences track their parent: rank correlation of good localisations above 0.8; dead parents have dead children.";
    let pairs: Vec<(f64, f64)> =
        families(evidence).iter().map(|family| (good(family.parent).value, good(family.cell).value)).collect();
    let parents: BTreeSet<_> = families(evidence).iter().map(|family| family.child.parent).collect();
    if parents.len() < 3 || pairs.len() < 5 {
        let why = format!("{} children and {} parents: a rank correlation needs 5 and 3", pairs.len(), parents.len());
        return Claim::unmeasured(id, experiments, finding, &why);
    }
    let rho = rank_correlation(&pairs);
    // Fisher's transformation with the variance of ranks (Fieller, Hartley and Pearson 1957).
    let half = 1.96 * (1.06 / (pairs.len() as f64 - 3.0)).sqrt();
    let clamped = rho.clamp(-0.9999, 0.9999);
    let ends = [clamped.atanh() - half, clamped.atanh() + half].map(f64::tanh);
    let measured = Measured { value: rho, low: ends[0], high: ends[1] };
    let dead = pairs.iter().filter(|(parent, _)| *parent == 0.0);
    let (dead, alive) = (dead.clone().count(), dead.filter(|(_, child)| *child > 0.0).count());
    let verdict = match measured.exceeds(Measured { value: LEAST, low: LEAST, high: LEAST }) {
        Verdict::Holds if alive > 0 => Verdict::DoesNotHold,
        verdict => verdict,
    };
    let why = match verdict {
        Verdict::Holds => format!("The whole interval lies above {LEAST}, and no child of a dead parent localises."),
        Verdict::DoesNotHold if measured.high < LEAST => format!("The whole interval lies below {LEAST}."),
        Verdict::DoesNotHold => "Children of dead parents localise.".to_owned(),
        _ => format!("The interval contains {LEAST}: too few children."),
    };
    let ours = format!(
        "Rank correlation {rho:.2} [{:.2}, {:.2}] over {} children of {} parents; {alive} of {dead} children of dead parents localise.",
        measured.low,
        measured.high,
        pairs.len(),
        parents.len()
    );
    Claim { id, experiments, finding, ours, verdict, why }
}

/// Spearman's: the correlation of ranks, ties sharing the mean of theirs.
fn rank_correlation(pairs: &[(f64, f64)]) -> f64 {
    let ranks = |values: Vec<f64>| -> Vec<f64> {
        let rank = |value: f64| {
            let below = values.iter().filter(|other| **other < value).count() as f64;
            let equal = values.iter().filter(|other| **other == value).count() as f64;
            below + (equal - 1.0) / 2.0
        };
        values.iter().map(|value| rank(*value)).collect()
    };
    let (a, b) = (ranks(pairs.iter().map(|p| p.0).collect()), ranks(pairs.iter().map(|p| p.1).collect()));
    let mean = (pairs.len() as f64 - 1.0) / 2.0;
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>();
    let spread = (product(&a, &a) * product(&b, &b)).sqrt();
    if spread > 0.0 { product(&a, &b) / spread } else { 0.0 }
}

/// What a collective of generated experiences is held against.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Rival {
    Parent,
    Placebo,
}

/// C4: the generated collective beats its parent, and as many placebos of it.
pub(super) fn collective_beats(evidence: &Evidence, rival: Rival) -> Claim {
    let experiments = "X11, X12, X13, X14, X15";
    let (id, finding) = match rival {
        Rival::Parent => ("C4 parent", "The collective of generated experiences localises better than their parent."),
        Rival::Placebo => {
            ("C4 placebo", "It does so by more than luck among many: it beats as many placebos of the same parent.")
        }
    };
    let cells: Vec<&Cell> = evidence.cells(&GENERATED).collect();
    let mut rows = Vec::new();
    let mut verdicts = Vec::new();
    let mut seen = BTreeSet::new();
    for collective in cells.iter().filter(|cell| cell.outcome.members.len() > 1 && seen.insert(cell.outcome.key)) {
        let name = &collective.outcome.experience;
        let placebo =
            cells.iter().find(|c| c.beside(collective) && c.outcome.experience == format!("{name} (placebo)"));
        // Placebos stand beside collectives of generated members alone.
        let Some(placebo) = placebo else { continue };
        let children = |cell: &&&Cell| {
            let ids: Vec<_> = collective.outcome.members.iter().map(|member| member.id).collect();
            cell.beside(collective) && cell.child.is_some() && ids.contains(&cell.outcome.members[0].id)
        };
        let own: BTreeSet<_> = cells.iter().filter(children).map(|cell| cell.outcome.members[0].id).collect();
        if own.len() < collective.outcome.members.len() {
            // Recorded members are more than the claim speaks of.
            continue;
        }
        let parents: BTreeSet<_> =
            cells.iter().filter(children).filter_map(|c| c.child.map(|child| child.parent)).collect();
        let named = format!("{name} (parents)");
        let is_parent = |cell: &&&Cell| match parents.len() {
            1 => cell.is_recorded() && parents.contains(&cell.outcome.members[0].id),
            _ => cell.outcome.experience == named,
        };
        let other = match rival {
            Rival::Placebo => Some(placebo),
            Rival::Parent => cells.iter().filter(|cell| cell.beside(collective)).find(is_parent),
        };
        let Some(other) = other else { continue };
        let (verdict, both) = evidence.more_good(collective, other);
        verdicts.push(verdict);
        let against = match rival {
            Rival::Parent => "parents",
            Rival::Placebo => "placebos",
        };
        rows.push(format!("live {}, '{name}' against its {against}: {both}", collective.outcome.live));
    }
    if rows.is_empty() {
        return Claim::unmeasured(id, experiments, finding, "No collective of generated experiences with its placebos");
    }
    let (verdict, why) = all_of(&verdicts);
    Claim { id, experiments, finding, ours: format!("Good localisations, {}.", listed(&rows)), verdict, why }
}

/// C5: at live 08:00, children of 10:00 towards the afternoon beat those towards the morning.
pub(super) fn afternoon_beats_morning(evidence: &Evidence) -> Claim {
    let (id, experiments) = ("C5", "X12");
    let finding = "At live 08:00, children of 10:00 made to look like the afternoon localise better than those made to look like the morning.";
    let later = |child: &Child| child.mimics > child.parent_slot;
    let of_ten: Vec<Family<'_>> = (families(evidence).into_iter())
        .filter(|family| family.cell.outcome.live.minutes() == 480 && family.child.parent_slot.minutes() == 600)
        .collect();
    let side = |afternoon: bool| -> Vec<&Family<'_>> {
        of_ten
            .iter()
            .filter(|family| later(&family.child) == afternoon && family.child.mimics != family.child.parent_slot)
            .collect()
    };
    let mean = |side: &[&Family<'_>]| Measured::mean(&side.iter().map(|family| good(family.cell)).collect::<Vec<_>>());
    let (afternoon, morning) = (side(true), side(false));
    let (Some(of), Some(over)) = (mean(&afternoon), mean(&morning)) else {
        return Claim::unmeasured(id, experiments, finding, "No children of 10:00 both ways at live 08:00");
    };
    // Both sides' collectives meet the same frames: where there are such, their paired difference says more than two
    // means.
    let collective = |side: &[&Family<'_>]| {
        let ids: BTreeSet<_> = side.iter().map(|family| family.cell.outcome.members[0].id).collect();
        let mut cells = evidence.cells(&["X12"]).filter(|cell| cell.outcome.policy == "all");
        cells.find(|cell| cell.outcome.members.iter().map(|member| member.id).collect::<BTreeSet<_>>() == ids)
    };
    let means = format!("Mean of the afternoon's children {}, of the morning's {}", of.in_words(), over.in_words());
    match (collective(&afternoon), collective(&morning)) {
        (Some(together), Some(other)) if together.beside(other) => {
            let (verdict, both) = evidence.more_good(together, other);
            let why = "Judged by the two collectives, which answer the same frames.".to_owned();
            Claim { id, experiments, finding, ours: format!("{means}; all of a side together {both}."), verdict, why }
        }
        _ => {
            let why = "Judged by the means' intervals, each as wide as its members' together.".to_owned();
            Claim { id, experiments, finding, ours: format!("{means}."), verdict: of.exceeds(over), why }
        }
    }
}

fn good(cell: &Cell) -> Measured {
    Measured::good(&cell.outcome)
}

/// The first few of many.
fn listed(rows: &[String]) -> String {
    const SHOWN: usize = 6;
    let more = rows.len().saturating_sub(SHOWN);
    let shown = rows.iter().take(SHOWN).cloned().collect::<Vec<_>>().join("; ");
    if more > 0 { format!("{shown}; and {more} more") } else { shown }
}

#[cfg(test)]
mod tests {
    use super::rank_correlation;

    #[test]
    fn ranks_correlate_as_in_the_books() {
        // Wikipedia's worked example of Spearman's rho (IQ and hours of TV): -29/165.
        let pairs = [
            (106.0, 7.0),
            (100.0, 27.0),
            (86.0, 2.0),
            (101.0, 50.0),
            (99.0, 28.0),
            (103.0, 29.0),
            (97.0, 20.0),
            (113.0, 12.0),
            (112.0, 6.0),
            (110.0, 17.0),
        ];
        assert!((rank_correlation(&pairs) + 29.0 / 165.0).abs() < 1e-12);
        assert_eq!(rank_correlation(&[(1.0, 2.0), (1.0, 3.0)]), 0.0);
    }
}
