//! The graph from the plans of a study.

use super::step::{Node, NodeIx, Step, Work};
use crate::inputs::codebook::{CodebookPlan, codebook_key};
use crate::inputs::contender::Contender;
use crate::inputs::key::key_of;
use crate::inputs::traversals::LiveTraversal;
use crate::matrix::Trainer;
use crate::plan::{CellIx, ContenderIx, LiveIx, Plan};
use crate::progress::Stage;
use furrow_catalog::CatalogError;
use furrow_model::{ObjectId, TraversalId};
use std::collections::{BTreeMap, BTreeSet};

/// Rounds that training a vocabulary usually takes.
const ROUNDS: usize = 15;

/// A plan, and those of its cells that are to be computed.
pub(crate) struct Part<'a> {
    /// The plan's place among the settings of its study.
    pub setting: usize,
    pub plan: &'a Plan,
    pub cells: Vec<CellIx>,
}

/// The steps that some cells need, each behind those that it needs; a step that several cells or settings share is
/// there once.
pub(crate) struct Graph<'a> {
    parts: Vec<Part<'a>>,
    nodes: Vec<Node>,
}

impl<'a> Graph<'a> {
    pub fn new(parts: Vec<Part<'a>>) -> Result<Self, CatalogError> {
        let mut builder = Builder::default();
        parts.iter().enumerate().try_for_each(|(place, part)| builder.add(place, part))?;
        Ok(Self { parts, nodes: builder.nodes })
    }

    /// The steps, in order.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The places of the steps, in order.
    pub fn places(&self) -> impl Iterator<Item = NodeIx> + use<> {
        (0..self.nodes.len()).map(NodeIx)
    }

    /// Some steps and all that they need, in order.
    pub fn with_needs(&self, wanted: &[NodeIx]) -> Vec<NodeIx> {
        let mut taken = vec![false; self.nodes.len()];
        wanted.iter().for_each(|place| taken[place.0] = true);
        for place in (0..self.nodes.len()).rev() {
            if taken[place] {
                self.nodes[place].needs.iter().for_each(|need| taken[need.0] = true);
            }
        }
        self.places().filter(|place| taken[place.0]).collect()
    }

    /// The part that a step belongs to, of those that share it the first.
    pub fn part_of(&self, node: &Node) -> &Part<'a> {
        &self.parts[node.part]
    }
}

#[derive(Default)]
struct Builder {
    nodes: Vec<Node>,
    known: BTreeMap<ObjectId, NodeIx>,
}

impl Builder {
    fn push(&mut self, node: Node) -> NodeIx {
        self.nodes.push(node);
        NodeIx(self.nodes.len() - 1)
    }

    /// Adds a step unless it is there already.
    fn share(&mut self, node: Node) -> NodeIx {
        if let Some(known) = self.known.get(&node.key) {
            return *known;
        }
        let key = node.key;
        let place = self.push(node);
        self.known.insert(key, place);
        place
    }

    /// The cells of a part and all that they need.
    fn add(&mut self, place: usize, part: &Part<'_>) -> Result<(), CatalogError> {
        let plan = part.plan;
        // A plan without codebook has no cells; where none is due, nothing is needed.
        let Some(spec) = plan.codebook.as_ref().filter(|_| !part.cells.is_empty()) else { return Ok(()) };
        let trained = codebook_key(spec)?;
        let worded = plan.recogniser.needs_codebook();
        let codebook = worded.then(|| self.share(codebook_node(place, spec, trained)));
        let mut maps: BTreeMap<ContenderIx, Vec<NodeIx>> = BTreeMap::new();
        for i in plan.members(&part.cells) {
            let contender = plan.contender(i);
            if contender.making.is_some() {
                maps.entry(i).or_default().push(self.share(make_node(place, i, contender)));
            }
        }
        let lives: BTreeSet<LiveIx> = part.cells.iter().map(|cell| plan.cell(*cell).live).collect();
        for live in lives {
            let mut seen = Vec::new();
            if let Some(codebook) = codebook {
                let traversal = plan.live(live);
                let key = key_of("live words", &(trained, traversal.id))?;
                let work = vec![work(Stage::Words, traversal.frames.len(), key)];
                let words =
                    self.share(Node { part: place, step: Step::LiveWords(live), key, work, needs: vec![codebook] });
                seen = vec![codebook, words];
            }
            let cells: Vec<CellIx> = part.cells.iter().copied().filter(|cell| plan.cell(*cell).live == live).collect();
            if let Some(codebook) = codebook {
                for i in plan.members(&cells) {
                    self.add_contender_words(
                        place,
                        plan.contender(i),
                        (i, trained, codebook),
                        maps.entry(i).or_default(),
                    )?;
                }
            }
            self.add_live(place, part, (live, &cells), (trained, seen, &maps))?;
        }
        Ok(())
    }

