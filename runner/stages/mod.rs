//! The stages of a plan: each finds or computes what the next one needs. They read objects and write objects; rows of the catalogue are
//! entered by `study` alone.

pub(crate) mod codebook;
pub(crate) mod deciding;
pub(crate) mod faults;
pub(crate) mod graph;
pub(crate) mod matching;
pub mod memory;
pub(crate) mod threshold;
mod training;
pub(crate) mod verifying;
pub(crate) mod words;

use crate::RunError;
use crate::evaluate::{self, Decided, Judge, evaluate};
use crate::generation::stage::ready;
use crate::inputs::answers::Matches;
use crate::inputs::codebook::CodebookPlan;
use crate::inputs::contender::Contender;
use crate::inputs::recogniser::Context;
use crate::inputs::traversals::LiveTraversal;
use crate::inputs::words::{ReadyCodebook, Words};
use crate::plan::{CellIx, ContenderIx, LiveIx, Plan, PlannedCell};
use crate::progress::{Progress, Stage, StageProgress, Subject};
use crate::stages::codebook::codebook;
use crate::stages::deciding::{Answers, Rules, decide, events_table};
use crate::stages::faults::Faults;
use crate::stages::threshold::inlier_threshold;
use crate::stages::verifying::{Asking, Counts, Unverified, verify_pass};
use crate::stages::words::words;
use furrow_catalog::records::FeatureParameters;
use furrow_catalog::{Catalog, Objects};
use furrow_model::{CodebookId, Member, ObjectId, Outcome};
use rayon::prelude::*;

/// Thresholds that are reported beside the one in use (Church 2023, Fig 3.5).
const THRESHOLD_FACTORS: [f64; 3] = [0.75, 1.0, 1.5];

/// What all cells share.
pub(crate) struct Stages<'a> {
    catalog: &'a Catalog,
    plan: &'a Plan,
    progress: Progress<'a>,
    /// None where the recogniser knows no words.
    codebook: Option<ReadyCodebook>,
    features: FeatureParameters,
    /// The plan's contenders, generated ones as far as they were made.
    contenders: Vec<Contender>,
    /// Why generators are to be doubted.
    pub doubts: Vec<String>,
    /// Bytes that verification stays within.
    pub memory: u64,
}

/// What some experiences answered a live pass, as far as they did: each by its place among the plan's, with its candidates' inliers.
pub(crate) struct Answered {
    matched: Vec<(ContenderIx, Matches)>,
    counts: Vec<Option<Counts>>,
}

impl<'a> Stages<'a> {
    /// Finds or trains the codebook, where the recogniser has words.
    pub fn begin(catalog: &'a Catalog, plan: &'a Plan, progress: Progress<'a>) -> Result<Self, RunError> {
        let stages = Self::without_words(catalog, plan, progress)?;
        let codebook = codebook_of(plan).map(|spec| codebook(catalog, spec, progress)).transpose()?;
        Ok(Self { codebook, ..stages })
    }

    /// The stages that need no codebook.
    pub fn without_words(catalog: &'a Catalog, plan: &'a Plan, progress: Progress<'a>) -> Result<Self, RunError> {
        let Some(spec) = &plan.codebook else {
            return Err(RunError::Codebook("the plan has cells but no codebook".to_owned()));
        };
        let (contenders, doubts) = (plan.contenders.clone(), Vec::new());
        let (features, memory) = (spec.features, crate::stages::memory::usual());
        Ok(Self { catalog, plan, progress, codebook: None, features, contenders, doubts, memory })
    }

    /// All that is shared by cells that are due. `None` where the codebook failed, and with it every cell.
    pub fn prepare(
        catalog: &'a Catalog,
        plan: &'a Plan,
        faults: &mut Faults,
        progress: Progress<'a>,
    ) -> Result<Option<Self>, RunError> {
        let due = plan.due_cells();
        let Some(mut stages) = faults.take(Self::begin(catalog, plan, progress), due.iter().copied())? else {
            return Ok(None);
        };
        for member in plan.members(&due) {
            let with = due.iter().copied().filter(|cell| plan.cell(*cell).members.contains(&member));
            faults.take(stages.make(member), with)?;
        }
        Ok(Some(stages))
    }

    fn contender(&self, contender: ContenderIx) -> &Contender {
        &self.contenders[contender.0]
    }

    /// Gives a contender its own images, where it is generated.
    pub fn make(&mut self, contender: ContenderIx) -> Result<(), RunError> {
        let (made, doubts) = ready(self.catalog, self.contender(contender), self.progress)?;
        self.contenders[contender.0] = made;
        self.doubts.extend(doubts);
        Ok(())
    }

    /// The inliers that a localisation of this pass needs: what wrong places reach by chance depends on how many cameras look.
    pub fn threshold(&self, live: LiveIx) -> Result<u32, RunError> {
        let rig = &self.plan.live(live).record.rig;
        inlier_threshold(self.catalog.objects(), self.plan, rig, self.features, self.progress)
    }

    /// The words of a live pass' frames, where the recogniser has words.
    pub fn live_words(&self, live: LiveIx) -> Result<(), RunError> {
        match self.plan.recogniser.needs_codebook() {
            true => Context::live_words(self, self.plan.live(live)).map(|_| ()),
            false => Ok(()),
        }
    }

    /// The words of a contender's nodes, where the recogniser has words.
    pub fn contender_words(&self, contender: ContenderIx) -> Result<(), RunError> {
        match self.plan.recogniser.needs_codebook() {
            true => Context::contender_words(self, self.contender(contender)).map(|_| ()),
            false => Ok(()),
        }
    }

