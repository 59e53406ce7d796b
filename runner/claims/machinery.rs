//! C9 to C11: the lost-distance table, the gate on generators, and the hub's handover.

use super::evidence::Evidence;
use super::verdict::{Claim, Verdict, all_of};
use crate::RunError;
use crate::evaluate::{Event, lost_distance};
use furrow_catalog::records::GateRecord;
use furrow_catalog::{Catalog, records, tables};
use furrow_generator::kinds::OTF;
use furrow_localiser::Hub;
use furrow_localiser::hub::{Candidate, Decision, Freshness, Membership, Moment, PairAnswer, PairId};
use furrow_model::outcome::event;
use furrow_model::{Censored, ObjectId, Outcome, SwitchIndex};
use std::collections::{BTreeMap, BTreeSet};

/// Fig 6.3: five lost stretches of 10 m against one of 50 m, on 100 m: distance, then survival of each by the
/// definitions of [`lost_distance`].
const TABLE: [(f64, f64, f64); 5] =
    [(0.0, 0.50, 0.50), (5.0, 0.25, 0.45), (10.0, 0.0, 0.40), (25.0, 0.0, 0.25), (50.0, 0.0, 0.0)];

/// C9: the curve tells many short losses from one long one of the same share.
pub(super) fn lost_distance_table() -> Claim {
    let finding = "Of two robots lost for half of 100 m, the one lost once for 50 m is worse than the one lost five times for 10 m.";
    let often = [(5.0, 15.0), (25.0, 35.0), (45.0, 55.0), (65.0, 75.0), (85.0, 95.0)];
    let (often, once) = (survival(&often), survival(&[(20.0, 70.0)]));
    let off = |curve: &BTreeMap<u64, f64>, metres: f64, expected: f64| {
        curve.get(&metres.to_bits()).is_none_or(|found| *found != expected)
    };
    let wrong = TABLE.iter().filter(|(d, a, b)| off(&often, *d, *a) || off(&once, *d, *b)).count();
    let ours = format!(
        "{} of {} rows computed by hand for the two robots of Fig 6.3 come out exactly.",
        TABLE.len() - wrong,
        TABLE.len()
    );
    let verdict = if wrong == 0 { Verdict::Holds } else { Verdict::DoesNotHold };
    let why = "Arithmetic on two made-up drives: no interval.".to_owned();
    Claim { id: "C9", experiments: "X5 (synthetic)", finding, ours, verdict, why }
}

/// The survival curve of a robot that is lost in these stretches of 100 m and localised every 0.1 m elsewhere, by
/// distance.
fn survival(lost: &[(f64, f64)]) -> BTreeMap<u64, f64> {
    let event = |i: u32| {
        let travelled_m = f64::from(i) / 10.0;
        let localised = !lost.iter().any(|(from, to)| travelled_m > *from && travelled_m < *to);
        Event { travelled_m, localised }
    };
    let events: Vec<Event> = (0..=1000).map(event).collect();
    let curve = lost_distance(&events, 0.0, 100.0, Censored::Keep).curve;
    curve.into_iter().map(|point| (point.distance_m.to_bits(), point.survival)).collect()
}

