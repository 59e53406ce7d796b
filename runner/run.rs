//! The story of a run: codebook → threshold → generated experiences → words → matches → verification → decision → evaluation → outcome → contrasts.

use crate::codebook::{ReadyCodebook, codebook};
use crate::contrast::{Contrasts, contrasts};
use crate::deciding::{Answers, Rules, decide, events_table};
use crate::evaluate::{self, Decided, Judge, evaluate};
use crate::generation::stage::ready;
use crate::matching::{
    FabMapRules, LiveDescriptors, LiveThumbnails, Matches, external_matches, fabmap_matches, sequence_matches,
};
use crate::matrix::Method;
use crate::plan::{Contender, LivePass, Plan, PlannedCell};
use crate::progress::Progress;
use crate::threshold::needed;
use crate::verifying::{Counts, Unverified, verify_pass};
use crate::words::{Words, words};
use crate::{RunError, StageProgress};
use furrow_catalog::Catalog;
use furrow_catalog::records::{BlockedCell, FeatureParameters, RunCell, RunRecord};
use furrow_model::{CodebookId, Member, ObjectId, Outcome, RunId};
use std::collections::BTreeSet;

/// Thresholds that are reported beside the one in use (SPEC 7).
const THRESHOLD_FACTORS: [f64; 3] = [0.75, 1.0, 1.5];

/// What a run gave.
#[derive(Debug, Clone, PartialEq)]
pub struct RunResult {
    /// Its id: equal plans have equal ids.
    pub run: RunId,
    /// Its cells, in the matrix' order.
    pub cells: Vec<CellResult>,
    /// Which contenders beat which, where the matrix asks.
    pub contrasts: Contrasts,
    /// What the quality gate doubts of the generators that were used.
    pub doubts: Vec<String>,
}

/// What a cell gave.
#[derive(Debug, Clone, PartialEq)]
pub struct CellResult {
    /// The outcome.
    pub outcome: Outcome,
    /// Whether it was finished before this run.
    pub cached: bool,
}

/// Runs every cell of a plan that is not finished, and enters the run.
///
/// # Errors
/// [`RunError`]; what was finished before stays finished.
pub fn run(catalog: &Catalog, plan: &Plan, progress: Progress<'_>) -> Result<RunResult, RunError> {
    // The run is known from its plan: entered first, it shows in `status` also where it is killed.
    let run = catalog.enter_run(&record(plan))?;
    let mut fresh: Vec<Option<Outcome>> = vec![None; plan.cells.len()];
    let mut doubts = Vec::new();
    if plan.cells.iter().any(|cell| cell.outcome.is_none()) {
        let stages = Stages::prepare(catalog, plan, progress)?;
        doubts.clone_from(&stages.doubts);
        for live in 0..plan.lives.len() {
            stages.run_live(live, &mut fresh)?;
        }
    }
    let cells: Vec<CellResult> = (plan.cells.iter().zip(fresh))
        .filter_map(|(cell, fresh)| match (&cell.outcome, fresh) {
            (_, Some(outcome)) => Some(CellResult { outcome, cached: false }),
            (Some(outcome), None) => Some(CellResult { outcome: outcome.clone(), cached: true }),
            (None, None) => None,
        })
        .collect();
    let outcomes: Vec<&Outcome> = cells.iter().map(|cell| &cell.outcome).collect();
    let contrasts = match &plan.contrasts {
        Some(asked) => contrasts(catalog.objects(), asked, &outcomes)?,
        None => Contrasts::default(),
    };
    Ok(RunResult { run, cells, contrasts, doubts })
}

/// The run's record: what was asked, cell by cell.
pub fn record(plan: &Plan) -> RunRecord {
    let cell = |cell: &PlannedCell| RunCell {
        key: cell.key,
        live: plan.lives[cell.live].record.slot,
        experience: cell.label.clone(),
    };
    let blocked = |blocked: &crate::Blocked| BlockedCell {
        live: blocked.live,
        experience: blocked.experience.clone(),
        reason: blocked.reason.clone(),
    };
    RunRecord {
        name: plan.matrix.name.clone(),
        site: plan.matrix.site.clone(),
        source: plan.source.clone(),
        figures: plan.matrix.report.figures.iter().map(|figure| figure.name().to_owned()).collect(),
        cells: plan.cells.iter().map(cell).collect(),
        blocked: plan.blocked.iter().map(blocked).collect(),
        contrasts: plan.contrasts.clone(),
    }
}

