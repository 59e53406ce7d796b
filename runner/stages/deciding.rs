//! The decision stage: the control hub in lockstep over an experience or a collective, every candidate logged.

use crate::RunError;
use crate::evaluate::event_row::EventRow;
use crate::evaluate::{Judge, LiveMoment};
use crate::inputs::answers::FrameMatches;
use crate::inputs::contender::Contender;
use crate::inputs::table::{column, encode};
use crate::inputs::traversals::LiveTraversal;
use crate::stages::verifying::{Counts, to_verify};
use furrow_localiser::hub::{Candidate, Freshness, Hub, Membership, Moment, Offer, PairAnswer, PairId, Policy, Reason};
use furrow_model::TimeSlot;
use furrow_model::outcome::event;

/// One experience's answers to the live traversal.
pub(crate) struct Answers<'a> {
    pub contender: &'a Contender,
    pub matches: &'a [FrameMatches],
    pub counts: &'a Counts,
}

/// How answers become localisations.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rules {
    /// Each experience's best so many places are verified.
    pub candidates: u32,
    /// Inliers that a localisation must reach.
    pub threshold: u32,
    /// How a collective chooses.
    pub policy: Policy,
    /// The live traversal's time of day.
    pub slot: TimeSlot,
}

/// Runs the hub over the whole traversal.
pub(crate) fn decide(moments: &[LiveMoment], members: &[Answers<'_>], judge: &Judge, rules: Rules) -> Vec<EventRow> {
    let mut hub = Hub::new(Freshness::DEFAULT).needing(rules.policy.needed());
    let memberships: Vec<Membership> = (0..members.len()).map(|i| hub.register(PairId(i as u32))).collect();
    let mut rows = Vec::new();
    for (frame, moment) in moments.iter().enumerate() {
        let asked = rules.policy.asks(&members.iter().map(|member| offer(member, frame, rules)).collect::<Vec<_>>());
        let best: Vec<Option<Best>> = (members.iter().enumerate().zip(&asked))
            .map(|((i, member), asked)| best_verified(member, frame, rules, judge, i).filter(|_| *asked))
            .collect();
        let answers: Vec<(Membership, PairAnswer)> = (memberships.iter().zip(members).zip(&best))
            .map(|((pair, member), best)| (*pair, answer(member, best.as_ref(), rules.threshold)))
            .collect();
        let live = Moment { stamp_ns: moment.stamp_ns, travelled_m: moment.travelled_m };
        let decision = hub.step(live, &answers);
        for (member, answers) in members.iter().enumerate() {
            let chosen = best[member].as_ref().map(|best| best.node);
            // In lockstep every pair has answered this very frame, so each reason is about one of these answers.
            let reason = decision.reasons[member].1;
            rows.extend(Verdicts { frame, member, chosen, reason, asked: asked[member], rules }.rows(answers, judge));
        }
    }
    rows
}

fn offer(member: &Answers<'_>, frame: usize, rules: Rules) -> Offer {
    let matches = &member.matches[frame];
    let best = matches.candidates.first().filter(|_| !matches.new_place);
    Offer {
        apart_min: member.contender.slot.apart_min(rules.slot),
        log_likelihood: best.map(|candidate| candidate.log_likelihood),
    }
}

/// The verified candidate with most inliers; ties to the more likely.
struct Best {
    node: u32,
    log_likelihood: f64,
    inliers: u32,
}

fn best_verified(member: &Answers<'_>, frame: usize, rules: Rules, judge: &Judge, number: usize) -> Option<Best> {
    let matches = &member.matches[frame];
    let mut best: Option<Best> = None;
    for (rank, node) in to_verify(matches, rules.candidates).enumerate() {
        let Some(counted) = member.counts.get(&(frame as u32, node)) else { continue };
        if rules.policy == Policy::Oracle && judge.judge(frame, number, node).is_none_or(|judged| !judged.correct) {
            continue;
        }
        if best.as_ref().is_none_or(|best| counted.inliers > best.inliers) {
            let log_likelihood = matches.candidates[rank].log_likelihood;
            best = Some(Best { node, log_likelihood, inliers: counted.inliers });
        }
    }
    best
}

fn answer(member: &Answers<'_>, best: Option<&Best>, threshold: u32) -> PairAnswer {
    let candidate = |best: &Best| Candidate {
        node_stamp_ns: member.contender.record.nodes[best.node as usize].stamp_ns,
        log_likelihood: best.log_likelihood,
        inliers: best.inliers,
    };
    PairAnswer::of(best.map(candidate), threshold)
}

/// What one experience's candidates for one frame came to.
struct Verdicts {
    frame: usize,
    member: usize,
    chosen: Option<u32>,
    reason: Reason,
    asked: bool,
    rules: Rules,
}

impl Verdicts {
    fn rows(&self, answers: &Answers<'_>, judge: &Judge) -> Vec<EventRow> {
        let matches = &answers.matches[self.frame];
        let new_place = matches.new_place.then_some(EventRow {
            frame: self.frame,
            member: self.member,
            rank: 0,
            node: None,
            log_likelihood: matches.new_place_log_likelihood,
            new_place_log_likelihood: matches.new_place_log_likelihood,
            posterior: matches.new_place_posterior,
            matches: None,
            inliers: None,
            decision: event::NEW_PLACE,
            error_m: None,
            correct: None,
        });
        let first = u32::from(matches.new_place);
        let candidates = (first..).zip(&matches.candidates).map(|(rank, candidate)| {
            let verified = self.asked && !matches.new_place && rank < self.rules.candidates;
            let counted = answers.counts.get(&(self.frame as u32, candidate.node)).filter(|_| verified);
            let inliers = counted.map(|counted| counted.inliers);
            let judged = judge.judge(self.frame, self.member, candidate.node);
            EventRow {
                frame: self.frame,
                member: self.member,
                rank,
                node: Some(candidate.node),
                log_likelihood: Some(candidate.log_likelihood),
                new_place_log_likelihood: matches.new_place_log_likelihood,
                posterior: candidate.posterior,
                matches: counted.map(|counted| counted.matches),
                inliers,
                decision: self.decision(candidate.node, inliers),
                error_m: judged.map(|judged| judged.error_m),
                correct: judged.map(|judged| judged.correct),
            }
        });
        new_place.into_iter().chain(candidates).collect()
    }

    fn decision(&self, node: u32, inliers: Option<u32>) -> &'static str {
        match (inliers, self.reason) {
            (None, _) => event::NOT_VERIFIED,
            (Some(inliers), _) if inliers < self.rules.threshold => event::REJECTED,
            _ if self.chosen.is_none() && self.rules.policy == Policy::Oracle => event::OVERRULED,
            (_, Reason::Alone) => event::ALONE,
            (_, Reason::Accepted) if self.chosen == Some(node) => event::ACCEPTED,
            _ => event::OUTVOTED,
        }
    }
}

