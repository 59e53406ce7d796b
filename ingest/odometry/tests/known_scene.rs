//! Odometry and verification in a scene whose geometry and motion are known exactly.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "scene/lane.rs"]
mod scene;

use furrow_model::{GreyImage, Se3, Trajectory};
use furrow_odometry::{
    ChainBuilder, FrameFeatures, MotionFailure, Odometry, OdometryParams, StereoFrame, VerifyParams, verify_four_view,
    verify_three_view,
};
use rayon::prelude::*;
use scene::{RIG, pose, stereo};

/// An S-shaped path at 0.1 m per frame.
fn path(frames: usize) -> Vec<Se3> {
    let mut poses = vec![pose(0.0, 0.0, 0.0)];
    for i in 1..frames {
        let turn = 0.01 * (i as f64 / 6.0).sin();
        poses.push(poses[i - 1].compose(&pose(0.0, 0.1, turn)));
    }
    poses
}

fn chain(poses: &[Se3], threads: usize) -> Trajectory {
    let odometry = Odometry::new(RIG, OdometryParams::default());
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let prepare = |world_from_left: &Se3| {
        let (left, right) = stereo(world_from_left, 1, 3);
        odometry.prepare(&left, &right)
    };
    pool.install(|| chained(poses.par_iter().map(prepare).collect(), poses.len()))
}

/// The chain of frames a tenth of a second apart, given in batches.
fn chained(frames: Vec<StereoFrame>, batch: usize) -> Trajectory {
    let mut chain = ChainBuilder::new(RIG, OdometryParams::default());
    let stamped: Vec<_> = (0..).map(|i| i * TENTH_NS).zip(frames).collect();
    for batch in stamped.chunks(batch) {
        chain.extend(batch.to_vec());
        // An empty batch changes nothing.
        chain.extend(Vec::new());
    }
    chain.finish()
}

const TENTH_NS: i64 = 100_000_000;

#[test]
fn a_path_at_field_scale_drifts_little_and_is_equal_for_any_thread_count() {
    let poses = path(11);
    let found = chain(&poses, 1);
    assert_eq!((found.steps.len(), found.failed_steps()), (10, 0));
    for (i, step) in found.steps.iter().enumerate() {
        let true_step = poses[i].inverse().compose(&poses[i + 1]);
        let error = true_step.inverse().compose(&step.earlier_from_later);
        assert!(error.distance_m() < 0.005, "step {i}: {} m wrong", error.distance_m());
        assert!(error.angle_rad() < 0.002, "step {i}: {} rad wrong", error.angle_rad());
        assert!(step.inliers > 100, "step {i}: {} inliers", step.inliers);
    }
    let end = found.poses()[10].start_from_here;
    let drift = poses[10].inverse().compose(&end).distance_m();
    assert!(drift < 0.01, "drift {drift}");
    assert_eq!(chain(&poses, 3), found);
}

#[test]
fn a_covariance_has_the_size_of_the_errors() {
    // The scene's calibration is exact.
    let mut odometry = Odometry::new(RIG, OdometryParams { calibration_error: 0.0, ..OdometryParams::default() });
    let poses = path(8);
    let (mut normalised, mut steps) = (0.0, 0.0);
    for i in 0..poses.len() {
        let (left, right) = stereo(&poses[i], 2, 6);
        let Some(motion) = odometry.push(&left, &right) else { continue };
        let motion = motion.unwrap();
        let true_step = poses[i - 1].inverse().compose(&poses[i]);
        let error = motion.previous_from_current.inverse().compose(&true_step).translation_m;
        normalised += (0..3).map(|k| error[k] * error[k] / motion.covariance[k + 3][k + 3]).sum::<f64>() / 3.0;
        steps += 1.0;
    }
    // The mean would be 1 if the errors of matches were independent and the model complete.
    assert!((0.05..20.0).contains(&(normalised / steps)), "normalised error {}", normalised / steps);
}

#[test]
fn blank_tiny_and_unrelated_images_fail_with_a_reason() {
    let blank = GreyImage::new(640, 360, vec![90; 640 * 360]).unwrap();
    let tiny = GreyImage::new(3, 2, vec![9; 6]).unwrap();
    let mut odometry = Odometry::new(RIG, OdometryParams::default());
    assert!(odometry.push(&blank, &blank).is_none());
    let failed = odometry.push(&blank, &blank).unwrap();
    assert!(matches!(failed, Err(MotionFailure::TooFewMatches { matches: 0, .. })), "{failed:?}");
    assert!(odometry.push(&tiny, &tiny).unwrap().is_err());
    for seed in 1..6 {
        let (left, right) = stereo(&pose(0.0, 0.0, 0.0), seed, 2);
        let motion = odometry.push(&left, &right).unwrap();
        assert!(motion.is_err(), "world {seed} after another: {motion:?}");
    }
}

#[test]
fn batches_do_not_change_the_chain() {
    let odometry = Odometry::new(RIG, OdometryParams::default());
    let prepare = |world_from_left: &Se3| {
        let (left, right) = stereo(world_from_left, 1, 3);
        odometry.prepare(&left, &right)
    };
    // Two metres: short stretches and long ones.
    let frames: Vec<StereoFrame> = path(21).par_iter().map(prepare).collect();
    let whole = chained(frames.clone(), frames.len());
    assert_eq!(whole.steps.len(), 20);
    for batch in [1, 4, 7] {
        assert_eq!(chained(frames.clone(), batch), whole, "in batches of {batch}");
    }
}

