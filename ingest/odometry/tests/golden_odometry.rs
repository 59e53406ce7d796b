//! Odometry on every real sequence with known poses in the data folder: folders with `calib.txt` (two 3x4 projections),
//! `poses.txt` (a 3x4 pose per line) and two folders of images.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../../../tests/support/golden_data.rs"]
mod golden_data;
#[path = "sequence/files.rs"]
mod sequence;

use furrow_model::Se3;
use furrow_odometry::{Odometry, OdometryParams};
use sequence::{Sequence, decode, rows_of_12};
use std::path::PathBuf;

#[test]
fn golden_odometry_ends_near_the_true_pose() {
    let Some(data) = golden_data::data() else { return };
    let mut tried = 0;
    for calibration in golden_data::files_below(&data).iter().filter(|file| file.ends_with("calib.txt")) {
        let Some(sequence) = Sequence::open(calibration) else { continue };
        let (error_m, failed) = end_error(&sequence);
        let length_m: f64 = sequence.steps().map(|step| step.distance_m()).sum();
        let percent = 100.0 * error_m / length_m;
        eprintln!("{}: end error {error_m:.3} m, {percent:.2} % of {length_m:.1} m", calibration.display());
        assert_eq!(failed, 0, "failed steps");
        assert!(percent <= 1.5, "end error {percent} %");
        for (file, peer_m) in peer_end_errors(sequence.poses.len(), length_m) {
            assert!(error_m <= 1.1 * peer_m, "{error_m} m, but {file:?} has a median of {peer_m} m");
        }
        tried += 1;
    }
    if tried == 0 {
        eprintln!("SKIPPED: no folder of {} holds calib.txt, poses.txt and two image folders", data.display());
    }
}

/// Distance between the last estimated position and the true one, both from the first frame, and the number of failed
/// steps.
fn end_error(sequence: &Sequence) -> (f64, usize) {
    let mut odometry = Odometry::new(sequence.rig, OdometryParams::default());
    let (mut first_from_here, mut failed) = (Se3::IDENTITY, 0);
    for (left, right) in &sequence.pairs {
        match odometry.push(&decode(left), &decode(right)) {
            None => {}
            Some(Ok(motion)) => first_from_here = first_from_here.compose(&motion.previous_from_current),
            Some(Err(failure)) => {
                eprintln!("{}: {failure}", left.display());
                failed += 1;
            }
        }
    }
    let truth = sequence.poses[0].inverse().compose(&sequence.poses[sequence.poses.len() - 1]);
    (truth.inverse().compose(&first_from_here).distance_m(), failed)
}

/// Median end error over seeds, from every table of the peer's default settings for a sequence of as many frames and
/// the same length.
fn peer_end_errors(frames: usize, length_m: f64) -> Vec<(PathBuf, f64)> {
    let Some(golden) = golden_data::golden() else { return Vec::new() };
    let mut found = Vec::new();
    for file in golden_data::files_below(&golden) {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let Some(prefix) = name.strip_suffix("_default_errors.csv") else { continue };
        let poses = rows_of_12(&file.with_file_name(format!("{prefix}_default_poses.txt")));
        let text = std::fs::read_to_string(&file).unwrap();
        let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let header = lines.next().unwrap();
        let column = |name: &str| header.iter().position(|field| *field == name);
        let (Some(length), Some(error)) = (column("path_length_m"), column("end_error_m")) else { continue };
        let rows: Vec<[f64; 2]> = lines.map(|row| [length, error].map(|i| row[i].parse().unwrap())).collect();
        let mut errors: Vec<f64> =
            rows.iter().filter(|row| (row[0] - length_m).abs() < 0.01).map(|row| row[1]).collect();
        errors.sort_by(f64::total_cmp);
        if poses.len() == frames && !errors.is_empty() {
            let median = (errors[(errors.len() - 1) / 2] + errors[errors.len() / 2]) / 2.0;
            found.push((file, median));
        }
    }
    found
}