/// The events as Parquet bytes.
pub(crate) fn events_table(
    rows: &[EventRow],
    live: &LiveTraversal,
    members: &[Answers<'_>],
    judge: &Judge,
) -> Result<Vec<u8>, RunError> {
    let poses = judge.moments();
    let frame = |row: &EventRow| &live.frames[row.frame];
    let node = |row: &EventRow| row.node.map(|node| members[row.member].contender.record.nodes[node as usize]);
    // In the table not a number stands for none.
    let stored = |number: Option<f64>| number.unwrap_or(f64::NAN);
    let columns = vec![
        column(event::LIVE_STAMP_NS, rows.iter().map(|row| frame(row).stamp_ns)),
        column(event::TRAVELLED_M, rows.iter().map(|row| poses[row.frame].travelled_m)),
        column(event::LIVE_IMAGE, rows.iter().map(|row| frame(row).left.to_string())),
        column(event::EXPERIENCE, rows.iter().map(|row| members[row.member].contender.id.to_string())),
        column(event::RANK, rows.iter().map(|row| row.rank)),
        column(event::NODE_STAMP_NS, rows.iter().map(|row| node(row).map(|node| node.stamp_ns))),
        column(event::NODE_IMAGE, rows.iter().map(|row| node(row).map(|node| node.left.to_string()))),
        column(event::LOG_LIKELIHOOD, rows.iter().map(|row| stored(row.log_likelihood))),
        column(event::NEW_PLACE_LOG_LIKELIHOOD, rows.iter().map(|row| stored(row.new_place_log_likelihood))),
        column(event::POSTERIOR, rows.iter().map(|row| stored(row.posterior))),
        column(event::MATCHES, rows.iter().map(|row| row.matches)),
        column(event::INLIERS, rows.iter().map(|row| row.inliers)),
        column(event::DECISION, rows.iter().map(|row| row.decision.to_owned())),
        column(event::ERROR_M, rows.iter().map(|row| row.error_m)),
        column(event::CORRECT, rows.iter().map(|row| row.correct)),
        column(event::EAST_M, rows.iter().map(|row| poses[row.frame].truth.map(|pose| pose.east_m))),
        column(event::NORTH_M, rows.iter().map(|row| poses[row.frame].truth.map(|pose| pose.north_m))),
    ];
    Ok(encode("events", rows.len(), columns)?)
}
