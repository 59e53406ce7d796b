use super::{descriptors, on_thread_counts};
use furrow_localiser::codebook::{CodebookError, CodebookParams};
use furrow_localiser::fabmap::{Best, FabMapParams};
use furrow_localiser::vocabulary::{Descriptor, VocabularyError};
use furrow_localiser::{Codebook, FabMap};

const PARAMS: CodebookParams = CodebookParams { words: 120, seed: 11, information_threshold_nats: 0.0 };

/// Image `i` shows 25 of 200 things, others than image `i + 1`; `pass` changes the noise.
fn images(first_thing: usize, count: usize, pass: u64) -> Vec<Vec<Descriptor>> {
    let things = descriptors(200, 200, 0.0, 77);
    let image = |i: usize| -> Vec<Descriptor> {
        let noise = descriptors(25, 25, 0.0, pass * 1000 + i as u64);
        let thing = |j: usize| &things[(first_thing + i * 37 + j * j * 3 + j) % 200];
        (0..25).map(|j| std::array::from_fn(|k| thing(j)[k] + 0.05 * noise[j][k])).collect()
    };
    (0..count).map(image).collect()
}

#[test]
fn a_codebook_localises_a_second_pass_and_knows_new_ground() {
    let (codebook, record) = Codebook::train(&images(100, 40, 1), &PARAMS, &mut |_| ()).unwrap();
    assert_eq!((record.words, codebook.tree.words(), codebook.samples.len()), (120, 120, 40));
    let mut map = FabMap::new(&codebook.tree, FabMapParams::OPENFABMAP, &codebook.samples[20..]).unwrap();
    let words = |image: &Vec<Descriptor>| codebook.vocabulary.presence(image).unwrap();
    images(0, 12, 2).iter().for_each(|image| assert!(map.add_place(&words(image)).is_ok()));
    for (place, image) in images(0, 12, 3).iter().enumerate() {
        assert_eq!(map.query(&words(image)).unwrap().best(), Best::Place(place));
    }
}

#[test]
fn the_number_of_threads_does_not_show() {
    let all = on_thread_counts(|| Codebook::train(&images(0, 30, 1), &PARAMS, &mut |_| ()));
    assert!(all[0].is_ok() && all.iter().all(|trained| *trained == all[0]));
}

#[test]
fn images_without_features_are_an_error() {
    let error = Codebook::train(&[vec![], vec![]], &PARAMS, &mut |_| ()).unwrap_err();
    assert_eq!(error, CodebookError::Vocabulary(VocabularyError::NoDescriptors));
}
