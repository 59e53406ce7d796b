//! The local executor: walks the graph of one plan, step by step.

use super::conduct::Conduct;
use super::deciding::Answers;
use super::faults::Faults;
use super::graph::{Graph, NodeIx, Part, Step};
use super::shared::Shared;
use super::verifying::{Asking, Counts, Unverified, verify_traversal};
use super::words::WordImages;
use crate::RunError;
use crate::inputs::answers::Matches;
use crate::plan::{CellIx, ContenderIx, LiveIx, Plan};
use crate::progress::{Progress, Stage, StageProgress};
use furrow_catalog::Catalog;
use furrow_model::Outcome;
use rayon::prelude::*;
use std::collections::BTreeSet;

/// A plan's graph on its way.
pub(crate) struct Executor<'a> {
    graph: Graph<'a>,
    shared: Shared<'a>,
    faults: Faults,
    /// The steps that the walk is for.
    wanted: Vec<NodeIx>,
}

/// What an experience answered a live traversal, with its candidates' inliers.
struct Answered {
    contender: ContenderIx,
    matches: Matches,
    counts: Counts,
}

impl<'a> Executor<'a> {
    /// Over some cells of a plan.
    pub fn new(
        (catalog, plan, cells): (&'a Catalog, &'a Plan, Vec<CellIx>),
        conduct: Conduct,
        progress: Progress<'a>,
    ) -> Result<Self, RunError> {
        let mut shared = Shared::new(catalog, plan, progress)?;
        shared.memory = conduct.memory.unwrap_or(shared.memory);
        let graph = Graph::new(vec![Part { setting: 0, plan, cells }])?;
        Ok(Self { graph, shared, faults: Faults::new(conduct.keep_going), wanted: Vec::new() })
    }

