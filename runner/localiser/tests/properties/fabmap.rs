use super::presences;
use furrow_localiser::fabmap::{Answer, Best, FabMap, FabMapError, FabMapParams, NewPlace, WordDependence};
use furrow_localiser::{ChowLiuTree, Presence, chow_liu};
use proptest::prelude::*;

const WORDS: u32 = 8;

/// The log-likelihood as a sum over all words, written as in PEERS.md; `place` = `None` is the average place.
fn dense(tree: &ChowLiuTree, params: &FabMapParams, place: Option<&Presence>, query: &Presence) -> f64 {
    let of = |p: f64, z: bool| if z { p } else { 1.0 - p };
    let word = |q: u32| {
        let pi = tree.p_present()[q as usize];
        let p_z_e = |e: bool| if e { params.p_detect_present } else { params.p_detect_absent };
        let p_e = match place.map(|place| place.contains(q)) {
            None => pi,
            Some(l) => of(p_z_e(true), l) * pi / (of(p_z_e(true), l) * pi + of(p_z_e(false), l) * (1.0 - pi)),
        };
        let (z, parent) = (query.contains(q), query.contains(tree.parent()[q as usize]));
        let conditional =
            if parent { tree.p_present_given_parent_present() } else { tree.p_present_given_parent_absent() }
                [q as usize];
        let p_z = |e: bool| match params.words {
            WordDependence::NaiveBayes => of(p_z_e(e), z),
            WordDependence::ChowLiu => {
                let alpha = of(pi, z) * of(p_z_e(e), !z) * of(conditional, !z);
                let beta = of(pi, !z) * of(p_z_e(e), z) * of(conditional, z);
                beta / (alpha + beta)
            }
        };
        (p_e * p_z(true) + (1.0 - p_e) * p_z(false)).ln()
    };
    (0..WORDS).map(word).sum()
}

fn params() -> impl Strategy<Value = FabMapParams> {
    let new_place = prop_oneof![Just(NewPlace::MeanField), Just(NewPlace::Samples)];
    let words = prop_oneof![Just(WordDependence::ChowLiu), Just(WordDependence::NaiveBayes)];
    (0.2..0.95f64, prop_oneof![Just(0.0), 0.0..0.15f64], 0.0..=1.0f64, new_place, words).prop_map(
        |(p_detect_present, p_detect_absent, smoothing, new_place, words)| FabMapParams {
            p_detect_present,
            p_detect_absent,
            smoothing,
            new_place,
            words,
        },
    )
}

proptest! {
    #[test]
    fn the_inverted_index_gives_the_dense_sums(
        images in presences(WORDS, 1..12),
        places in presences(WORDS, 0..7),
        queries in presences(WORDS, 1..5),
        threshold in prop_oneof![Just(0.0), Just(0.05)],
        params in params(),
    ) {
        let tree = chow_liu::train(&images, WORDS as usize, threshold).unwrap();
        let mut map = FabMap::new(&tree, params, &images).unwrap();
        let mut answer = Answer::default();
        for (number, place) in places.iter().enumerate() {
            prop_assert_eq!(map.add_place(place), Ok(number));
        }
        for query in &queries {
            map.query_into(query, &mut answer).unwrap();
            let expected: Vec<f64> = places.iter().map(|place| dense(&tree, &params, Some(place), query)).collect();
            let new_place = match params.new_place {
                NewPlace::MeanField => dense(&tree, &params, None, query),
                NewPlace::Samples => {
                    let mean = images.iter().map(|image| dense(&tree, &params, Some(image), query).exp()).sum::<f64>();
                    (mean / images.len() as f64).ln()
                }
            };
            prop_assert_eq!(answer.log_likelihoods.len(), places.len());
            for (found, expected) in answer.log_likelihoods.iter().zip(&expected) {
                prop_assert!((found - expected).abs() < 1e-9, "{} for {}", found, expected);
            }
            prop_assert!((answer.new_place_log_likelihood - new_place).abs() < 1e-9);
            let total: f64 = expected.iter().map(|l| l.exp()).sum::<f64>() + new_place.exp();
            let posterior = |l: f64| params.smoothing * l.exp() / total + (1.0 - params.smoothing) / (places.len() + 1) as f64;
            for (found, expected) in answer.posteriors.iter().zip(&expected) {
                prop_assert!((found - posterior(*expected)).abs() < 1e-9);
            }
            prop_assert!((answer.new_place_posterior - posterior(new_place)).abs() < 1e-9);
            check_ranking(&answer)?;
        }
    }
}

