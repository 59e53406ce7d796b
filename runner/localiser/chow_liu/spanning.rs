//! The spanning forest of greatest weight, and its direction.

use super::cooccurrence::Cooccurrence;
use rayon::prelude::*;

/// Pairs that one task scores, so that a task is worth its start.
const PAIRS_PER_TASK: usize = 512;

/// An undirected edge, `low < high`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Edge {
    pub(super) low: u32,
    pub(super) high: u32,
    pub(super) score_nats: f64,
}

/// A word outside the growing tree, with its strongest edge into it.
#[derive(Clone, Copy)]
struct Outside {
    best_score: f64,
    best_inside: u32,
}

/// Prim's algorithm, one row of scores at a time. Where no edge of at least `threshold_nats` leads on, a new tree
/// begins at the lowest word left. Among equally strong edges the lowest outside word comes first, then the edge found
/// first.
pub(super) fn strongest_forest(cooccurrence: &Cooccurrence, threshold_nats: f64) -> Vec<Edge> {
    let words = cooccurrence.words();
    let mut edges = Vec::with_capacity(words - 1);
    let mut others: Vec<u32> = (1..words as u32).collect();
    let mut outside = vec![Outside { best_score: f64::NEG_INFINITY, best_inside: 0 }; others.len()];
    let mut newest = 0;
    while !others.is_empty() {
        let strongest = relax(cooccurrence, newest, threshold_nats, &others, &mut outside);
        // Order must stay rising for the tie rule, hence no swap_remove.
        let at = strongest.map_or(0, |(_, at)| at);
        let word = others.remove(at);
        let Outside { best_score, best_inside } = outside.remove(at);
        if strongest.is_some() {
            edges.push(Edge { low: word.min(best_inside), high: word.max(best_inside), score_nats: best_score });
        }
        newest = word;
    }
    edges
}

/// Offers the edges from the newest word to all words outside; the strongest edge into the tree now, and its place in
/// `others`.
fn relax(
    cooccurrence: &Cooccurrence,
    newest: u32,
    threshold_nats: f64,
    others: &[u32],
    outside: &mut [Outside],
) -> Option<(f64, usize)> {
    let tasks = others.par_chunks(PAIRS_PER_TASK).zip(outside.par_chunks_mut(PAIRS_PER_TASK));
    let strongest_of_task = |(task, (others, outside)): (usize, (&[u32], &mut [Outside]))| {
        let mut scores = [0.0; PAIRS_PER_TASK];
        cooccurrence.scores(newest as usize, others, &mut scores);
        let mut strongest = None;
        for (at, (&score, outside)) in scores.iter().zip(outside.iter_mut()).enumerate() {
            if score >= threshold_nats && score > outside.best_score {
                *outside = Outside { best_score: score, best_inside: newest };
            }
            if outside.best_score > strongest.map_or(f64::NEG_INFINITY, |(score, _)| score) {
                strongest = Some((outside.best_score, task * PAIRS_PER_TASK + at));
            }
        }
        strongest
    };
    let stronger = |a: Option<(f64, usize)>, b: Option<(f64, usize)>| match (a, b) {
        (Some(left), Some(right)) if right.0 > left.0 || (right.0 == left.0 && right.1 < left.1) => b,
        (None, _) => b,
        _ => a,
    };
    tasks.enumerate().map(strongest_of_task).reduce(|| None, stronger)
}

/// Parents: each tree of the forest is rooted at the lower end of its strongest edge (ties: lower ends first), a lone
/// word at itself.
pub(super) fn direct(edges: &[Edge], words: usize) -> Vec<u32> {
    let mut neighbours = vec![Vec::new(); words];
    for edge in edges {
        neighbours[edge.low as usize].push(edge.high);
        neighbours[edge.high as usize].push(edge.low);
    }
    let mut by_score = edges.to_vec();
    by_score.sort_by(|a, b| b.score_nats.total_cmp(&a.score_nats).then((a.low, a.high).cmp(&(b.low, b.high))));
    let starts = by_score.iter().map(|edge| edge.low).chain(0..words as u32);
    let mut parent: Vec<Option<u32>> = vec![None; words];
    for root in starts {
        if parent[root as usize].is_some() {
            continue;
        }
        parent[root as usize] = Some(root);
        let mut open = vec![root];
        while let Some(word) = open.pop() {
            for &child in &neighbours[word as usize] {
                if parent[child as usize].is_none() {
                    parent[child as usize] = Some(word);
                    open.push(child);
                }
            }
        }
    }
    (0..).zip(parent).map(|(word, parent)| parent.unwrap_or(word)).collect()
}

/// The first word whose chain of parents does not end at a root, if any.
pub(super) fn first_without_root(parent: &[u32]) -> Option<usize> {
    let mut rooted = vec![false; parent.len()];
    for start in 0..parent.len() {
        let mut path = Vec::new();
        let mut word = start;
        while !rooted[word] {
            path.push(word);
            match parent.get(word).map(|&parent| parent as usize) {
                Some(next) if next == word => break,
                // A path longer than there are words has met one of them twice.
                Some(next) if next < parent.len() && path.len() <= parent.len() => word = next,
                _ => return Some(start),
            }
        }
        path.into_iter().for_each(|word| rooted[word] = true);
    }
    None
}
