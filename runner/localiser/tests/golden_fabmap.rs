//! FAB-MAP against openFABMAP's numbers. A set is a folder with tables of presences, a tree and likelihoods, recognised
//! by their columns.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../../../tests/support/golden_data.rs"]
mod golden_data;
#[path = "golden_fabmap/tables.rs"]
mod tables;

use furrow_localiser::fabmap::{Best, FabMap, FabMapParams, NewPlace, WordDependence};
use furrow_localiser::{ChowLiuTree, chow_liu};
use std::collections::{BTreeMap, BTreeSet};
use tables::{Set, TreeRow};

fn sets() -> Vec<Set> {
    let sets = golden_data::golden().map(|folder| tables::sets_below(&folder)).unwrap_or_default();
    if sets.is_empty() {
        eprintln!("SKIPPED: no set of presences, tree and likelihoods among the golden numbers");
    }
    sets
}

fn tree_of(rows: &[TreeRow]) -> ChowLiuTree {
    let column = |of: fn(&TreeRow) -> f64| rows.iter().map(of).collect();
    let parents = rows.iter().map(|row| row.parent).collect();
    ChowLiuTree::from_columns(parents, column(|r| r.p), column(|r| r.p_if_parent), column(|r| r.p_if_not_parent))
        .unwrap()
}

fn undirected(parents: impl Iterator<Item = u32>) -> BTreeSet<(u32, u32)> {
    (0..).zip(parents).filter(|(word, parent)| word != parent).map(|(w, p)| (w.min(p), w.max(p))).collect()
}

#[test]
fn golden_tree_has_the_same_edges_and_probabilities() {
    for set in sets() {
        let tree = chow_liu::train(&set.train, set.tree.len(), set.information_threshold).unwrap();
        assert_eq!(undirected(tree.parent().iter().copied()), undirected(set.tree.iter().map(|row| row.parent)));
        let mut same_direction = 0;
        for (word, row) in set.tree.iter().enumerate() {
            let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-14, "{}: word {word}: {a} for {b}", set.name);
            close(tree.p_present()[word], row.p);
            if tree.parent()[word] == row.parent {
                same_direction += 1;
                close(tree.p_present_given_parent_present()[word], row.p_if_parent);
                close(tree.p_present_given_parent_absent()[word], row.p_if_not_parent);
            }
        }
        eprintln!("{}: {same_direction} of {} words have the same parent", set.name, set.tree.len());
    }
}

/// openFABMAP's name of a method, its model, and whether it leaves out the query's constant.
const METHODS: [(&str, WordDependence, NewPlace, bool); 3] = [
    ("fabmap1_chowliu_meanfield", WordDependence::ChowLiu, NewPlace::MeanField, false),
    ("fabmap1_naivebayes_meanfield", WordDependence::NaiveBayes, NewPlace::MeanField, false),
    ("fabmap2_chowliu", WordDependence::ChowLiu, NewPlace::Samples, true),
];

#[test]
fn golden_likelihoods_and_posteriors() {
    for set in sets() {
        for (method, words, new_place, lacks_constant) in METHODS {
            let params = FabMapParams {
                p_detect_present: set.p_detect_present,
                p_detect_absent: set.p_detect_absent,
                smoothing: set.smoothing,
                new_place,
                words,
            };
            let mut map = FabMap::new(&tree_of(&set.tree), params, &set.train).unwrap();
            set.places.iter().for_each(|place| assert!(map.add_place(place).is_ok()));
            let expected: Vec<_> = set.likelihoods.iter().filter(|row| row.method == method).collect();
            if expected.is_empty() {
                eprintln!("SKIPPED: {} has no {method}", set.name);
            }
            let mut by_query: BTreeMap<usize, Vec<_>> = BTreeMap::new();
            expected.into_iter().for_each(|row| by_query.entry(row.query).or_default().push(row));
            for (query, rows) in by_query {
                let answer = map.query(&set.queries[query]).unwrap();
                let ours = |place: i64| match usize::try_from(place) {
                    Ok(place) => (answer.log_likelihoods[place], answer.posteriors[place]),
                    Err(_) => (answer.new_place_log_likelihood, answer.new_place_posterior),
                };
                assert_eq!(rows.len(), map.places() + 1);
                // The constant must be the same for every place and the new one, hence it is taken from one of them
                // only.
                let constant = if lacks_constant { ours(rows[0].place).0 - rows[0].log_likelihood } else { 0.0 };
                for row in &rows {
                    let (log_likelihood, posterior) = ours(row.place);
                    let what = format!("{}: {method}, query {query}, place {}", set.name, row.place);
                    assert!((log_likelihood - constant - row.log_likelihood).abs() < 1e-10, "{what}: {log_likelihood}");
                    assert!((posterior - row.posterior).abs() < 1e-11, "{what}: {posterior} for {}", row.posterior);
                }
                let likeliest = rows.iter().max_by(|a, b| a.log_likelihood.total_cmp(&b.log_likelihood)).unwrap().place;
                let best = usize::try_from(likeliest).map_or(Best::NewPlace, Best::Place);
                assert_eq!(answer.best(), best, "{}: {method}, query {query}", set.name);
                if let (true, Some(expected)) = (lacks_constant, set.constants.get(&query)) {
                    assert!((constant - expected).abs() < 1e-10, "{}: query {query}: {constant}", set.name);
                }
            }
        }
    }
}
