use furrow_localiser::external::{ExternalError, ImageDescriptors, Metric, rank as rank_external};
use furrow_localiser::ranking::Ranked;
use furrow_localiser::seqslam::{Route, SeqSlamError, SeqSlamParams, Thumbnail, rank as rank_sequences};
use furrow_model::GreyImage;
use proptest::prelude::*;

/// Places by falling score, sorted in full; ties keep their order.
fn sorted(scores: Vec<f64>, count: usize) -> Vec<Ranked> {
    let mut all: Vec<Ranked> = (0..).zip(scores).map(|(place, score)| Ranked { place, score }).collect();
    all.sort_by(|a, b| b.score.total_cmp(&a.score));
    all.truncate(count);
    all
}

fn check(found: &[Ranked], expected: &[Ranked]) -> Result<(), TestCaseError> {
    prop_assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        // Near ties may change places; their scores may not.
        prop_assert!((found.score - expected.score).abs() < 1e-9, "{:?} for {:?}", found, expected);
    }
    Ok(())
}

proptest! {
    #[test]
    fn external_descriptors_are_ranked_as_by_brute_force(
        live in proptest::collection::vec(-3i8..4, 5 * 4),
        places in proptest::collection::vec(-3i8..4, 5 * 7),
        count in 0usize..9,
    ) {
        let of = |numbers: &[i8]| ImageDescriptors::new(5, numbers.iter().map(|&n| f32::from(n)).collect()).unwrap();
        for metric in [Metric::Cosine, Metric::L2] {
            let found = rank_external(&of(&live), &of(&places), metric, count).unwrap();
            for (live, found) in live.chunks(5).zip(&found) {
                let score = |place: &[i8]| {
                    let sum = |term: &dyn Fn(f64, f64) -> f64| -> f64 {
                        live.iter().zip(place).map(|(a, b)| term(f64::from(*a), f64::from(*b))).sum()
                    };
                    let norms = sum(&|a, _| a * a).sqrt() * sum(&|_, b| b * b).sqrt();
                    match metric {
                        Metric::L2 => -sum(&|a, b| (a - b).powi(2)).sqrt(),
                        Metric::Cosine if norms == 0.0 => 0.0,
                        Metric::Cosine => sum(&|a, b| a * b) / norms,
                    }
                };
                check(found, &sorted(places.chunks(5).map(score).collect(), count))?;
            }
        }
    }

    #[test]
    fn sequences_are_ranked_as_by_brute_force(
        seeds in proptest::collection::vec(0u32..50, 3..14),
        live_seeds in proptest::collection::vec(0u32..50, 1..12),
        gaps in proptest::collection::vec(0.0..2.0f64, 26),
        images in 1usize..6,
        window in 2usize..7,
        slowest in 0.7..1.0f64,
        count in 1usize..6,
    ) {
        let thumbnails = |seeds: &[u32]| -> Vec<Thumbnail> { seeds.iter().map(|&seed| thumbnail(seed)).collect() };
        let distances = |gaps: &[f64]| -> Vec<f64> {
            gaps.iter().scan(0.0, |sum, gap| { *sum += gap; Some(*sum) }).collect()
        };
        let (places, live) = (thumbnails(&seeds), thumbnails(&live_seeds));
        let (places_m, live_m) = (distances(&gaps[..places.len()]), distances(&gaps[14..14 + live.len()]));
        let params = SeqSlamParams { images, spacing_m: 1.1, window, speeds: [slowest, 1.3], speed_step: 0.15, shift: 0.04 };
        let found = rank_sequences(
            Route { images: &live, travelled_m: &live_m },
            Route { images: &places, travelled_m: &places_m },
            &params,
            count,
        ).unwrap();
        prop_assert_eq!(found.len(), live.len());
        for (newest, found) in found.iter().enumerate() {
            let scores = (0..places.len()).map(|place| {
                naive_score(&live, &live_m, &places, &places_m, &params, newest, place)
            });
            check(found, &sorted(scores.collect(), count))?;
        }
    }
}

fn thumbnail(seed: u32) -> Thumbnail {
    let grey = |i: u32| (i.wrapping_mul(2_654_435_761).wrapping_add(seed * 977).wrapping_mul(40_503) >> 13) as u8;
    Thumbnail::of(&GreyImage::new(64, 32, (0..64 * 32).map(grey).collect()).unwrap())
}