/// The plan's contenders, those of unfinished cells with their own images; and what is doubted of their generators.
fn made(catalog: &Catalog, plan: &Plan, progress: Progress<'_>) -> Result<(Vec<Contender>, Vec<String>), RunError> {
    let unfinished = plan.cells.iter().filter(|cell| cell.outcome.is_none());
    let needed: BTreeSet<usize> = unfinished.flat_map(|cell| cell.members.iter().copied()).collect();
    let (mut contenders, mut doubts) = (plan.contenders.clone(), Vec::new());
    for i in needed {
        let (contender, doubted) = ready(catalog, &contenders[i], progress)?;
        contenders[i] = contender;
        doubts.extend(doubted);
    }
    Ok((contenders, doubts))
}

/// A live pass as its recogniser sees it.
enum LiveView<'a> {
    Words(Words),
    Thumbnails(LiveThumbnails),
    Descriptors(LiveDescriptors<'a>),
}

/// What all cells share.
struct Stages<'a> {
    catalog: &'a Catalog,
    plan: &'a Plan,
    progress: Progress<'a>,
    codebook: ReadyCodebook,
    features: FeatureParameters,
    /// The plan's contenders; those of unfinished cells made.
    contenders: Vec<Contender>,
    doubts: Vec<String>,
}

impl<'a> Stages<'a> {
    fn prepare(catalog: &'a Catalog, plan: &'a Plan, progress: Progress<'a>) -> Result<Self, RunError> {
        let Some(spec) = &plan.codebook else {
            return Err(RunError::Plan("the plan has cells but no codebook".to_owned()));
        };
        let ready = codebook(catalog, spec, progress)?;
        let (contenders, doubts) = made(catalog, plan, progress)?;
        Ok(Self { catalog, plan, progress, codebook: ready, features: spec.features, contenders, doubts })
    }

    /// The inliers that a localisation of this pass needs: what wrong places reach by chance depends on how many cameras look.
    fn threshold(&self, pass: &LivePass) -> Result<u32, RunError> {
        needed(self.catalog.objects(), self.plan, &pass.record.rig, self.features, self.progress)
    }