    /// The words of a contender, before the first live traversal that meets it: `maps` are the steps that its answers
    /// need, to which they are added once.
    fn add_contender_words(
        &mut self,
        place: usize,
        contender: &Contender,
        (i, trained, codebook): (ContenderIx, ObjectId, NodeIx),
        maps: &mut Vec<NodeIx>,
    ) -> Result<(), CatalogError> {
        let key = key_of("words", &(trained, contender.id))?;
        let work = vec![work(Stage::Words, contender.record.nodes.len(), key)];
        let needs = maps.iter().copied().chain([codebook]).collect();
        let words = self.share(Node { part: place, step: Step::ContenderWords(i), key, work, needs });
        if !maps.contains(&words) {
            maps.push(words);
        }
        Ok(())
    }

    /// The cells of one live traversal, with matches, inliers and threshold.
    fn add_live(
        &mut self,
        place: usize,
        part: &Part<'_>,
        (live, cells): (LiveIx, &[CellIx]),
        (trained, seen, maps): (ObjectId, Vec<NodeIx>, &BTreeMap<ContenderIx, Vec<NodeIx>>),
    ) -> Result<(), CatalogError> {
        let plan = part.plan;
        let traversal = plan.live(live);
        let frames_of = key_of("verifying", &(trained, traversal.id))?;
        let mut verified: BTreeMap<ContenderIx, NodeIx> = BTreeMap::new();
        for i in plan.members(cells) {
            let answers = answers_name(plan, trained, traversal, plan.contender(i))?;
            let needs = seen.iter().chain(maps.get(&i).into_iter().flatten()).copied().collect();
            let (key, step) = (key_of("match", &answers)?, Step::Match(live, i));
            let matched = self.share(Node { part: place, step, key, work: Vec::new(), needs });
            let (key, step) = (key_of("verify", &answers)?, Step::Verify(live, i));
            let work = vec![work(Stage::Verification, traversal.frames.len(), frames_of)];
            verified.insert(i, self.share(Node { part: place, step, key, work, needs: vec![matched] }));
        }
        let mut threshold = None;
        if plan.matrix.verification.threshold.is_none() {
            let vocabulary: Vec<TraversalId> = plan.vocabulary.iter().map(|traversal| traversal.id).collect();
            let features = plan.codebook.as_ref().map(|spec| spec.features);
            let key = key_of("threshold", &(vocabulary, &traversal.record.rig, features))?;
            let (work, needs) = (Vec::new(), Vec::new());
            threshold = Some(self.share(Node { part: place, step: Step::Threshold(live), key, work, needs }));
        }
        for &i in cells {
            let cell = plan.cell(i);
            let needs = cell.members.iter().filter_map(|member| verified.get(member)).copied().chain(threshold);
            let (key, needs) = (ObjectId(cell.key.0), needs.collect());
            // Several names of one cell are a cell each.
            let work = vec![work(Stage::Cells, 1, key_of("cells", &(place, i.0))?)];
            self.push(Node { part: place, step: Step::Cell(i), key, work, needs });
        }
        Ok(())
    }
}

fn work(stage: Stage, units: usize, of: ObjectId) -> Work {
    Work { stage, units: units as u64, of }
}

fn codebook_node(part: usize, spec: &CodebookPlan, key: ObjectId) -> Node {
    let features = work(Stage::VocabularyFeatures, spec.images.len(), key);
    let training = (spec.trainer == Trainer::KMeans).then(|| work(Stage::VocabularyTraining, ROUNDS, key));
    let work = [features].into_iter().chain(training).collect();
    Node { part, step: Step::Codebook, key, work, needs: Vec::new() }
}

fn make_node(part: usize, place: ContenderIx, contender: &Contender) -> Node {
    let key = ObjectId(contender.id.0);
    let work = vec![work(Stage::Painting, contender.record.nodes.len(), key)];
    Node { part, step: Step::Make(place), key, work, needs: Vec::new() }
}

/// All that an experience's answers to a live traversal, and their inliers, depend on.
fn answers_name(
    plan: &Plan,
    trained: ObjectId,
    live: &LiveTraversal,
    contender: &Contender,
) -> Result<ObjectId, CatalogError> {
    let recogniser = (plan.recogniser.cell_key_part(), plan.matrix.localiser.candidates, plan.matrix.keyframes);
    key_of("answers", &(recogniser, trained, live.id, contender.id))
}