#[test]
fn a_failed_step_repeats_the_velocity_before_and_is_flagged() {
    let blank = GreyImage::new(640, 360, vec![90; 640 * 360]).unwrap();
    let odometry = Odometry::new(RIG, OdometryParams::default());
    let mut chain = ChainBuilder::new(RIG, OdometryParams::default());
    for i in 0..4 {
        let (left, right) = stereo(&pose(0.0, 0.1 * i as f64, 0.0), 1, 0);
        chain.extend(vec![(i * TENTH_NS, odometry.prepare(&left, &right))]);
    }
    // A frame is missing before the one that fails: at 1 m/s the step is 0.2 m long.
    chain.extend(vec![(5 * TENTH_NS, odometry.prepare(&blank, &blank))]);
    let steps = chain.finish().steps;
    assert_eq!(steps.iter().map(|step| step.valid).collect::<Vec<_>>(), [true, true, true, false]);
    let step = &steps[3];
    assert_eq!((step.from_ns, step.to_ns, step.inliers), (3 * TENTH_NS, 5 * TENTH_NS, 0));
    let off = step.earlier_from_later.inverse().compose(&pose(0.0, 0.2, 0.0));
    assert!(off.distance_m() < 0.005 && off.angle_rad() < 0.002, "{:?}", step.earlier_from_later);
}

#[test]
fn in_noise_a_step_is_found_near_the_predicted_motion() {
    let odometry = Odometry::new(RIG, OdometryParams::default());
    let poses = path(7);
    // From the fifth frame on, noise hides all but the coarsest texture.
    let prepare = |(i, pose): (usize, &Se3)| {
        let (left, right) = stereo(pose, 1, if i < 4 { 3 } else { 110 });
        odometry.prepare(&left, &right)
    };
    let frames: Vec<StereoFrame> = poses.par_iter().enumerate().map(prepare).collect();
    let mut alone = odometry;
    let lost = frames.iter().filter(|frame| matches!(alone.push_frame((*frame).clone()), Some(Err(_)))).count();
    assert!(lost > 0, "no step fails without a prediction: the test shows nothing");
    for (i, step) in chained(frames, 7).steps.iter().enumerate() {
        let error = poses[i + 1].inverse().compose(&poses[i]).compose(&step.earlier_from_later);
        // Closer to the truth than to a motion of zero.
        assert!(
            step.valid && error.distance_m() < 0.05 && error.angle_rad() < 0.01,
            "step {i}: {step:?}, off by {error:?}"
        );
    }
}

#[test]
fn a_frame_of_another_world_is_not_matched() {
    let odometry = Odometry::new(RIG, OdometryParams::default());
    let frame = |(i, seed): (usize, u64)| {
        let (left, right) = stereo(&pose(0.0, 0.1 * i as f64, 0.0), seed, 2);
        odometry.prepare(&left, &right)
    };
    // Three frames of each world.
    let worlds = [1, 1, 1, 2, 2, 2, 3, 3, 3, 4, 4, 4, 5, 5, 5, 6, 6, 6];
    let frames: Vec<StereoFrame> = worlds.into_iter().enumerate().map(frame).collect();
    let steps = chained(frames, 18).steps;
    for (i, step) in steps.iter().enumerate() {
        assert_eq!(step.valid, worlds[i] == worlds[i + 1], "step {i}: {step:?}");
    }
}

#[test]
fn verification_finds_the_offset_of_the_same_place_and_little_in_another() {
    let params = VerifyParams::default();
    let extract = |image: &GreyImage| FrameFeatures::extract(image, &params.matcher);
    let world_from_candidate = pose(0.1, 4.0, 0.02);
    let pair_of = |world_from_left: &Se3, seed: u64| {
        let (left, right) = stereo(world_from_left, seed, 4);
        StereoFrame::new(extract(&left), extract(&right), &RIG, &params.stereo)
    };
    let candidate = extract(&stereo(&world_from_candidate, 1, 4).0);
    let candidate_pair = pair_of(&world_from_candidate, 1);
    for (right_m, forward_m, yaw_rad) in [(0.0, 4.0, 0.0), (0.3, 3.4, -0.1), (-0.2, 4.8, 0.15)] {
        let world_from_live = pose(right_m, forward_m, yaw_rad);
        let (left, right) = stereo(&world_from_live, 1, 4);
        let found = verify_three_view(&extract(&left), &extract(&right), &candidate, &RIG, &params);
        let four_view = verify_four_view(&pair_of(&world_from_live, 1), &candidate_pair, &RIG, &params);
        let truth = world_from_candidate.inverse().compose(&world_from_live);
        for found in [found, four_view] {
            let error = found.candidate_from_live.map(|pose| truth.inverse().compose(&pose));
            assert!(error.is_some_and(|e| e.distance_m() < 0.05 && e.angle_rad() < 0.01), "{error:?}");
            assert!(found.std_m.is_some_and(|std_m| (1e-6..0.05).contains(&std_m)), "{:?}", found.std_m);
            assert!(found.inliers > 40 && found.inliers == found.correspondences.len(), "{}", found.inliers);
            assert!(found.inliers <= found.matches && found.matches <= found.stereo_matches);
        }
    }
    for seed in 2..8 {
        let (left, right) = stereo(&world_from_candidate, seed, 4);
        let found = verify_three_view(&extract(&left), &extract(&right), &candidate, &RIG, &params);
        let four_view = verify_four_view(&pair_of(&world_from_candidate, seed), &candidate_pair, &RIG, &params);
        assert!(found.inliers.max(four_view.inliers) <= 12, "world {seed}: {found:?} {four_view:?}");
    }
}
