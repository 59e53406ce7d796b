//! A cell's last step: decided, evaluated and entered.

use super::deciding::{Answers, Rules, decide, events_table};
use super::shared::Shared;
use crate::RunError;
use crate::evaluate::{self, Decided, Judge, evaluate};
use crate::inputs::contender::Contender;
use crate::inputs::traversals::LiveTraversal;
use crate::plan::PlannedCell;
use furrow_catalog::records;
use furrow_model::{CodebookId, Member, Outcome};

/// Thresholds that are reported beside the one in use (Church 2023, Fig 3.5).
const THRESHOLD_FACTORS: [f64; 3] = [0.75, 1.0, 1.5];

impl Shared<'_> {
    /// Decides and evaluates a cell, and enters its outcome.
    pub(super) fn finish_cell(
        &self,
        cell: &PlannedCell,
        traversal: &LiveTraversal,
        members: &[Answers<'_>],
        threshold: u32,
    ) -> Result<Outcome, RunError> {
        let objects = self.catalog.objects();
        let matrix = &self.plan.matrix;
        let contenders: Vec<&Contender> = members.iter().map(|member| member.contender).collect();
        let judge = Judge::new(objects, traversal, &contenders, matrix.keyframes)?;
        let at = |threshold: u32| {
            let candidates = matrix.localiser.candidates;
            let rules = Rules { candidates, threshold, policy: cell.policy, slot: traversal.record.slot };
            Decided { threshold, rows: decide(judge.moments(), members, &judge, rules) }
        };
        let decided = at(threshold);
        let others = THRESHOLD_FACTORS.map(|factor| at((f64::from(threshold) * factor).round() as u32));
        let rules = evaluate::Rules { censored: matrix.evaluation.censored };
        let member = |contender: &&Contender| Member {
            id: contender.id,
            slot: contender.slot,
            nodes: contender.record.nodes.len() as u32,
        };
        for contender in &contenders {
            objects.write(&records::encode(&contender.record)?)?;
        }
        let outcome = Outcome {
            key: cell.key,
            live: traversal.record.slot,
            live_traversal: traversal.id,
            experience: cell.label.clone(),
            policy: cell.policy.to_string(),
            members: contenders.iter().map(member).collect(),
            codebook: self.codebook.as_ref().map(|codebook| CodebookId(codebook.id.0)),
            codebook_words: self.codebook.as_ref().map_or(0, |codebook| codebook.codebook.vocabulary.len() as u32),
            hessian: self.features.hessian,
            upright: self.features.upright,
            method: matrix.localiser.method().to_owned(),
            threshold_inliers: threshold,
            keyframes: matrix.keyframes,
            evaluation: evaluate(&decided, &others, &judge, rules),
            events: objects.write(&events_table(&decided.rows, traversal, members, &judge)?)?,
        };
        self.catalog.enter_outcome(&outcome)?;
        Ok(outcome)
    }
}