    /// What the steps shared.
    pub fn shared(&self) -> &Shared<'a> {
        &self.shared
    }

    /// What the steps shared, to keep.
    pub fn into_shared(self) -> Shared<'a> {
        self.shared
    }

    /// The cells that failed, with the reason; also those that were not come to, but hang on what failed.
    pub fn failed_cells(&mut self) -> Vec<(CellIx, String)> {
        let mut failed = Vec::new();
        for (place, node) in self.graph.nodes().iter().enumerate() {
            if self.faults.is_blocked(NodeIx(place), &node.needs)
                && let (Step::Cell(cell), Some(reason)) = (node.step, self.faults.reason(NodeIx(place)))
            {
                failed.push((cell, reason.to_owned()));
            }
        }
        failed
    }

    /// Takes the steps that are wanted and all that they need, in order; the outcomes of cells among them.
    ///
    /// # Errors
    /// The first failure, unless the others go on.
    pub fn walk(&mut self, wanted: impl Fn(Step) -> bool) -> Result<Vec<(CellIx, Outcome)>, RunError> {
        let mut outcomes = Vec::new();
        let is_wanted = |place: &NodeIx| wanted(self.graph.nodes()[place.0].step);
        self.wanted = self.graph.places().filter(is_wanted).collect();
        let places = self.graph.with_needs(&self.wanted);
        let lives: Vec<(NodeIx, Option<LiveIx>)> = places.iter().map(|place| (*place, self.live_of(*place))).collect();
        for group in lives.chunk_by(|(_, a), (_, b)| a.is_some() && a == b) {
            let places: Vec<NodeIx> = group.iter().map(|(place, _)| *place).collect();
            match group[0].1 {
                Some(live) => outcomes.extend(self.localise(live, &places)?),
                None => self.prepare(places[0])?,
            }
        }
        Ok(outcomes)
    }

    fn step(&self, NodeIx(place): NodeIx) -> Step {
        self.graph.nodes()[place].step
    }

    /// The live traversal of steps that are taken together, so that each of its frames is prepared once.
    fn live_of(&self, place: NodeIx) -> Option<LiveIx> {
        match self.step(place) {
            Step::Codebook | Step::Make(_) | Step::ContenderWords(_) | Step::LiveWords(_) => None,
            Step::Match(live, _) | Step::Verify(live, _) | Step::Threshold(live) => Some(live),
            Step::Cell(cell) => Some(self.shared.plan.cell(cell).live),
        }
    }

    /// The steps of a kind among some that can be computed, and that something wanted still needs: what only failed
    /// cells would use is not computed.
    fn open(&mut self, places: &[NodeIx], is: impl Fn(Step) -> bool) -> Vec<NodeIx> {
        let useful = self.useful();
        let nodes = self.graph.nodes();
        let of_kind = places.iter().filter(|place| is(nodes[place.0].step));
        let open = of_kind.filter(|place| useful.as_ref().is_none_or(|useful| useful.contains(place)));
        open.filter(|place| !self.faults.is_blocked(**place, &nodes[place.0].needs)).copied().collect()
    }

    /// The wanted steps that can still be computed, with all that they need; none where nothing has failed, and all is.
    fn useful(&mut self) -> Option<BTreeSet<NodeIx>> {
        if self.faults.is_empty() {
            return None;
        }
        let blocked: BTreeSet<NodeIx> = (self.graph.places())
            .filter(|place| self.faults.is_blocked(*place, &self.graph.nodes()[place.0].needs))
            .collect();
        let alive: Vec<NodeIx> = self.wanted.iter().filter(|place| !blocked.contains(place)).copied().collect();
        Some(self.graph.with_needs(&alive).into_iter().collect())
    }

    /// A step that is shared by the cells of several live traversals.
    fn prepare(&mut self, place: NodeIx) -> Result<(), RunError> {
        if self.open(&[place], |_| true).is_empty() {
            return Ok(());
        }
        let computed = match self.step(place) {
            Step::Codebook => self.shared.prepare_codebook(),
            Step::Make(i) => self.shared.make(i),
            Step::ContenderWords(i) => self.shared.ensure_words(&WordImages::of_contender(self.shared.contender(i))),
            Step::LiveWords(live) => self.shared.ensure_words(&WordImages::of_live(self.shared.plan.live(live))),
            Step::Match(..) | Step::Verify(..) | Step::Threshold(_) | Step::Cell(_) => Ok(()),
        };
        self.faults.take(computed, &[place]).map(drop)
    }

    /// The steps of one live traversal: matches, inliers, threshold, cells.
    fn localise(&mut self, live: LiveIx, places: &[NodeIx]) -> Result<Vec<(CellIx, Outcome)>, RunError> {
        let matches = self.open(places, |step| matches!(step, Step::Match(..)));
        let matched = self.matched(live, &matches)?;
        let inliers = self.open(places, |step| matches!(step, Step::Verify(..)));
        let answered = self.verified(live, matched, &inliers)?;
        let thresholds = self.open(places, |step| matches!(step, Step::Threshold(_)));
        let cells = self.open(places, |step| matches!(step, Step::Cell(_)));
        let hanging = [thresholds, cells].concat();
        if hanging.is_empty() {
            return Ok(Vec::new());
        }
        let threshold = self.shared.threshold(live);
        let Some(threshold) = self.faults.take(threshold, &hanging)? else { return Ok(Vec::new()) };
        let cells = self.open(places, |step| matches!(step, Step::Cell(_)));
        self.finish(live, &cells, (&answered, threshold))
    }

    /// The answers to a live traversal, which is looked at once for all of them.
    fn matched(&mut self, live: LiveIx, places: &[NodeIx]) -> Result<Vec<(ContenderIx, Matches)>, RunError> {
        let mut matched = Vec::new();
        if places.is_empty() {
            return Ok(matched);
        }
        let looked = self.shared.plan.recogniser.look_at(&self.shared, self.shared.plan.live(live));
        let Some(answer) = self.faults.take(looked, places)? else { return Ok(matched) };
        for place in places {
            let Step::Match(_, i) = self.graph.nodes()[place.0].step else { continue };
            let matches = self.faults.take(answer(self.shared.contender(i)), &[*place])?;
            matched.extend(matches.map(|matches| (i, matches)));
        }
        Ok(matched)
    }

    /// The inliers of answers to one live traversal, together; where that fails and the others go on, of each that it
    /// does not fail for.
    fn verified(
        &mut self,
        live: LiveIx,
        matched: Vec<(ContenderIx, Matches)>,
        places: &[NodeIx],
    ) -> Result<Vec<Answered>, RunError> {
        let shared = &self.shared;
        let asking = Asking {
            candidates: shared.plan.matrix.localiser.candidates,
            features: shared.features,
            memory: shared.memory,
        };
        let unverified: Vec<Unverified<'_>> =
            matched.iter().map(|(i, matches)| Unverified { contender: shared.contender(*i), matches }).collect();
        let verify = |some: &[Unverified<'_>]| {
            verify_traversal(shared.catalog.objects(), shared.plan.live(live), some, asking, shared.progress)
        };
        let place_of = |contender: ContenderIx| {
            let is = |place: &&NodeIx| self.graph.nodes()[place.0].step == Step::Verify(live, contender);
            places.iter().find(is).copied()
        };
        let counts: Vec<Option<Counts>> = match verify(&unverified) {
            Ok(counts) => counts.into_iter().map(Some).collect(),
            Err(error) if !self.faults.keep_going => {
                self.faults.take::<()>(Err(error), places)?;
                return Ok(Vec::new());
            }
            Err(_) => {
                let mut counts = Vec::new();
                for (one, (i, _)) in unverified.iter().zip(&matched) {
                    let place: Vec<NodeIx> = place_of(*i).into_iter().collect();
                    let found = self.faults.take(verify(std::slice::from_ref(one)), &place)?;
                    counts.push(found.and_then(|found| found.into_iter().next()));
                }
                counts
            }
        };
        let answered = |((contender, matches), counts): ((ContenderIx, Matches), Option<Counts>)| {
            counts.map(|counts| Answered { contender, matches, counts })
        };
        Ok(matched.into_iter().zip(counts).filter_map(answered).collect())
    }

    /// The outcomes of cells of one live traversal.
    fn finish(
        &mut self,
        live: LiveIx,
        places: &[NodeIx],
        (answered, threshold): (&[Answered], u32),
    ) -> Result<Vec<(CellIx, Outcome)>, RunError> {
        let shared = &self.shared;
        let answers_of = |i: &ContenderIx| {
            // An axis may name one experience several times: its steps are there once.
            let is_of =
                |answered: &&Answered| shared.plan.contender(answered.contender).id == shared.plan.contender(*i).id;
            let answered = answered.iter().find(is_of)?;
            let (matches, counts) = (answered.matches.frames.as_slice(), &answered.counts);
            Some(Answers { contender: shared.contender(*i), matches, counts })
        };
        let is_cell = |place: &NodeIx| match self.graph.nodes()[place.0].step {
            Step::Cell(cell) => Some((*place, cell)),
            _ => None,
        };
        let cells: Vec<(NodeIx, CellIx)> = places.iter().filter_map(is_cell).collect();
        let finish = |(_, i): &(NodeIx, CellIx)| {
            let cell = shared.plan.cell(*i);
            let members: Vec<Answers<'_>> = cell.members.iter().filter_map(answers_of).collect();
            let finished = shared.finish_cell(cell, shared.plan.live(live), &members, threshold);
            let (done, total) = (i.0 as u64 + 1, shared.plan.cells.len() as u64);
            (shared.progress)(StageProgress::whole(Stage::Cells, done, total));
            finished
        };
        let finished: Vec<Result<Outcome, RunError>> = cells.par_iter().map(finish).collect();
        let mut outcomes = Vec::new();
        for ((place, i), finished) in cells.into_iter().zip(finished) {
            outcomes.extend(self.faults.take(finished, &[place])?.map(|outcome| (i, outcome)));
        }
        Ok(outcomes)
    }
}
