use super::example::plan;
use super::step::Node;
use super::{Graph, Part, State, Step};
use crate::inputs::codebook::codebook_key;
use crate::plan::{CellIx, ContenderIx, LiveIx, Plan};
use furrow_catalog::Catalog;
use std::collections::BTreeSet;

const RECORDED: ContenderIx = ContenderIx(0);
const GENERATED: ContenderIx = ContenderIx(1);
const LIVES: [LiveIx; 2] = [LiveIx(0), LiveIx(1)];

fn graph(plan: &Plan) -> Graph<'_> {
    Graph::new(vec![Part { setting: 0, plan, cells: plan.due_cells() }]).unwrap()
}

/// What a step needs.
fn needs(graph: &Graph<'_>, step: Step) -> BTreeSet<Step> {
    let is = |node: &&Node| node.step == step;
    let node = graph.nodes().iter().find(is).unwrap_or_else(|| panic!("no {step:?}"));
    node.needs.iter().map(|need| graph.nodes()[need.0].step).collect()
}

#[test]
fn every_step_is_there_once_and_behind_those_that_it_needs() {
    let plan = plan();
    let graph = graph(&plan);
    let steps: Vec<Step> = graph.nodes().iter().map(|node| node.step).collect();
    let expected = [
        Step::Codebook,
        Step::Make(GENERATED),
        // In the order in which live traversals meet them: a fault in the words of a later one costs no earlier cell.
        Step::LiveWords(LIVES[0]),
        Step::ContenderWords(RECORDED),
        Step::ContenderWords(GENERATED),
        Step::Match(LIVES[0], RECORDED),
        Step::Verify(LIVES[0], RECORDED),
        Step::Match(LIVES[0], GENERATED),
        Step::Verify(LIVES[0], GENERATED),
        Step::Threshold(LIVES[0]),
        Step::Cell(CellIx(0)),
        Step::Cell(CellIx(1)),
        Step::Cell(CellIx(2)),
        Step::LiveWords(LIVES[1]),
        Step::Match(LIVES[1], RECORDED),
        Step::Verify(LIVES[1], RECORDED),
        // Both live traversals have one rig: the second meets the threshold of the first.
        Step::Cell(CellIx(3)),
    ];
    assert_eq!(steps, expected);
    for (i, node) in graph.nodes().iter().enumerate() {
        assert!(node.needs.iter().all(|need| need.0 < i), "{node:?}");
    }
}

#[test]
fn a_step_needs_what_its_key_is_made_of() {
    let plan = plan();
    let graph = graph(&plan);
    assert_eq!(needs(&graph, Step::Codebook), [].into());
    assert_eq!(needs(&graph, Step::LiveWords(LIVES[0])), [Step::Codebook].into());
    assert_eq!(needs(&graph, Step::ContenderWords(GENERATED)), [Step::Codebook, Step::Make(GENERATED)].into());
    let of_match = [Step::Codebook, Step::Make(GENERATED), Step::LiveWords(LIVES[0]), Step::ContenderWords(GENERATED)];
    assert_eq!(needs(&graph, Step::Match(LIVES[0], GENERATED)), of_match.into());
    assert_eq!(needs(&graph, Step::Verify(LIVES[0], GENERATED)), [Step::Match(LIVES[0], GENERATED)].into());
    let of_both = [Step::Verify(LIVES[0], RECORDED), Step::Verify(LIVES[0], GENERATED), Step::Threshold(LIVES[0])];
    assert_eq!(needs(&graph, Step::Cell(CellIx(2))), of_both.into());
    assert_eq!(needs(&graph, Step::Cell(CellIx(3))).len(), 2);
}

#[test]
fn settings_share_their_steps_but_not_their_cells() {
    let (first, second) = (plan(), plan());
    let alone = graph(&first).nodes().len();
    let part = |setting, plan| Part { setting, plan, cells: Plan::due_cells(plan) };
    let both = Graph::new(vec![part(0, &first), part(1, &second)]).unwrap();
    assert_eq!(both.nodes().len(), alone + second.cells.len());

    // Where one setting verifies more candidates, answers are its own; words are shared.
    let mut third = plan();
    third.matrix.localiser.candidates += 1;
    let both = Graph::new(vec![part(0, &first), part(1, &third)]).unwrap();
    let own = both.nodes().iter().filter(|node| node.part == 1).map(|node| node.step);
    assert!(own.clone().all(|step| matches!(step, Step::Match(..) | Step::Verify(..) | Step::Cell(_))));
    assert_eq!(own.count(), 6 + third.cells.len());
}

#[test]
fn what_only_other_cells_use_is_not_needed() {
    let plan = plan();
    let graph = graph(&plan);
    let wanted: Vec<_> = graph.places().filter(|place| graph.nodes()[place.0].step == Step::Cell(CellIx(3))).collect();
    let needed: Vec<Step> = graph.with_needs(&wanted).into_iter().map(|place| graph.nodes()[place.0].step).collect();
    let unused = [Step::Make(GENERATED), Step::ContenderWords(GENERATED), Step::LiveWords(LIVES[0])];
    assert!(unused.iter().all(|step| !needed.contains(step)), "{needed:?}");
    let of_cell = [Step::Codebook, Step::Verify(LIVES[1], RECORDED), Step::Threshold(LIVES[0])];
    assert!(of_cell.iter().all(|step| needed.contains(step)), "{needed:?}");
}

#[test]
fn nothing_due_is_an_empty_graph() {
    let mut plan = plan();
    plan.cells.iter_mut().for_each(|cell| cell.asked = false);
    assert!(graph(&plan).nodes().is_empty());
}

#[test]
fn what_hangs_on_an_unfinished_step_is_not_known_yet() {
    let folder = tempfile::tempdir().unwrap();
    let catalog = Catalog::init(folder.path()).unwrap();
    let (plan, objects) = (plan(), catalog.objects());
    let graph = graph(&plan);
    let states = |is: fn(State) -> bool| -> Vec<Step> {
        let states = graph.states(objects).unwrap();
        let steps = graph.nodes().iter().zip(states).filter(|(_, state)| is(*state)).map(|(node, _)| node.step);
        steps.filter(|step| !matches!(step, Step::Cell(_))).collect()
    };
    assert_eq!(states(State::is_finished), []);
    assert_eq!(states(|state| state == State::Due), [Step::Codebook, Step::Threshold(LIVES[0])]);

    let codebook = objects.write(b"a codebook").unwrap();
    objects.remember(codebook_key(plan.codebook.as_ref().unwrap()).unwrap(), codebook).unwrap();
    assert_eq!(states(State::is_finished), [Step::Codebook]);
    let due = [
        Step::LiveWords(LIVES[0]),
        Step::ContenderWords(RECORDED),
        Step::Threshold(LIVES[0]),
        Step::LiveWords(LIVES[1]),
    ];
    assert_eq!(states(|state| state == State::Due), due);
}