/// Milford and Wyeth's sums as they stand: for every speed, along the line, the normalised difference of the nearest
/// place.
fn naive_score(
    live: &[Thumbnail],
    live_m: &[f64],
    places: &[Thumbnail],
    places_m: &[f64],
    params: &SeqSlamParams,
    newest: usize,
    place: usize,
) -> f64 {
    let nearest = |all: &[f64], metres: f64| {
        let mut best = 0;
        for (i, at) in all.iter().enumerate() {
            if (at - metres).abs() < (all[best] - metres).abs() {
                best = i;
            }
        }
        best
    };
    let normalised = |image: usize, place: usize| {
        let first = place.saturating_sub(params.window / 2);
        let last = (place + params.window / 2).min(places.len() - 1);
        let near: Vec<f64> = (first..=last).map(|p| live[image].difference(&places[p], params.shift)).collect();
        let mean = near.iter().sum::<f64>() / near.len() as f64;
        let deviation = (near.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / near.len() as f64).sqrt();
        if deviation > 0.0 { (live[image].difference(&places[place], params.shift) - mean) / deviation } else { 0.0 }
    };
    let mut best = f64::NEG_INFINITY;
    let mut speed = params.speeds[0];
    while speed <= params.speeds[1] + 1e-9 {
        let (mut sum, mut count) = (0.0, 0.0);
        for k in 0..params.images {
            let metres = live_m[newest] - k as f64 * params.spacing_m;
            if metres < live_m[0] {
                break;
            }
            let image = if k == 0 { newest } else { nearest(live_m, metres) };
            let before = live_m[newest] - live_m[image];
            let there = if before == 0.0 { place } else { nearest(places_m, places_m[place] - speed * before) };
            sum += normalised(image, there);
            count += 1.0;
        }
        best = best.max(-sum / count);
        speed += params.speed_step;
    }
    best
}

/// Half of every live image is another place's: alone they are ambiguous, in a row they are not.
#[test]
fn a_sequence_is_recognised_where_single_images_are_not() {
    let grey = |seed: usize, i: usize| ((i * 7919 + seed * 104_729) * 31 % 1009 % 251) as u8;
    let image = |left: usize, right: usize| {
        let pixels = (0..64 * 32).map(|i| grey(if i % 64 < 32 { left } else { right }, i)).collect();
        Thumbnail::of(&GreyImage::new(64, 32, pixels).unwrap())
    };
    let places: Vec<Thumbnail> = (0..40).map(|place| image(place, place)).collect();
    let places_m: Vec<f64> = (0..40).map(|place| f64::from(place) * 2.0).collect();
    // Live from place 10 to 29, four frames a place, the right half that of a place far away.
    let live: Vec<Thumbnail> = (0..80).map(|i| image(10 + i / 4, (10 + i / 4) * 17 % 40)).collect();
    let live_m: Vec<f64> = (0..80).map(|i| f64::from(i) * 0.5).collect();
    let right = |images: usize| {
        let params = SeqSlamParams { images, ..SeqSlamParams::at_spacing(2.0) };
        let (live, places) =
            (Route { images: &live, travelled_m: &live_m }, Route { images: &places, travelled_m: &places_m });
        let ranked = rank_sequences(live, places, &params, 1).unwrap();
        (40..80).filter(|&i| ranked[i][0].place.abs_diff(10 + i / 4) <= 1).count()
    };
    assert_eq!(right(10), 40);
    assert!(right(1) < 36, "{}", right(1));
}

#[test]
fn what_does_not_belong_together_is_refused() {
    let two = ImageDescriptors::new(2, vec![1.0; 4]).unwrap();
    let three = ImageDescriptors::new(3, vec![1.0; 6]).unwrap();
    let refused = Err(ExternalError::OtherDimensions { live: 2, places: 3 });
    assert_eq!(rank_external(&two, &three, Metric::L2, 1), refused);
    assert_eq!(ImageDescriptors::new(2, vec![1.0; 3]), Err(ExternalError::Ragged { numbers: 3, dimensions: 2 }));
    let bad = ImageDescriptors::new(2, vec![1.0, 1.0, 1.0, f32::INFINITY]);
    assert_eq!(bad, Err(ExternalError::NotFinite { image: 1, position: 1, value: f32::INFINITY }));
    let images = [thumbnail(1), thumbnail(2)];
    let route = |travelled_m| Route { images: &images, travelled_m };
    let params = SeqSlamParams::at_spacing(2.0);
    let error = rank_sequences(route(&[0.0, -1.0]), route(&[0.0, 1.0]), &params, 1);
    assert!(matches!(error, Err(SeqSlamError::BadDistances { what: "live images", .. })));
    let no_images = SeqSlamParams { images: 0, ..params };
    assert!(matches!(
        rank_sequences(route(&[0.0, 1.0]), route(&[0.0, 1.0]), &no_images, 1),
        Err(SeqSlamError::BadParams(_))
    ));
}
