//! The story of a run: codebook → threshold → generated experiences → words → matches → verification → decision → evaluation → outcome.

use crate::codebook::{ReadyCodebook, codebook};
use crate::deciding::{Answers, Rules, decide, events_table};
use crate::evaluate::{self, Decided, Judge, evaluate};
use crate::generation::stage::ready;
use crate::matching::{LiveDescriptors, LiveThumbnails, Matches, external_matches, fabmap_matches, sequence_matches};
use crate::matrix::Method;
use crate::plan::{Contender, LivePass, Plan, PlannedCell};
use crate::progress::Progress;
use crate::threshold::needed;
use crate::verifying::{Counts, Unverified, verify_pass};
use crate::words::{Words, words};
use crate::{RunError, StageProgress};
use furrow_catalog::Catalog;
use furrow_catalog::records::{BlockedCell, FeatureParameters, RunCell, RunRecord};
use furrow_model::{CodebookId, Member, ObjectId, Outcome};
use std::collections::{BTreeMap, BTreeSet};

/// Thresholds that are reported beside the one in use (SPEC 7).
const THRESHOLD_FACTORS: [f64; 3] = [0.75, 1.0, 1.5];

/// What a cell gave.
#[derive(Debug, Clone, PartialEq)]
pub struct CellResult {
    /// The outcome.
    pub outcome: Outcome,
    /// Whether it was finished before this run.
    pub cached: bool,
}

/// Cells that failed, and whether the others go on.
pub(crate) struct Faults {
    keep_going: bool,
    /// The first failure of each cell.
    reasons: BTreeMap<usize, String>,
}

impl Faults {
    pub fn new(keep_going: bool) -> Self {
        Self { keep_going, reasons: BTreeMap::new() }
    }

    /// Cells by their place in the plan, with the reason.
    pub fn reasons(&self) -> impl Iterator<Item = (usize, String)> + '_ {
        self.reasons.iter().map(|(cell, reason)| (*cell, reason.clone()))
    }

    /// What was computed for some cells; where it failed and the others go on, nothing.
    fn take<T>(
        &mut self,
        computed: Result<T, RunError>,
        cells: impl IntoIterator<Item = usize>,
    ) -> Result<Option<T>, RunError> {
        match computed {
            Ok(value) => Ok(Some(value)),
            Err(error) => {
                let reason = error.to_string();
                cells.into_iter().for_each(|cell| _ = self.reasons.entry(cell).or_insert_with(|| reason.clone()));
                if self.keep_going { Ok(None) } else { Err(error) }
            }
        }
    }

    fn spares(&self, cell: usize) -> bool {
        !self.reasons.contains_key(&cell)
    }
}

/// A plan's cells, `None` where one has no outcome; and what the quality gate doubts.
pub(crate) type Cells = (Vec<Option<CellResult>>, Vec<String>);

/// Computes every cell of a plan that is due.
pub(crate) fn cells_of(
    catalog: &Catalog,
    plan: &Plan,
    faults: &mut Faults,
    progress: Progress<'_>,
) -> Result<Cells, RunError> {
    let mut fresh: Vec<Option<Outcome>> = vec![None; plan.cells.len()];
    let mut doubts = Vec::new();
    if plan.cells.iter().any(PlannedCell::is_due)
        && let Some(stages) = Stages::prepare(catalog, plan, faults, progress)?
    {
        doubts.clone_from(&stages.doubts);
        for live in 0..plan.lives.len() {
            stages.run_live(live, &mut fresh, faults)?;
        }
    }
    let cell = |(cell, fresh): (&PlannedCell, Option<Outcome>)| match (&cell.outcome, fresh) {
        (_, Some(outcome)) => Some(CellResult { outcome, cached: false }),
        (Some(outcome), None) => Some(CellResult { outcome: outcome.clone(), cached: true }),
        (None, None) => None,
    };
    Ok((plan.cells.iter().zip(fresh).map(cell).collect(), doubts))
}

/// The run's record: what was asked, cell by cell.
pub fn record(plan: &Plan) -> RunRecord {
    let cell = |cell: &PlannedCell| RunCell {
        key: cell.key,
        live: plan.lives[cell.live].record.slot,
        experience: cell.label.clone(),
        setting: plan.setting.clone(),
    };
    let blocked = |blocked: &crate::Blocked| BlockedCell {
        live: blocked.live,
        experience: blocked.experience.clone(),
        reason: blocked.reason.clone(),
        setting: plan.setting.clone(),
    };
    RunRecord {
        name: plan.matrix.name.clone(),
        site: plan.matrix.site.clone(),
        source: plan.source.clone(),
        figures: plan.matrix.report.figures.iter().map(|figure| figure.name().to_owned()).collect(),
        cells: plan.cells.iter().map(cell).collect(),
        blocked: plan.blocked.iter().map(blocked).collect(),
        passes: Vec::new(),
        generators: Vec::new(),
        contrasts: plan.contrasts.iter().cloned().collect(),
    }
}

