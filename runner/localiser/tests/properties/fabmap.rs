use super::presences;
use furrow_localiser::fabmap::{
    Answer, Best, FabMap, FabMapError, FabMapParams, MotionModel, NewPlace, Track, WordDependence,
};
use furrow_localiser::{ChowLiuTree, Presence, chow_liu};
use proptest::prelude::*;

const WORDS: u32 = 8;

/// The log-likelihood as a sum over all words, written out (Cummins and Newman 2008); `place` = `None` is the average
/// place.
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

proptest! {
    /// A drive of several queries against the whole matrix of transitions, with places added on the way.
    #[test]
    fn a_track_is_the_markov_chain(
        images in presences(WORDS, 2..8),
        places in presences(WORDS, 1..7),
        queries in presences(WORDS, 1..6),
        known in 0usize..7,
        chances in (0.0..=1.0f64, 0.0..0.6f64, 0.0..0.4f64, 0.0..=1.0f64),
        smoothing in 0.5..=1.0f64,
    ) {
        let (forward, stay, leave, come_back) = chances;
        let motion = MotionModel { forward, stay, leave, come_back };
        let tree = chow_liu::train(&images, WORDS as usize, 0.0).unwrap();
        let params = FabMapParams { smoothing, ..FabMapParams::OPENFABMAP };
        let mut map = FabMap::new(&tree, params, &images).unwrap();
        let mut track = Track::new(motion).unwrap();
        // The new place is the last state.
        let mut before: Option<Vec<f64>> = None;
        for (step, query) in queries.iter().enumerate() {
            while map.places() < places.len().min(known + step) {
                map.add_place(&places[map.places()]).unwrap();
            }
            let n = map.places();
            let mut answer = map.query(query).unwrap();
            track.follow(&mut answer, smoothing);
            let to = |from: usize, to: usize| -> f64 {
                match (from == n, to == n) {
                    (true, true) => if n == 0 { 1.0 } else { 1.0 - come_back },
                    (true, false) => come_back / n as f64,
                    (false, true) => leave,
                    (false, false) => {
                        let next = if from + 1 < n { from + 1 } else { from };
                        let previous = if from > 0 { from - 1 } else { from };
                        let mut chance = if to == from { stay } else { 0.0 };
                        chance += if to == next { (1.0 - stay - leave) * forward } else { 0.0 };
                        chance + if to == previous { (1.0 - stay - leave) * (1.0 - forward) } else { 0.0 }
                    }
                }
            };
            let prior: Vec<f64> = match &before {
                None => vec![1.0 / (n + 1) as f64; n + 1],
                Some(before) => {
                    let mut then = before.clone();
                    let new_place = then.pop().unwrap();
                    then.resize(n, 0.0);
                    then.push(new_place);
                    (0..=n).map(|state| (0..=n).map(|from| then[from] * to(from, state)).sum()).collect()
                }
            };
            prop_assert!((prior.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            let likelihood = |state: usize| {
                if state == n { answer.new_place_log_likelihood.exp() } else { answer.log_likelihoods[state].exp() }
            };
            let total: f64 = (0..=n).map(|state| prior[state] * likelihood(state)).sum();
            let share = |state: usize| prior[state] * likelihood(state) / total;
            let after: Vec<f64> = (0..=n).map(|s| smoothing * share(s) + (1.0 - smoothing) / (n + 1) as f64).collect();
            for (found, expected) in answer.posteriors.iter().chain([&answer.new_place_posterior]).zip(&after) {
                prop_assert!((found - expected).abs() < 1e-9, "{} for {}", found, expected);
            }
            before = Some(after);
        }
    }
}

/// openFABMAP's bias is the wrong way round: here, a robot that drives forward is expected at the next place.
#[test]
fn forward_is_towards_the_next_place() {
    let images: Vec<Presence> = (0..5u32).map(|i| Presence::from(vec![i, i + 3])).collect();
    let tree = chow_liu::train(&images, 8, 0.0).unwrap();
    let mut map = FabMap::new(&tree, FabMapParams::OPENFABMAP, &images).unwrap();
    for image in &images {
        map.add_place(image).unwrap();
    }
    let mut track = Track::new(MotionModel { forward: 0.9, ..MotionModel::DEFAULT }).unwrap();
    let mut answer = map.query(&images[2]).unwrap();
    track.follow(&mut answer, 1.0);
    // An answer that tells nothing shows the prior.
    answer.log_likelihoods.fill(0.0);
    answer.new_place_log_likelihood = 0.0;
    track.follow(&mut answer, 1.0);
    assert!(answer.posteriors[3] > 2.0 * answer.posteriors[1], "{:?}", answer.posteriors);
    let bad = MotionModel { stay: 0.8, leave: 0.3, ..MotionModel::DEFAULT };
    assert!(Track::new(bad).unwrap_err().to_string().contains("stay + leave"));
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
