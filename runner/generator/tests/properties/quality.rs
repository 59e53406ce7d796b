//! The switch index and the other measures, against generators made to fail and numbers worked out by hand.

use crate::{field, image, moved, trained};
use furrow_generator::Strengths;
use furrow_generator::moments::CellSums;
use furrow_generator::quality::{clipped, doubts, hallucinated, laplacian_energy, mean_step, switch_ladder};
use furrow_model::{ColourImage, GreyImage, Measures, SwitchIndex};

/// The switch index of images as a function of z.
pub fn switch_index(of: impl Fn(f64) -> ColourImage) -> SwitchIndex {
    let images: Vec<ColourImage> = switch_ladder().iter().map(|z| of(*z)).collect();
    let steps: Vec<f64> = images.windows(2).map(|pair| mean_step(&pair[0], &pair[1])).collect();
    SwitchIndex::of(&steps).unwrap()
}

/// Part `share` of the way from one image to the other, in grey levels.
pub fn blend(a: &ColourImage, b: &ColourImage, share: f64) -> ColourImage {
    let rgb =
        a.rgb.iter().zip(&b.rgb).map(|(a, b)| (f64::from(*a) + share * (f64::from(*b) - f64::from(*a))).round() as u8);
    ColourImage { rgb: rgb.collect(), ..a.clone() }
}

/// Claim C10: a hard switch and a narrow sigmoid are caught, a blend and the flow pass.
pub fn judge_all(source: &ColourImage, target: &ColourImage, flow: impl Fn(f64) -> ColourImage) {
    let passes = |name: &str, index: SwitchIndex| {
        assert!(!index.switches() && index.kappa < 4.0, "{name}: {index:?}");
        index.kappa
    };
    let linear = passes("linear", switch_index(|z| blend(source, target, z)));
    assert!((linear - 1.0).abs() < 0.3, "a linear blend has about 1.0: {linear}");
    passes("otf", switch_index(flow));
    let hard = switch_index(|z| if z < 0.5 { source.clone() } else { target.clone() });
    let sigmoid = switch_index(|z| blend(source, target, 1.0 / (1.0 + (-(z - 0.5) / 0.04).exp())));
    for (name, index) in [("hard switch", hard), ("sigmoid", sigmoid)] {
        assert!(index.switches() && (0.4..=0.6).contains(&index.at), "{name}: {index:?}");
        assert!(doubts(Some(&index), &[]).len() == 1, "{name}");
    }
    assert!(hard.kappa > 100.0, "{hard:?}");
}

#[test]
fn switches_are_caught_and_flows_pass() {
    let source = field(320, 180, 3);
    let target = image(320, 180, |x, y| {
        let [r, g, b] = [0, 1, 2].map(|c| source.rgb[3 * (y * 320 + x) + c]);
        [r / 2, g / 2 + 20, b / 2 + 60]
    });
    let flow = trained(std::slice::from_ref(&source), std::slice::from_ref(&target), Strengths::default());
    judge_all(&source, &target, |z| moved(&flow, &source, z));
}

#[test]
fn a_late_jump_is_no_switch_in_the_middle_and_stillness_is_none() {
    let mut steps = [1.0; 20];
    steps[18] = 50.0;
    assert!(!SwitchIndex::of(&steps).unwrap().switches());
    assert!(!SwitchIndex::of(&[0.0; 20]).unwrap().switches());
    assert_eq!(SwitchIndex::of(&[]), None);
    // Largest 3 over a median of 1 and 0.05.
    let index = SwitchIndex::of(&[1.0, 3.0, 1.0]).unwrap();
    assert!((index.kappa - 3.0 / 1.05).abs() < 1e-12 && (index.at - 0.5).abs() < 1e-12);
}

#[test]
fn measures_are_those_worked_out_by_hand() {
    // A single bright pixel of 10 in a 5 x 5 image of 0: Laplacian -40 there and 10 at its four neighbours, over 9
    // inner pixels.
    let mut pixels = vec![0; 25];
    pixels[12] = 10;
    let point = GreyImage::new(5, 5, pixels).unwrap();
    assert!((laplacian_energy(&point) - (1600.0 + 4.0 * 100.0) / 9.0).abs() < 1e-12);
    assert_eq!(laplacian_energy(&GreyImage::new(2, 9, vec![7; 18]).unwrap()), 0.0);

    let quarters = image(4, 2, |x, _| [[0, 0, 0], [255, 9, 9], [9, 254, 1], [0, 9, 0]][x]);
    assert_eq!(clipped(&quarters), 0.75);

    // Left half flat, right half a chess board: two of three keypoints lie on the flat half.
    let board = (0..60 * 40).map(|i| if i % 60 < 30 { 90 } else { 60 * ((i % 60 + i / 60) % 2) as u8 }).collect();
    let board = GreyImage::new(60, 40, board).unwrap();
    let share = hallucinated(&board, &[(5.0, 5.0), (12.0, 30.0), (50.0, 20.0)]).unwrap();
    assert!((share - 2.0 / 3.0).abs() < 1e-12);
    assert_eq!(hallucinated(&board, &[]), None);
    assert!(hallucinated(&board, &[(-5.0, 900.0)]).is_some(), "places outside are brought to the edge");
}

#[test]
fn doubts_name_what_is_wrong() {
    let fine = |z: f64| Measures {
        z,
        matchable: 500.0,
        good_matches: 400.0,
        descriptor_distance: 0.02,
        descriptor_loss: 0.004,
        laplacian_ratio: 1.1,
        clipped: 0.05,
        clipped_source: 0.04,
        clipped_target: None,
        hallucinated: 0.01,
    };
    assert_eq!(fine(0.5).retention(), 0.8);
    assert!(doubts(None, &[fine(0.25), fine(0.5), fine(1.0)]).is_empty());
    let one = |measures: Measures, word: &str| {
        let found = doubts(None, &[fine(0.25), measures, fine(1.0)]);
        assert!(found.len() == 1 && found[0].contains(word), "{found:?}");
    };
    one(Measures { laplacian_ratio: 0.4, ..fine(0.5) }, "Laplacian");
    one(Measures { laplacian_ratio: 2.1, ..fine(0.5) }, "Laplacian");
    one(Measures { clipped: 0.2, ..fine(0.5) }, "clipped");
    one(Measures { clipped: 0.2, clipped_target: Some(0.06), ..fine(0.5) }, "mimics");
    // What is mimicked is as black.
    assert!(doubts(None, &[Measures { clipped: 0.2, clipped_target: Some(0.12), ..fine(0.5) }]).is_empty());
    one(Measures { hallucinated: 0.3, ..fine(0.5) }, "keypoints");
    one(Measures { good_matches: 100.0, ..fine(0.5) }, "dip");
}

/// Sums of known pixels: the mean and covariance of two colours.
#[test]
fn moments_are_means_and_covariances() {
    let mut sums = CellSums::default();
    assert_eq!((sums.mean(), sums.covariance().is_none()), (None, true));
    for v in [[1.0, 0.0, 2.0], [3.0, 0.0, 6.0]] {
        sums.merge(&CellSums {
            weight: 0.5,
            first: v.map(|x| 0.5 * x),
            second: [v[0] * v[0], v[0] * v[1], v[0] * v[2], v[1] * v[1], v[1] * v[2], v[2] * v[2]].map(|x| 0.5 * x),
            bands: [0.0; 4],
        });
    }
    assert_eq!(sums.mean(), Some([2.0, 0.0, 4.0]));
    assert_eq!(sums.covariance(), Some([[1.0, 0.0, 2.0], [0.0, 0.0, 0.0], [2.0, 0.0, 4.0]]));
}