fn check_ranking(answer: &Answer) -> Result<(), TestCaseError> {
    let mut order: Vec<usize> = (0..answer.log_likelihoods.len()).collect();
    order.sort_by(|&a, &b| answer.log_likelihoods[b].total_cmp(&answer.log_likelihoods[a]));
    for count in 0..=order.len() + 1 {
        prop_assert_eq!(&answer.ranked(count), &order[..count.min(order.len())]);
    }
    let first = order.first().filter(|&&place| answer.log_likelihoods[place] > answer.new_place_log_likelihood);
    prop_assert_eq!(answer.best(), first.map_or(Best::NewPlace, |&place| Best::Place(place)));
    Ok(())
}

#[test]
fn samples_of_mapped_places_are_found() {
    let images: Vec<Presence> = [vec![0, 1, 2, 3], vec![4, 5], vec![], vec![6, 7, 0]].map(Presence::from).into();
    let tree = chow_liu::train(&images, 8, 0.0).unwrap();
    let mut map = FabMap::new(&tree, FabMapParams::OPENFABMAP, &images).unwrap();
    for place in [vec![5], vec![0, 1, 2, 3], vec![1, 2, 3], vec![]] {
        map.add_place(&Presence::from(place)).unwrap();
    }
    let found = |similarity| -> Vec<_> {
        map.samples_like_places(similarity).iter().map(|o| (o.sample, o.place, o.similarity)).collect()
    };
    assert_eq!(found(0.5), [(0, 1, 1.0), (1, 0, 0.5)]);
    assert_eq!(found(0.51), [(0, 1, 1.0)]);
}

#[test]
fn a_sample_of_the_mapped_route_suppresses_the_revisit() {
    // The fault that the guard is for: the same image as sample makes the revisit a new place.
    let others: Vec<Presence> = (0..6u32).map(|i| Presence::from(vec![i, (i + 1) % 6, (i * i) % 6])).collect();
    let place = Presence::from(vec![6, 7]);
    let tree = chow_liu::train(&others, 8, 0.0).unwrap();
    let best = |samples: &[Presence]| {
        let mut map = FabMap::new(&tree, FabMapParams::OPENFABMAP, samples).unwrap();
        map.add_place(&place).unwrap();
        map.query(&place).unwrap().best()
    };
    assert_eq!(best(&others), Best::Place(0));
    assert_eq!(best(std::slice::from_ref(&place)), Best::NewPlace);
}

#[test]
fn other_vocabularies_and_impossible_parameters_are_refused() {
    let images = [Presence::from(vec![0, 1])];
    let tree = chow_liu::train(&images, 2, 0.0).unwrap();
    let wrong = Presence::from(vec![0, 2]);
    let mut map = FabMap::new(&tree, FabMapParams::OPENFABMAP, &images).unwrap();
    let refused = |what| Err(FabMapError::WordOutOfRange { what, word: 2, words: 2 });
    assert_eq!(map.add_place(&wrong), refused("a place"));
    assert_eq!(map.query(&wrong).map(|_| 0), refused("a query"));
    assert_eq!(FabMap::new(&tree, FabMapParams::OPENFABMAP, &[]).map(|_| 0), Err(FabMapError::NoSamples));
    for (p_detect_present, p_detect_absent) in [(1.0, 0.0), (0.3, 0.3), (0.3, -0.1), (f64::NAN, 0.0)] {
        let params = FabMapParams { p_detect_present, p_detect_absent, ..FabMapParams::OPENFABMAP };
        assert!(matches!(FabMap::new(&tree, params, &images), Err(FabMapError::BadParams(_))));
    }
    assert_eq!(map.query(&images[0]).map(|answer| answer.best()), Ok(Best::NewPlace));
}