    /// What the members of some cells of one live pass answer it, verified; so each live pair is prepared once. `None` where the pass itself
    /// fails.
    pub fn answered(&self, live: LiveIx, cells: &[CellIx], faults: &mut Faults) -> Result<Option<Answered>, RunError> {
        let with = |member: ContenderIx| {
            cells.iter().copied().filter(move |cell| self.plan.cell(*cell).members.contains(&member))
        };
        let pass = self.plan.live(live);
        let looked = self.plan.recogniser.look_at(self, pass);
        let Some(answer) = faults.take(looked, cells.iter().copied())? else { return Ok(None) };
        let mut matched: Vec<(ContenderIx, Matches)> = Vec::new();
        for i in self.plan.members(cells) {
            let matches = faults.take(answer(self.contender(i)), with(i))?;
            matched.extend(matches.map(|matches| (i, matches)));
        }
        let counts = self.counts(pass, &matched, &with, faults)?;
        Ok(Some(Answered { matched, counts }))
    }

    /// All unfinished cells of one live pass.
    pub fn run_live(&self, live: LiveIx, fresh: &mut [Option<Outcome>], faults: &mut Faults) -> Result<(), RunError> {
        let due = |i: &CellIx| self.plan.cell(*i).live == live && faults.spares(*i);
        let cells: Vec<CellIx> = self.plan.due_cells().into_iter().filter(due).collect();
        if cells.is_empty() {
            return Ok(());
        }
        let Some(Answered { matched, counts }) = self.answered(live, &cells, faults)? else { return Ok(()) };
        let Some(threshold) = faults.take(self.threshold(live), cells.iter().copied())? else { return Ok(()) };
        let answers_of = |i: &ContenderIx| -> Option<Answers<'_>> {
            let place = matched.iter().position(|(needed, _)| needed == i)?;
            let (matches, counts): (&Matches, &Counts) = (&matched[place].1, counts[place].as_ref()?);
            Some(Answers { contender: self.contender(*i), matches: &matches.frames, counts })
        };
        let spared: Vec<CellIx> = cells.into_iter().filter(|i| faults.spares(*i)).collect();
        let finish = |i: &CellIx| {
            let cell = self.plan.cell(*i);
            let members: Vec<Answers<'_>> = cell.members.iter().filter_map(answers_of).collect();
            let finished = self.finish_cell(cell, self.plan.live(live), &members, threshold);
            let (done, total) = (i.0 as u64 + 1, self.plan.cells.len() as u64);
            (self.progress)(StageProgress::whole(Stage::Cells, done, total));
            finished
        };
        let finished: Vec<Result<Outcome, RunError>> = spared.par_iter().map(finish).collect();
        for (i, finished) in spared.into_iter().zip(finished) {
            fresh[i.0] = faults.take(finished, [i])?;
        }
        Ok(())
    }

    /// The counts of every experience that answered; where verification fails, of each one that it does not fail for.
    fn counts<I: Iterator<Item = CellIx>>(
        &self,
        pass: &LiveTraversal,
        matched: &[(ContenderIx, Matches)],
        with: &impl Fn(ContenderIx) -> I,
        faults: &mut Faults,
    ) -> Result<Vec<Option<Counts>>, RunError> {
        let all: Vec<Unverified<'_>> =
            (matched.iter()).map(|(i, matches)| Unverified { contender: self.contender(*i), matches }).collect();
        let candidates = self.plan.matrix.localiser.candidates;
        let asking = Asking { candidates, features: self.features, memory: self.memory };
        let verify = |some: &[Unverified<'_>]| verify_pass(self.catalog.objects(), pass, some, asking, self.progress);
        match verify(&all) {
            Ok(counts) => Ok(counts.into_iter().map(Some).collect()),
            Err(error) if !faults.keep_going => {
                let cells: Vec<CellIx> = matched.iter().flat_map(|(i, _)| with(*i)).collect();
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

    fn finish_cell(
        &self,
        cell: &PlannedCell,
        pass: &LiveTraversal,
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
            objects.write(&furrow_catalog::records::encode(&contender.record)?)?;
        }
        let outcome = Outcome {
            key: cell.key,
            live: pass.record.slot,
            live_traversal: pass.id,
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
            events: objects.write(&events_table(&decided.rows, pass, members, &judge)?)?,
        };
        self.catalog.enter_outcome(&outcome)?;
        Ok(outcome)
    }
}

impl Context for Stages<'_> {
    fn objects(&self) -> &Objects {
        self.catalog.objects()
    }

    fn progress(&self) -> Progress<'_> {
        self.progress
    }

    fn codebook(&self) -> Result<&ReadyCodebook, RunError> {
        self.codebook.as_ref().ok_or_else(|| RunError::Codebook("there is none, and words are asked for".to_owned()))
    }

    fn live_words(&self, live: &LiveTraversal) -> Result<Words, RunError> {
        let images: Vec<ObjectId> = live.images().collect();
        let progress = (Subject::Live(live.record.slot), self.progress);
        words(self.objects(), live.record.calibration, &images, self.codebook()?, self.features, progress)
    }

    fn contender_words(&self, contender: &Contender) -> Result<Words, RunError> {
        let images: Vec<ObjectId> = contender.images().collect();
        let progress = (Subject::experience(&contender.label), self.progress);
        words(self.objects(), contender.record.calibration, &images, self.codebook()?, self.features, progress)
    }
}

/// The codebook that the recogniser of a plan needs, where it has words.
pub(crate) fn codebook_of(plan: &Plan) -> Option<&CodebookPlan> {
    plan.codebook.as_ref().filter(|_| plan.recogniser.needs_codebook())
}
