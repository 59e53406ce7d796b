use super::{descriptors, on_thread_counts};
use furrow_localiser::Vocabulary;
use furrow_localiser::vocabulary::{
    Descriptor, KMeans, TrainingSample, VocabularyError, train_kmeans, train_sequential,
};

fn squared_distance(a: &Descriptor, b: &Descriptor) -> f64 {
    a.iter().zip(b).map(|(a, b)| (f64::from(*a) - f64::from(*b)).powi(2)).sum()
}

fn nearest(words: &[Descriptor], descriptor: &Descriptor) -> (usize, f64) {
    let mut best = (0, f64::INFINITY);
    for (index, word) in words.iter().enumerate() {
        let distance = squared_distance(word, descriptor);
        if distance < best.1 {
            best = (index, distance);
        }
    }
    best
}

#[test]
fn kmeans_finds_separate_clusters_and_says_its_error() {
    let points = descriptors(1200, 30, 0.1, 3);
    let mut rounds = Vec::new();
    let (vocabulary, record) = train_kmeans(&points, 40, 5, &mut |progress| rounds.push(progress)).unwrap();
    let recount = points.iter().map(|point| nearest(vocabulary.words(), point).1).sum::<f64>() / points.len() as f64;
    assert!((record.quantisation_error - recount.sqrt()).abs() < 1e-12);
    assert_eq!((record.words, record.descriptors, record.descriptors_used, record.seed), (40, 1200, 1200, 5));
    assert_eq!(rounds.len(), record.iterations + 1);
    assert!(rounds.windows(2).all(|pair| pair[1].quantisation_error <= pair[0].quantisation_error));
    // The points lie around 30 directions: 40 words must serve them at least as well as the 30 means do.
    let mean = |cluster: usize| -> Descriptor {
        let members: Vec<_> = points.iter().skip(cluster).step_by(30).collect();
        std::array::from_fn(|k| members.iter().map(|m| m[k]).sum::<f32>() / members.len() as f32)
    };
    let means: Vec<Descriptor> = (0..30).map(mean).collect();
    let best = points.iter().map(|point| nearest(&means, point).1).sum::<f64>() / points.len() as f64;
    assert!(recount < best, "{recount} against {best}");
}

#[test]
fn kmeans_gives_the_same_bits_on_any_number_of_threads_and_others_with_another_seed() {
    let points = descriptors(3000, 200, 0.8, 4);
    let train = |seed| train_kmeans(&points, 150, seed, &mut |_| ()).unwrap();
    let all = on_thread_counts(|| train(9));
    assert!(all.iter().all(|trained| *trained == all[0]));
    assert!(train(10).0 != all[0].0);
}

#[test]
fn as_many_words_as_different_descriptors_represent_each_exactly() {
    let mut points = descriptors(40, 40, 0.0, 6);
    points.extend_from_within(..);
    let (vocabulary, record) = train_kmeans(&points, 40, 1, &mut |_| ()).unwrap();
    assert_eq!((record.quantisation_error, record.descriptors, record.descriptors_used), (0.0, 80, 40));
    assert_eq!(vocabulary.presence(&points).unwrap().len(), 40);
    let error = train_kmeans(&points, 41, 1, &mut |_| ()).unwrap_err();
    assert_eq!(error, VocabularyError::TooFewDescriptors { words: 41, distinct: 40 });
    assert!(error.to_string().contains("at most 40 words"));
}

#[test]
fn large_sets_are_sampled() {
    let points = descriptors(1000, 7, 0.5, 8);
    let (_, record) = train_kmeans(&points, 3, 1, &mut |_| ()).unwrap();
    assert_eq!((record.descriptors, record.descriptors_used), (1000, 3 * 128));
}

/// Every different descriptor has the same chance to be kept, hence to be a first word, whenever it comes.
#[test]
fn the_sample_is_uniform_and_bounded_and_counts_repeats_once() {
    let points = descriptors(640, 640, 0.0, 12);
    let mut kept = vec![0; 640];
    for seed in 0..200 {
        let mut sample = TrainingSample::new(3, seed).unwrap();
        for image in points.chunks(50) {
            sample.offer(image).unwrap();
            sample.offer(image).unwrap();
        }
        assert_eq!((sample.offered(), sample.kept()), (1280, 384));
        let words = KMeans::start(sample).unwrap().checkpoint().words;
        for word in words.as_chunks::<64>().0 {
            kept[points.iter().position(|point| point == word).unwrap()] += 1;
        }
    }
    let thirds: Vec<i32> = kept.chunks(214).map(|third| third.iter().sum()).collect();
    assert!(thirds.iter().all(|third| (140..260).contains(third)), "{thirds:?}");
}