    /// All unfinished cells of one live pass, so that each live pair is prepared once.
    fn run_live(&self, live: usize, fresh: &mut [Option<Outcome>]) -> Result<(), RunError> {
        let cells: Vec<usize> = (0..self.plan.cells.len())
            .filter(|i| self.plan.cells[*i].live == live && self.plan.cells[*i].outcome.is_none())
            .collect();
        let mut needed: Vec<usize> = cells.iter().flat_map(|i| self.plan.cells[*i].members.iter().copied()).collect();
        needed.sort_unstable();
        needed.dedup();
        if needed.is_empty() {
            return Ok(());
        }
        let pass = &self.plan.lives[live];
        let view = self.view(pass)?;
        let matched: Vec<Matches> =
            needed.iter().map(|i| self.matches(pass, &view, &self.contenders[*i])).collect::<Result<_, _>>()?;
        let unverified: Vec<Unverified<'_>> = needed
            .iter()
            .zip(&matched)
            .map(|(i, matches)| Unverified { contender: &self.contenders[*i], matches })
            .collect();
        let candidates = self.plan.matrix.localiser.candidates;
        let asked = (candidates, self.features);
        let counts = verify_pass(self.catalog.objects(), pass, &unverified, asked, self.progress)?;
        let threshold = self.threshold(pass)?;
        let answers_of = |i: &usize| -> Option<Answers<'_>> {
            let place = needed.iter().position(|needed| needed == i)?;
            let (matches, counts): (&Matches, &Counts) = (&matched[place], &counts[place]);
            Some(Answers { contender: &self.contenders[*i], matches: &matches.frames, counts })
        };
        for i in cells {
            let cell = &self.plan.cells[i];
            let members: Vec<Answers<'_>> = cell.members.iter().filter_map(answers_of).collect();
            fresh[i] = Some(self.finish_cell(cell, pass, &members, threshold)?);
            (self.progress)(StageProgress { stage: "cells", done: i as u64 + 1, total: self.plan.cells.len() as u64 });
        }
        Ok(())
    }

    fn view(&self, pass: &LivePass) -> Result<LiveView<'_>, RunError> {
        let (objects, localiser) = (self.catalog.objects(), &self.plan.matrix.localiser);
        match (localiser.method, &self.plan.descriptors) {
            (Method::Seqslam, _) => LiveThumbnails::of(objects, pass, self.progress).map(LiveView::Thumbnails),
            (Method::External, Some(file)) => LiveDescriptors::of(file, pass).map(LiveView::Descriptors),
            _ => {
                let images: Vec<ObjectId> = pass.images().collect();
                let stage = format!("words of the live pass at {}", pass.record.slot);
                self.words(pass.record.calibration, &images, &stage).map(LiveView::Words)
            }
        }
    }

    fn words(&self, calibration: ObjectId, images: &[ObjectId], stage: &str) -> Result<Words, RunError> {
        let objects = self.catalog.objects();
        words(objects, calibration, images, &self.codebook, self.features, (stage, self.progress))
    }

    fn matches(&self, pass: &LivePass, view: &LiveView<'_>, contender: &Contender) -> Result<Matches, RunError> {
        let (objects, matrix) = (self.catalog.objects(), &self.plan.matrix);
        let candidates = matrix.localiser.candidates;
        match view {
            LiveView::Words(live) => {
                let images: Vec<ObjectId> = contender.images().collect();
                let stage = format!("words of the experience {}", contender.label);
                let map = self.words(contender.record.calibration, &images, &stage)?;
                let travelled_m: Vec<f64> = pass.chain.poses().iter().map(|pose| pose.travelled_m).collect();
                let spacing_m = matrix.keyframes.distance_m;
                let motion = matrix.localiser.motion.map(|motion| (motion, spacing_m, travelled_m.as_slice()));
                let rules = FabMapRules { verified: candidates, motion };
                fabmap_matches(objects, live, &map, &self.codebook, rules)
            }
            LiveView::Thumbnails(live) => {
                sequence_matches(objects, (pass, live), contender, &matrix.seqslam(), candidates, self.progress)
            }
            LiveView::Descriptors(live) => {
                external_matches(objects, (pass, live), contender, matrix.localiser.metric, candidates)
            }
        }
    }

    fn finish_cell(
        &self,
        cell: &PlannedCell,
        pass: &LivePass,
        members: &[Answers<'_>],
        threshold: u32,
    ) -> Result<Outcome, RunError> {
        let objects = self.catalog.objects();
        let matrix = &self.plan.matrix;
        let contenders: Vec<&Contender> = members.iter().map(|member| member.contender).collect();
        let judge = Judge::new(objects, pass, &contenders, matrix.keyframes)?;
        let at = |threshold: u32| {
            let candidates = matrix.localiser.candidates;
            let rules = Rules { candidates, threshold, policy: cell.policy, slot: pass.record.slot };
            Decided { threshold, rows: decide(judge.moments(), members, &judge, rules) }
        };
        let decided = at(threshold);
        let others = THRESHOLD_FACTORS.map(|factor| at((f64::from(threshold) * factor).round() as u32));
        let rules = evaluate::Rules { censored: matrix.evaluation.censored, seed: matrix.seed };
        let member = |contender: &&Contender| Member {
            id: contender.id,
            slot: contender.slot,
            nodes: contender.record.nodes.len() as u32,
        };
        for contender in &contenders {
            objects.write(&furrow_catalog::records::encode(&contender.record))?;
        }
        let outcome = Outcome {
            key: cell.key,
            live: pass.record.slot,
            live_traversal: pass.id,
            experience: cell.label.clone(),
            policy: cell.policy.to_string(),
            members: contenders.iter().map(member).collect(),
            codebook: CodebookId(self.codebook.id.0),
            codebook_words: matrix.codebook.words,
            method: matrix.localiser.method.name().to_owned(),
            threshold_inliers: threshold,
            keyframes: matrix.keyframes,
            evaluation: evaluate(&decided, &others, &judge, rules),
            events: objects.write(&events_table(&decided.rows, pass, members, &judge)?)?,
        };
        self.catalog.enter_outcome(&outcome)?;
        Ok(outcome)
    }
}
