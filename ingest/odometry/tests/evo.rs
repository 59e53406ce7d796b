//! The comparison of tracks against evo 1.38.1 (`evo.core.metrics` APE and RPE, `evo.core.sync`) on the same two
//! curves. The expected numbers are evo's.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use furrow_model::Se3;
use furrow_odometry::compare::{
    Alignment, Delta, Spread, Track, align, associate, errors_per_length, position_errors, step_errors,
};

/// Sixty poses on a curve; the second curve wobbles, lags by 2 ms and lacks three poses.
fn curve(second: bool) -> Track {
    let wobble = |value: f64| if second { value } else { 0.0 };
    let pose = |i: usize| {
        let t = 0.1 * i as f64;
        let x = 3.0 * (0.5 * t).sin() + wobble(0.05 * (7.0 * t).sin());
        let z = 4.0 * (0.4 * t).cos() - wobble(0.02 * t * t);
        let turn = [0.1 * t.sin(), 0.25 * t + wobble(0.02 * (3.0 * t).cos()), 0.05 * (2.0 * t).cos(), 1.0];
        (100.0 + t + wobble(0.002), Se3::from_quaternion(turn, [x, 0.2 * t + wobble(0.03 * t), z]))
    };
    let kept = |i: &usize| !second || !(10..13).contains(i);
    let (stamps, poses) = (0..60).filter(kept).map(pose).unzip();
    Track { stamps_s: Some(stamps), poses }
}

fn matched() -> (Vec<Se3>, Vec<Se3>) {
    let (reference, estimate) = (curve(false), curve(true));
    let pairs = associate(&reference.stamps_s.unwrap(), &estimate.stamps_s.unwrap(), 0.01);
    pairs.into_iter().map(|(i, j)| (reference.poses[i], estimate.poses[j])).unzip()
}

/// rmse, mean, median, std, min, max to nine digits, and the number of errors.
fn agree(what: &str, errors: &[f64], evo: [f64; 6], count: usize) {
    let found = Spread::of(errors).unwrap();
    assert_eq!(found.count, count, "{what}");
    for (ours, theirs) in [found.rmse, found.mean, found.median, found.std, found.min, found.max].into_iter().zip(evo) {
        assert!((ours - theirs).abs() < 1e-9, "{what}: {found:?}, evo {evo:?}");
    }
}

#[test]
fn absolute_errors_equal_those_of_evo() {
    let (reference, estimate) = matched();
    let unaligned =
        [0.34180454199888455, 0.2700919312489839, 0.21399962163888459, 0.20947719113369206, 0.0, 0.7186896161136808];
    let first =
        [0.33311399237607775, 0.25319559006326325, 0.1749306643481688, 0.2164646047030449, 0.0, 0.746381840103901];
    let rigid = [
        0.21889623879284262,
        0.1916369375764661,
        0.18613691923425474,
        0.10578680217289309,
        0.01906575643595454,
        0.45659026374288303,
    ];
    let scaled = [
        0.08559587893834243,
        0.07240502286845742,
        0.054081659568726924,
        0.04565267959983875,
        0.01120237967289315,
        0.18253940719851444,
    ];
    let turned_unaligned = [
        1.0695932398330616,
        0.9061385283674466,
        0.8249656673798392,
        0.5682804467027385,
        0.0357942303216851,
        2.288667389576558,
    ];
    let turned_first =
        [2.4479815248467474, 2.207332363563604, 2.201988880212519, 1.058441015246348, 0.0, 4.257427641333471];
    let turned = [
        1.3806901858486074,
        1.2996996946091035,
        1.1975580360241245,
        0.46592498659297643,
        0.8077650970434476,
        2.675843939167328,
    ];
    let expected = [
        (Alignment::None, unaligned, turned_unaligned),
        (Alignment::First, first, turned_first),
        (Alignment::Rigid, rigid, turned),
        (Alignment::Scaled, scaled, turned),
    ];
    for (alignment, translation, rotation) in expected {
        let (aligned, _) = align(&reference, &estimate, alignment).unwrap();
        let errors = position_errors(&reference, &aligned);
        agree(&format!("APE {alignment:?}"), &errors.translation_m, translation, 57);
        agree(&format!("APE {alignment:?} degrees"), &errors.rotation_deg, rotation, 57);
    }
}

#[test]
fn relative_errors_equal_those_of_evo() {
    let (reference, estimate) = matched();
    let expected = [
        (
            Delta::Frames(1),
            [
                0.028591768390777338,
                0.027067207054876172,
                0.028343160416607015,
                0.009211705703088633,
                0.007349991229474024,
                0.041436205528519336,
            ],
            [
                0.3483774146971805,
                0.3009402713923083,
                0.27687403244129377,
                0.17550434788179792,
                0.015596152803178007,
                0.6680844177262047,
            ],
            56,
        ),
        (
            Delta::Frames(5),
            [
                0.09566814948126905,
                0.08820791217014308,
                0.10423386320416393,
                0.03703726577050148,
                0.032127081059618805,
                0.1434931477287972,
            ],
            [
                1.5226994847844946,
                1.2973463772201244,
                1.2404291810965176,
                0.797186363704739,
                0.20235611484203528,
                2.7036975227037545,
            ],
            11,
        ),
        (
            Delta::Metres(2.0),
            [
                0.15217906631071135,
                0.14284723810002564,
                0.157603729886596,
                0.05247032294921072,
                0.058074686188328166,
                0.19810680643858242,
            ],
            [
                2.037698935443947,
                1.7256476676765484,
                1.7009897103361955,
                1.083677571306098,
                0.21921599943043013,
                3.281395250603373,
            ],
            4,
        ),
    ];
    for (delta, translation, rotation, count) in expected {
        let errors = step_errors(&reference, &estimate, delta);
        agree(&format!("RPE {delta:?}"), &errors.translation_m, translation, count);
        agree(&format!("RPE {delta:?} degrees"), &errors.rotation_deg, rotation, count);
    }
}

#[test]
fn errors_per_length_of_a_track_one_percent_too_long_are_one_percent() {
    let straight = |scale: f64| -> Vec<Se3> {
        (0..201).map(|i| Se3 { translation_m: [0.0, 0.0, 0.25 * f64::from(i) * scale], ..Se3::IDENTITY }).collect()
    };
    let found = errors_per_length(&straight(1.0), &straight(1.01), &[10.0, 20.0, 400.0]);
    assert_eq!(found.iter().map(|error| error.length_m).collect::<Vec<_>>(), [10.0, 20.0], "no stretch is 400 m long");
    for error in found {
        // A stretch ends with the first pose beyond its length: a quarter of a metre more.
        let expected = 0.01 * (error.length_m + 0.25) / error.length_m;
        assert!((error.translation - expected).abs() < 1e-9 && error.rotation_deg_per_m == 0.0, "{error:?}");
    }
}