#[test]
fn a_training_that_was_stopped_goes_on_to_the_same_bits() {
    let points = descriptors(3000, 200, 0.8, 4);
    let sample = || {
        let mut sample = TrainingSample::new(150, 9).unwrap();
        points.chunks(77).for_each(|image| sample.offer(image).unwrap());
        sample
    };
    let straight = train_kmeans(&points, 150, 9, &mut |_| ()).unwrap();
    assert_eq!(KMeans::start(sample()).unwrap().finish(), straight);
    assert!(straight.1.iterations > 4, "{:?}", straight.1);
    for stop in 0..=straight.1.iterations {
        let mut training = KMeans::start(sample()).unwrap();
        for _ in 0..stop {
            training.step();
        }
        let written = serde_json::to_string(&training.checkpoint()).unwrap();
        let resumed = KMeans::resume(sample(), serde_json::from_str(&written).unwrap()).unwrap();
        assert_eq!(resumed.finish(), straight, "stopped after {stop} rounds");
    }
    let mut wrong = KMeans::start(sample()).unwrap().checkpoint();
    wrong.words.truncate(64);
    let error = KMeans::resume(sample(), wrong).unwrap_err();
    assert_eq!(error, VocabularyError::WrongCheckpoint { numbers: 64, words: 150 });
    assert!(error.to_string().contains("9600"));
}

#[test]
fn sequential_clustering_is_the_naive_one() {
    let points = descriptors(2500, 60, 0.35, 2);
    let radius = 0.45;
    let mut centres: Vec<Descriptor> = Vec::new();
    for point in &points {
        if centres.iter().all(|centre| squared_distance(centre, point).sqrt() > radius) {
            centres.push(*point);
        }
    }
    assert!(centres.len() > 60 && centres.len() < 2500, "{}", centres.len());
    let mut sums = vec![([0.0_f64; 64], 0.0); centres.len()];
    for point in &points {
        let (sum, members) = &mut sums[nearest(&centres, point).0];
        sum.iter_mut().zip(point).for_each(|(sum, value)| *sum += f64::from(*value));
        *members += 1.0;
    }
    let means: Vec<Descriptor> = sums.iter().map(|(sum, members)| sum.map(|value| (value / members) as f32)).collect();
    assert_eq!(train_sequential(&points, radius).unwrap().words(), means);
}

#[test]
fn what_is_no_descriptor_is_refused() {
    let mut points = descriptors(5, 5, 0.0, 1);
    assert_eq!(train_kmeans(&points, 0, 1, &mut |_| ()).unwrap_err(), VocabularyError::NoWords);
    assert_eq!(train_kmeans(&[], 2, 1, &mut |_| ()).unwrap_err(), VocabularyError::NoDescriptors);
    assert_eq!(train_sequential(&[], 0.4), Err(VocabularyError::NoDescriptors));
    assert!(matches!(train_sequential(&points, f64::NAN), Err(VocabularyError::BadRadius { .. })));
    assert_eq!(Vocabulary::from_flat(vec![0.0; 65]), Err(VocabularyError::Ragged { numbers: 65 }));
    assert_eq!(Vocabulary::from_flat(vec![]), Err(VocabularyError::Ragged { numbers: 0 }));
    let vocabulary = Vocabulary::from_flat(points.as_flattened().to_vec()).unwrap();
    assert!(vocabulary.presence(&[]).unwrap().is_empty());
    points[3][7] = f32::NAN;
    for result in [vocabulary.presence(&points).map(|_| ()), train_kmeans(&points, 2, 1, &mut |_| ()).map(|_| ())] {
        assert!(matches!(result, Err(VocabularyError::NotFinite { what: "descriptor", index: 3, position: 7, .. })));
    }
}
