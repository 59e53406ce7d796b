//! Against a scene whose geometry is known.

use super::estimate::{TwoViewMatch, verify_two_view};
use crate::params::{BucketParams, TwoViewParams};
use crate::test_support::uniform;
use crate::verification::correspondence::Correspondence;
use furrow_model::{Se3, StereoRig};
use nalgebra::Matrix3;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;

const RIG: StereoRig =
    StereoRig { width: 640, height: 360, focal_px: 264.0, cu_px: 319.5, cv_px: 179.5, baseline_m: 0.12 };

/// What a camera and a second one see of `count` points 3 to 30 m away.
fn scene(count: usize, candidate_from_live: &Se3) -> Vec<TwoViewMatch> {
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let mut draw = |from: f64, to: f64| uniform(&mut rng, from, to);
    let mut matches = Vec::new();
    while matches.len() < count {
        let live_px = [draw(0.0, 640.0), draw(0.0, 360.0)];
        let z = draw(3.0, 30.0);
        let point_m = [(live_px[0] - RIG.cu_px) * z / RIG.focal_px, (live_px[1] - RIG.cv_px) * z / RIG.focal_px, z];
        let there_m = candidate_from_live.apply(point_m);
        if there_m[2] > 0.5 {
            let at = Correspondence { live_px, candidate_px: RIG.project(there_m) };
            matches.push(TwoViewMatch { at, distance: matches.len() as f32 });
        }
    }
    matches
}

fn moved() -> Se3 {
    Se3::from_quaternion([0.01, 0.05, -0.02, 1.0], [0.3, 0.05, -0.8])
}

fn unthinned() -> TwoViewParams {
    TwoViewParams { bucket: BucketParams { side_px: 1, matches: usize::MAX }, ..TwoViewParams::default() }
}

#[test]
fn the_geometry_survives_a_majority_of_wrong_matches() {
    let mut matches = scene(150, &moved());
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    for m in &mut matches[60..] {
        m.at.candidate_px = [uniform(&mut rng, 0.0, 640.0), uniform(&mut rng, 0.0, 360.0)];
    }
    let found = verify_two_view(&matches, &unthinned());
    assert_eq!(found.matches, 150);
    let right = |c: &&Correspondence| matches[..60].iter().any(|m| m.at == **c);
    assert_eq!(found.correspondences.iter().filter(right).count(), 60);
    // A wrong match lies within 1.5 px of its epipolar line by chance, about one in a hundred times.
    assert!(found.inliers < 66, "{}", found.inliers);
    // The epipole of the live image is where it sees the candidate's camera.
    let matrix = Matrix3::from_fn(|row, column| found.fundamental.unwrap()[row][column]);
    let [u, v] = RIG.project(moved().inverse().translation_m);
    let epipole = nalgebra::Vector3::new(u, v, 1.0);
    assert!((matrix * epipole).norm() < 0.02 * matrix.norm() * epipole.norm(), "{:?}", matrix * epipole);
    assert_eq!(found, verify_two_view(&matches, &unthinned()));
}

#[test]
fn unrelated_images_agree_on_little() {
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let mut draw = || [uniform(&mut rng, 0.0, 640.0), uniform(&mut rng, 0.0, 360.0)];
    let matches: Vec<TwoViewMatch> = (0..150)
        .map(|distance| TwoViewMatch {
            at: Correspondence { live_px: draw(), candidate_px: draw() },
            distance: distance as f32,
        })
        .collect();
    let inliers = verify_two_view(&matches, &unthinned()).inliers;
    assert!((8..20).contains(&inliers), "{inliers}");
}

#[test]
fn thinning_keeps_the_best_of_a_place() {
    let mut matches = scene(60, &moved());
    let crowd = matches[7];
    matches.extend((0..40).map(|k| TwoViewMatch { distance: 100.0 + k as f32, ..crowd }));
    assert_eq!(verify_two_view(&matches, &unthinned()).inliers, 100);
    // One of the copies is kept beside the original.
    assert!(verify_two_view(&matches, &TwoViewParams::default()).inliers <= 61);
}

#[test]
fn degenerate_matches_give_no_geometry_and_no_panic() {
    let params = unthinned();
    let all_alike = vec![scene(1, &moved())[0]; 30];
    assert_eq!(verify_two_view(&all_alike, &params).inliers, 0);
    let mut on_a_line = scene(30, &moved());
    on_a_line.iter_mut().enumerate().for_each(|(i, m)| m.at.live_px = [i as f64, 2.0 * i as f64]);
    verify_two_view(&on_a_line, &params);
    let mut torn = scene(30, &moved());
    torn.iter_mut().for_each(|m| m.at.candidate_px[0] = f64::NAN);
    assert_eq!(verify_two_view(&torn, &params).matches, 0);
    assert_eq!(verify_two_view(&scene(7, &moved()), &params).fundamental, None);
    assert_eq!(verify_two_view(&[], &params).inliers, 0);
    // Without a translation every geometry with the epipole at infinity fits, and all matches agree.
    assert_eq!(verify_two_view(&scene(40, &Se3::IDENTITY), &params).inliers, 40);
}
