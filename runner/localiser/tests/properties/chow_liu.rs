use super::{on_thread_counts, presences};
use furrow_localiser::Presence;
use furrow_localiser::chow_liu::{self, ChowLiuError, ChowLiuTree};
use proptest::prelude::*;

fn count(images: &[Presence], holds: impl Fn(&Presence) -> bool) -> f64 {
    images.iter().filter(|image| holds(image)).count() as f64
}

/// The score written out: over both states of both words.
fn score(images: &[Presence], a: u32, b: u32) -> f64 {
    let n = images.len() as f64;
    let marginal = |word, z| 0.98 * count(images, |image| image.contains(word) == z) / n + 0.01;
    let cell = |za: bool, zb: bool| {
        let joint = count(images, |image| image.contains(a) == za && image.contains(b) == zb) / n;
        if joint == 0.0 { 0.0 } else { joint * (joint / (marginal(a, za) * marginal(b, zb))).ln() }
    };
    (cell(false, false) + cell(false, true) + cell(true, false) + cell(true, true)).max(0.0)
}

/// Number of edges and total score of the best forest, by Kruskal's algorithm.
fn kruskal(images: &[Presence], words: u32, threshold: f64) -> (usize, f64) {
    let pairs = (0..words).flat_map(|a| (a + 1..words).map(move |b| (a, b)));
    let mut edges: Vec<_> =
        pairs.map(|(a, b)| (score(images, a, b), a, b)).filter(|edge| edge.0 >= threshold).collect();
    edges.sort_by(|x, y| y.0.total_cmp(&x.0));
    let mut tree_of: Vec<u32> = (0..words).collect();
    let (mut taken, mut total) = (0, 0.0);
    for (score, a, b) in edges {
        let (from, to) = (tree_of[a as usize], tree_of[b as usize]);
        if from != to {
            tree_of.iter_mut().filter(|tree| **tree == from).for_each(|tree| *tree = to);
            taken += 1;
            total += score;
        }
    }
    (taken, total)
}

fn root_of(tree: &ChowLiuTree, mut word: u32) -> u32 {
    while tree.parent()[word as usize] != word {
        word = tree.parent()[word as usize];
    }
    word
}

proptest! {
    #[test]
    fn the_forest_is_as_strong_as_kruskals(images in presences(9, 1..90), threshold in prop_oneof![Just(0.0), 0.001..0.2f64]) {
        let tree = chow_liu::train(&images, 9, threshold).unwrap();
        let edges: Vec<_> = (0..9).zip(tree.parent().to_vec()).filter(|(word, parent)| word != parent).collect();
        let total: f64 = edges.iter().map(|&(word, parent)| score(&images, word, parent)).sum();
        let (taken, best) = kruskal(&images, 9, threshold);
        prop_assert_eq!((edges.len(), tree.roots().len()), (taken, 9 - taken));
        prop_assert!((total - best).abs() < 1e-12, "{} for {}", total, best);
        for root in tree.roots() {
            let own: Vec<_> = edges.iter().filter(|edge| root_of(&tree, edge.0) == root).collect();
            let strongest = |edges: &[&(u32, u32)]| edges.iter().map(|e| score(&images, e.0, e.1)).fold(0.0, f64::max);
            let upwards: Vec<_> = own.iter().copied().filter(|edge| edge.1 == root && edge.0 > root).collect();
            prop_assert!(strongest(&upwards) >= strongest(&own) - 1e-12, "root {} is the lower end of a strongest edge", root);
        }
    }

    #[test]
    fn probabilities_are_smoothed_recounts(images in presences(7, 1..50)) {
        let tree = chow_liu::train(&images, 7, 0.0).unwrap();
        for (word, &parent) in (0..7u32).zip(tree.parent()) {
            let p = 0.98 * count(&images, |image| image.contains(word)) / images.len() as f64 + 0.01;
            let given = |parent_present: bool| {
                let total = count(&images, |image| image.contains(parent) == parent_present);
                let both = count(&images, |image| image.contains(parent) == parent_present && image.contains(word));
                if word == parent { p } else if total == 0.0 { 0.01 } else { 0.98 * both / total + 0.01 }
            };
            let row = word as usize;
            let found = [tree.p_present()[row], tree.p_present_given_parent_present()[row], tree.p_present_given_parent_absent()[row]];
            for (found, expected) in found.into_iter().zip([p, given(true), given(false)]) {
                prop_assert!((found - expected).abs() < 1e-15);
            }
        }
    }
}

#[test]
fn the_number_of_threads_does_not_show() {
    // 1500 words in 70 images: thousands of equal scores, and rows that several tasks share.
    let images: Vec<Presence> = (0..70u32)
        .map(|image| (0..1500u32).filter(|word| (word * 7919 + image * 104_729 + word * image) % 11 < 2).collect())
        .collect();
    let trees = on_thread_counts(|| chow_liu::train(&images, 1500, 0.0));
    assert!(trees[0].is_ok() && trees.iter().all(|tree| *tree == trees[0]));
}

#[test]
fn what_cannot_be_a_tree_is_refused() {
    let image = Presence::from(vec![3]);
    assert_eq!(chow_liu::train(&[], 4, 0.0), Err(ChowLiuError::NoImages));
    assert_eq!(chow_liu::train(&[Presence::default()], 0, 0.0), Err(ChowLiuError::NoWords));
    assert_eq!(chow_liu::train(&[image], 3, 0.0), Err(ChowLiuError::WordOutOfRange { image: 0, word: 3, words: 3 }));
    assert!(matches!(chow_liu::train(&[Presence::default()], 1, f64::NAN), Err(ChowLiuError::BadThreshold(_))));
    let read = |parent: Vec<u32>, p: f64| {
        let column = vec![p; parent.len()];
        ChowLiuTree::from_columns(parent, column.clone(), column.clone(), column)
    };
    assert!(read(vec![0, 0, 1, 3], 0.5).is_ok_and(|tree| tree.roots() == [0, 3]));
    assert_eq!(read(vec![0, 2, 1], 0.5), Err(ChowLiuError::NoRoot { word: 1 }));
    assert_eq!(read(vec![0, 9], 0.5), Err(ChowLiuError::NoRoot { word: 1 }));
    assert_eq!(read(vec![0], 1.0), Err(ChowLiuError::BadProbability { word: 0, value: 1.0 }));
    assert_eq!(
        ChowLiuTree::from_columns(vec![0], vec![0.5], vec![], vec![0.5]),
        Err(ChowLiuError::Ragged([1, 1, 0, 1]))
    );
}