/// C10: the gate finds a generator that switches, and passes optimal-transport flow, which leaves an image alone at z =
/// 0.
pub(super) fn gate(catalog: &Catalog) -> Result<Claim, RunError> {
    let (id, experiments) = ("C10", "X04, X06");
    let finding = "The switch index flags a generator that jumps from source to target at z = 0.5 and passes one that moves evenly.";
    // 21 images, z = 0 to 1: the source's up to 0.45, then the target's, 25 grey levels away.
    let mut hard = [0.0; 20];
    hard[9] = 25.0;
    let flagged = SwitchIndex::of(&hard).is_some_and(|switch| switch.switches());
    let mut switches: BTreeMap<(String, ObjectId), SwitchIndex> = BTreeMap::new();
    let (mut still, mut moved) = (0, 0);
    for row in catalog.generators()?.into_iter().filter(|row| row.kind == OTF) {
        for gate in catalog.gates(row.id)? {
            let record: GateRecord = records::read(catalog.objects(), gate.object)?;
            switches.extend(record.switch.map(|switch| ((row.name.clone(), ObjectId(gate.parent.0)), switch)));
            if gate.domainness == 0.0 {
                let same = record.measures.descriptor_distance == 0.0;
                (still, moved) = (still + u32::from(same), moved + u32::from(!same));
            }
        }
    }
    if switches.is_empty() {
        return Ok(Claim::unmeasured(id, experiments, finding, "No optimal-transport flow was measured in this store"));
    }
    let passes = |switch: &SwitchIndex| if switch.switches() { Verdict::DoesNotHold } else { Verdict::Holds };
    let mut verdicts: Vec<Verdict> = switches.values().map(passes).collect();
    let uneven: Vec<&str> =
        switches.iter().filter(|(_, switch)| switch.switches()).map(|((name, _), _)| name.as_str()).collect();
    verdicts.push(if flagged && moved == 0 { Verdict::Holds } else { Verdict::DoesNotHold });
    let worst = switches.values().map(|switch| switch.kappa).fold(0.0, f64::max);
    let ours = format!(
        "The hard switch is {}flagged; of {} flows {} switch{}{} (largest index {worst:.1}); at z = 0 {still} leave every descriptor as it is, \
         {moved} do not.",
        if flagged { "" } else { "not " },
        switches.len(),
        uneven.len(),
        if uneven.is_empty() { "" } else { ": " },
        uneven.join(", "),
    );
    let why = "Every flow that this store's gate measured is judged; the measures are exact: no interval.".to_owned();
    Ok(Claim { id, experiments, finding, ours, verdict: all_of(&verdicts).0, why })
}

/// A live frame as the hub saw it: every member's verified answer.
struct Asked {
    moment: Moment,
    answers: Vec<PairAnswer>,
}

/// C11: when the winning pair is taken away, the next best localises the very next frame; put back, it is as if it had
/// never been gone.
pub(super) fn handover(catalog: &Catalog, evidence: &Evidence) -> Result<Claim, RunError> {
    let (id, experiments) = ("C11", "X10");
    let finding = "Taking the winning pair away mid-run hands over within one frame; putting it back is seamless.";
    let (mut tried, mut late, mut seams) = (0, 0, 0);
    let mut seen = BTreeSet::new();
    let cells = evidence.runs.values().flat_map(|ran| &ran.cells);
    for cell in cells.filter(|cell| cell.outcome.members.len() > 1 && cell.outcome.policy == "all") {
        if seen.insert(cell.outcome.key) {
            let frames = asked(catalog, &cell.outcome)?;
            let (t, l, s) = taken_away(&frames);
            (tried, late, seams) = (tried + t, late + l, seams + s);
        }
    }
    if tried == 0 {
        return Ok(Claim::unmeasured(
            id,
            experiments,
            finding,
            "No collective in which a second member localises where the first wins",
        ));
    }
    let ours = format!(
        "The winner was taken away {tried} times where another had an answer to the next frame: {late} handovers came late or were wrong; put \
         back a frame later, {seams} decisions were not those of a hub left alone."
    );
    let why = "Counted over every collective's recorded answers, replayed: no interval.".to_owned();
    let verdict = if late + seams == 0 { Verdict::Holds } else { Verdict::DoesNotHold };
    Ok(Claim { id, experiments, finding, ours, verdict, why })
}