/// The plan's contenders, those of unfinished cells with their own images; and what is doubted of their generators.
fn made(
    catalog: &Catalog,
    plan: &Plan,
    faults: &mut Faults,
    progress: Progress<'_>,
) -> Result<(Vec<Contender>, Vec<String>), RunError> {
    let unfinished = plan.cells.iter().filter(|cell| cell.is_due());
    let needed: BTreeSet<usize> = unfinished.flat_map(|cell| cell.members.iter().copied()).collect();
    let (mut contenders, mut doubts) = (plan.contenders.clone(), Vec::new());
    for i in needed {
        let with =
            (0..plan.cells.len()).filter(|cell| plan.cells[*cell].is_due() && plan.cells[*cell].members.contains(&i));
        if let Some((contender, doubted)) = faults.take(ready(catalog, &contenders[i], progress), with)? {
            contenders[i] = contender;
            doubts.extend(doubted);
        }
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
    /// `None` where the codebook failed, and with it every cell.
    fn prepare(
        catalog: &'a Catalog,
        plan: &'a Plan,
        faults: &mut Faults,
        progress: Progress<'a>,
    ) -> Result<Option<Self>, RunError> {
        let Some(spec) = &plan.codebook else {
            return Err(RunError::Plan("the plan has cells but no codebook".to_owned()));
        };
        let due = (0..plan.cells.len()).filter(|cell| plan.cells[*cell].is_due());
        let Some(ready) = faults.take(codebook(catalog, spec, progress), due)? else { return Ok(None) };
        let (contenders, doubts) = made(catalog, plan, faults, progress)?;
        Ok(Some(Self { catalog, plan, progress, codebook: ready, features: spec.features, contenders, doubts }))
    }

    /// The inliers that a localisation of this pass needs: what wrong places reach by chance depends on how many cameras look.
    fn threshold(&self, pass: &LivePass) -> Result<u32, RunError> {
        needed(self.catalog.objects(), self.plan, &pass.record.rig, self.features, self.progress)
    }

    /// All unfinished cells of one live pass, so that each live pair is prepared once.
    fn run_live(&self, live: usize, fresh: &mut [Option<Outcome>], faults: &mut Faults) -> Result<(), RunError> {
        let due = |i: &usize| self.plan.cells[*i].live == live && self.plan.cells[*i].is_due();
        let cells: Vec<usize> = (0..self.plan.cells.len()).filter(due).filter(|i| faults.spares(*i)).collect();
        let mut needed: Vec<usize> = cells.iter().flat_map(|i| self.plan.cells[*i].members.iter().copied()).collect();
        needed.sort_unstable();
        needed.dedup();
        if needed.is_empty() {
            return Ok(());
        }
        let with = |member: usize| cells.iter().copied().filter(move |i| self.plan.cells[*i].members.contains(&member));
        let pass = &self.plan.lives[live];
        let Some(view) = faults.take(self.view(pass), cells.iter().copied())? else { return Ok(()) };
        let mut matched: Vec<(usize, Matches)> = Vec::new();
        for i in needed {
            let matches = faults.take(self.matches(pass, &view, &self.contenders[i]), with(i))?;
            matched.extend(matches.map(|matches| (i, matches)));
        }
        let counts = self.counts(pass, &matched, &with, faults)?;
        let Some(threshold) = faults.take(self.threshold(pass), cells.iter().copied())? else { return Ok(()) };
        let answers_of = |i: &usize| -> Option<Answers<'_>> {
            let place = matched.iter().position(|(needed, _)| needed == i)?;
            let (matches, counts): (&Matches, &Counts) = (&matched[place].1, counts[place].as_ref()?);
            Some(Answers { contender: &self.contenders[*i], matches: &matches.frames, counts })
        };
        for i in cells.iter().copied() {
            if !faults.spares(i) {
                continue;
            }
            let cell = &self.plan.cells[i];
            let members: Vec<Answers<'_>> = cell.members.iter().filter_map(answers_of).collect();
            fresh[i] = faults.take(self.finish_cell(cell, pass, &members, threshold), [i])?;
            (self.progress)(StageProgress { stage: "cells", done: i as u64 + 1, total: self.plan.cells.len() as u64 });
        }
        Ok(())
    }

    /// The counts of every experience that answered; where verification fails, of each one that it does not fail for.
    fn counts<I: Iterator<Item = usize>>(
        &self,
        pass: &LivePass,
        matched: &[(usize, Matches)],
        with: &impl Fn(usize) -> I,
        faults: &mut Faults,
    ) -> Result<Vec<Option<Counts>>, RunError> {
        let all: Vec<Unverified<'_>> =
            (matched.iter()).map(|(i, matches)| Unverified { contender: &self.contenders[*i], matches }).collect();
        let asked = (self.plan.matrix.localiser.candidates, self.features);
        let verify = |some: &[Unverified<'_>]| verify_pass(self.catalog.objects(), pass, some, asked, self.progress);
        match verify(&all) {
            Ok(counts) => Ok(counts.into_iter().map(Some).collect()),
            Err(error) if !faults.keep_going => {
                let cells: Vec<usize> = matched.iter().flat_map(|(i, _)| with(*i)).collect();
                faults.take(Err(error), cells).map(|_: Option<()>| Vec::new())
            }
            Err(_) => (all.iter().zip(matched))
                .map(|(one, (i, _))| {
                    let counts = faults.take(verify(std::slice::from_ref(one)), with(*i))?;
                    Ok(counts.and_then(|counts| counts.into_iter().next()))
                })
                .collect(),
        }
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
                fabmap_matches(objects, live, &map, &self.codebook, self.plan.fabmap_rules(&travelled_m))
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
            codebook_words: match matrix.codebook.words {
                0 => self.codebook.codebook.vocabulary.len() as u32,
                words => words,
            },
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
