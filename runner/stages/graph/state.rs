//! Which steps of a graph the store has the results of.

use super::build::Graph;
use super::step::{Node, NodeIx, Step};
use crate::RunError;
use crate::inputs::contender::Contender;
use crate::inputs::words::WordTables;
use crate::plan::{ContenderIx, LiveIx, Plan};
use crate::stages::threshold::threshold_key;
use crate::stages::verifying::counts_key;
use crate::stages::words::words_key;
use furrow_catalog::records::record_id;
use furrow_catalog::{CatalogError, Objects};
use furrow_model::{CodebookId, ExperienceId, ObjectId};

/// How far a step is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum State {
    /// The store has its result.
    Finished(ObjectId),
    /// It is to be computed.
    Due,
    /// What it needs is not finished, so its key is not known; it counts as due.
    Unknown,
}

impl State {
    pub fn is_finished(self) -> bool {
        self.result().is_some()
    }

    fn result(self) -> Option<ObjectId> {
        match self {
            Self::Finished(result) => Some(result),
            Self::Due | Self::Unknown => None,
        }
    }
}

impl Graph<'_> {
    /// The state of each step, in order. Nothing is computed.
    pub fn states(&self, objects: &Objects) -> Result<Vec<State>, RunError> {
        let mut states: Vec<State> = Vec::with_capacity(self.nodes().len());
        for node in self.nodes() {
            let known = Known { graph: self, states: &states, plan: self.part_of(node).plan, node };
            let state = match (node.step, known.key()?) {
                // The cells of a graph are those that are due.
                (Step::Cell(_), _) => State::Due,
                (_, None) => State::Unknown,
                (_, Some(key)) => objects.derived(key)?.map_or(State::Due, State::Finished),
            };
            states.push(state);
        }
        Ok(states)
    }
}

/// A step, and the states of those before it.
struct Known<'a> {
    graph: &'a Graph<'a>,
    states: &'a [State],
    plan: &'a Plan,
    node: &'a Node,
}

impl Known<'_> {
    /// The key that the step's result is remembered under; `None` where a step that it needs is not finished, or where
    /// only its own computation knows.
    fn key(&self) -> Result<Option<ObjectId>, CatalogError> {
        if !self.node.needs.iter().all(|NodeIx(need)| self.states[*need].is_finished()) {
            return Ok(None);
        }
        match self.node.step {
            Step::Codebook | Step::Cell(_) => Ok(Some(self.node.key)),
            // An experience that was made after the plan stands in it with its parent's nodes: it counts as not made.
            Step::Make(i) => {
                let making = self.plan.contender(i).making.as_ref();
                Ok(making.filter(|making| making.made).map(|_| self.node.key))
            }
            Step::LiveWords(live) => {
                let traversal = self.plan.live(live);
                self.words_key(traversal.record.calibration, &traversal.images().collect::<Vec<_>>())
            }
            Step::ContenderWords(i) => {
                let contender = self.plan.contender(i);
                self.words_key(contender.record.calibration, &contender.images().collect::<Vec<_>>())
            }
            Step::Match(live, i) => self.answers_key(live, i),
            Step::Verify(live, i) => self.inliers_key(live, i),
            Step::Threshold(live) => {
                let features = self.plan.codebook.as_ref().map(|spec| spec.features);
                let key = |features| threshold_key(self.plan, &self.plan.live(live).record.rig, features);
                features.map(key).transpose()
            }
        }
    }

    /// The result of the first need of a kind.
    fn result(&self, is: impl Fn(Step) -> bool) -> Option<ObjectId> {
        let of_kind = |NodeIx(need): &&NodeIx| is(self.graph.nodes()[*need].step);
        self.node.needs.iter().find(of_kind).and_then(|NodeIx(need)| self.states[*need].result())
    }

    fn words_key(&self, calibration: ObjectId, images: &[ObjectId]) -> Result<Option<ObjectId>, CatalogError> {
        let (Some(codebook), Some(spec)) = (self.result(|step| step == Step::Codebook), &self.plan.codebook) else {
            return Ok(None);
        };
        words_key(calibration, images, CodebookId(codebook.0), spec.features).map(Some)
    }

    /// The key of answers that are made of words alone.
    fn answers_key(&self, live: LiveIx, i: ContenderIx) -> Result<Option<ObjectId>, CatalogError> {
        let (traversal, contender) = (self.plan.live(live), self.plan.contender(i));
        let needs = (
            self.result(|step| step == Step::Codebook),
            self.result(|step| matches!(step, Step::LiveWords(_))),
            self.result(|step| matches!(step, Step::ContenderWords(_))),
        );
        let (Some(codebook), Some(seen), Some(map)) = needs else { return Ok(None) };
        let tables = WordTables {
            codebook: CodebookId(codebook.0),
            live: (seen, traversal.frames.len()),
            map: (map, contender.record.nodes.len()),
        };
        self.plan.recogniser.answers_key(traversal, &tables)
    }

    fn inliers_key(&self, live: LiveIx, i: ContenderIx) -> Result<Option<ObjectId>, CatalogError> {
        let (traversal, contender) = (self.plan.live(live), self.plan.contender(i));
        let answers = self.result(|step| matches!(step, Step::Match(..)));
        let (Some(answers), Some(spec)) = (answers, &self.plan.codebook) else { return Ok(None) };
        let candidates = self.plan.matrix.localiser.candidates;
        // A generated experience is verified under its own id, not that of its making.
        let own = Contender { id: ExperienceId(record_id(&contender.record)?.0), ..contender.clone() };
        counts_key(traversal, &own, answers, (candidates, spec.features)).map(Some)
    }
}