/// What every member answered, frame by frame, from the cell's table of events.
fn asked(catalog: &Catalog, outcome: &Outcome) -> Result<Vec<Asked>, RunError> {
    let table = tables::from_parquet("events", catalog.objects().read(outcome.events)?)?;
    let stamps = tables::i64s(&table, event::LIVE_STAMP_NS)?;
    let metres = tables::f64s(&table, event::TRAVELLED_M)?;
    let experiences = tables::object_ids(&table, event::EXPERIENCE)?;
    let inliers = tables::optional_u32s(&table, event::INLIERS)?;
    let likelihood = tables::f64s(&table, event::LOG_LIKELIHOOD)?;
    let nobody = vec![PairAnswer::NewPlace; outcome.members.len()];
    let mut frames: BTreeMap<i64, Asked> = BTreeMap::new();
    for i in 0..stamps.len() {
        let moment = Moment { stamp_ns: stamps[i], travelled_m: metres[i] };
        let frame = frames.entry(stamps[i]).or_insert_with(|| Asked { moment, answers: nobody.clone() });
        let member = outcome.members.iter().position(|member| member.id.0 == experiences[i].0);
        let (Some(member), Some(inliers)) = (member, inliers[i]) else { continue };
        let candidate = Candidate { node_stamp_ns: i as i64, log_likelihood: likelihood[i], inliers };
        let better = match frame.answers[member] {
            PairAnswer::Accepted(known) | PairAnswer::Rejected(known) => inliers > known.inliers,
            PairAnswer::NewPlace => true,
        };
        if better {
            frame.answers[member] = PairAnswer::of(Some(candidate), outcome.threshold_inliers);
        }
    }
    Ok(frames.into_values().collect())
}

/// For every frame with a winner: takes it away before the next, where another member has an accepted answer, and puts
/// it back one frame later. How often that was tried, how often the next frame was not the best remaining member's, how
/// often later decisions differed.
fn taken_away(frames: &[Asked]) -> (usize, usize, usize) {
    let members = frames.first().map_or(0, |frame| frame.answers.len());
    let (mut tried, mut late, mut seams) = (0, 0, 0);
    for k in 0..frames.len().saturating_sub(2) {
        let mut hub = Hub::new(Freshness::DEFAULT);
        let mut pairs: Vec<Option<Membership>> = (0..members).map(|i| Some(hub.register(PairId(i as u32)))).collect();
        let mut alone = hub.clone();
        let all = pairs.clone();
        // Answers are fresh for a metre and a second: what was long before does not matter.
        for frame in &frames[k.saturating_sub(20)..k] {
            step(&mut hub, &pairs, frame);
            step(&mut alone, &all, frame);
        }
        step(&mut alone, &all, &frames[k]);
        let Some(winner) = step(&mut hub, &pairs, &frames[k]).winner.map(|winner| winner.pair.0 as usize) else {
            continue;
        };
        let rest = frames[k + 1].answers.iter().enumerate().filter(|(i, _)| *i != winner);
        let accepted = rest.filter_map(|(i, answer)| match answer {
            PairAnswer::Accepted(candidate) => Some((i, candidate.inliers)),
            _ => None,
        });
        let Some(most) = accepted.clone().map(|(_, inliers)| inliers).max() else { continue };
        tried += 1;
        if let Some(membership) = pairs[winner].take() {
            hub.deregister(membership);
        }
        let next = step(&mut hub, &pairs, &frames[k + 1]).winner;
        late += usize::from(
            next.is_none_or(|next| !accepted.clone().any(|(i, inliers)| i == next.pair.0 as usize && inliers == most)),
        );
        step(&mut alone, &all, &frames[k + 1]);
        pairs[winner] = Some(hub.register(PairId(winner as u32)));
        let place = |decision: Decision| decision.winner.map(|winner| (winner.pair, winner.candidate.node_stamp_ns));
        let again = place(step(&mut hub, &pairs, &frames[k + 2]));
        seams += usize::from(again != place(step(&mut alone, &all, &frames[k + 2])));
    }
    (tried, late, seams)
}

fn step(hub: &mut Hub, pairs: &[Option<Membership>], frame: &Asked) -> Decision {
    let answers: Vec<(Membership, PairAnswer)> =
        pairs.iter().zip(&frame.answers).filter_map(|(pair, answer)| pair.map(|pair| (pair, *answer))).collect();
    hub.step(frame.moment, &answers)
}
