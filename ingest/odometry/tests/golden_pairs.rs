//! Single pairs of frames, far apart on a street with known poses, against the peer's successes (`*_pairs.csv`).

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

#[path = "../../../tests/support/golden_data.rs"]
mod golden_data;
#[path = "sequence/files.rs"]
mod sequence;

use furrow_model::Se3;
use furrow_odometry::{Odometry, OdometryParams, StereoFrame, VerifyParams, estimate, verify};
use rayon::prelude::*;
use sequence::{Sequence, decode};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A position at most this far from the truth is right.
const RIGHT_M: f64 = 0.5;
/// A position farther from the truth than this is wrong.
const WRONG_M: f64 = 1.0;

/// Successes of one gap: right ones, wrong ones, all.
#[derive(Debug, Default, Clone, Copy, PartialEq)]
struct Tally {
    right: usize,
    wrong: usize,
    claimed: usize,
}

impl Tally {
    fn add(&mut self, error_m: f64) {
        self.right += usize::from(error_m < RIGHT_M);
        self.wrong += usize::from(error_m > WRONG_M);
        self.claimed += 1;
    }
}

/// The peer's successes by gap, from the columns `gap`, `success` and `position_error_m`.
fn peer(file: &Path) -> BTreeMap<usize, Tally> {
    let text = std::fs::read_to_string(file).unwrap();
    let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = lines.next().unwrap();
    let column = |part: &str| header.iter().position(|name| name.contains(part)).unwrap();
    let (gap, success, error) = (column("gap"), column("success"), column("error"));
    let mut tallies = BTreeMap::<usize, Tally>::new();
    for line in lines {
        let tally = tallies.entry(line[gap].parse().unwrap()).or_default();
        if line[success] == "1" {
            tally.add(line[error].parse().unwrap());
        }
    }
    tallies
}

fn prepared(sequence: &Sequence) -> Vec<StereoFrame> {
    let odometry = Odometry::new(sequence.rig, OdometryParams::default());
    let prepare = |(left, right): &(PathBuf, PathBuf)| odometry.prepare(&decode(left), &decode(right));
    sequence.pairs.par_iter().map(prepare).collect()
}

fn ours(sequence: &Sequence, frames: &[StereoFrame], gap: usize) -> Tally {
    let params = OdometryParams::default();
    let error_m = |i: usize| {
        let motion = estimate(&frames[i], &frames[i + gap], &sequence.rig, &params).ok()?;
        let truth: Se3 = sequence.poses[i].inverse().compose(&sequence.poses[i + gap]);
        let off = |k: usize| motion.previous_from_current.translation_m[k] - truth.translation_m[k];
        Some((0..3).map(|k| off(k) * off(k)).sum::<f64>().sqrt())
    };
    let errors: Vec<Option<f64>> = (0..frames.len() - gap).into_par_iter().map(error_m).collect();
    let mut tally = Tally::default();
    errors.into_iter().flatten().for_each(|error| tally.add(error));
    tally
}

#[test]
fn golden_pairs_succeed_as_often_as_the_peers_and_are_not_wrong() {
    let (Some(data), Some(golden)) = (golden_data::data(), golden_data::golden()) else { return };
    let mut tried = 0;
    for sequence in sequences(&data) {
        let frames = prepared(&sequence);
        for file in
            golden_data::files_below(&golden).iter().filter(|file| file.to_string_lossy().ends_with("_pairs.csv"))
        {
            let mut all = Tally::default();
            for (gap, peer) in peer(file) {
                let ours = ours(&sequence, &frames, gap);
                eprintln!("gap {gap}: {ours:?}, the peer {peer:?}");
                assert!(ours.right >= peer.right, "gap {gap}: {ours:?}, but the peer has {peer:?}");
                all = Tally {
                    right: all.right + ours.right,
                    wrong: all.wrong + ours.wrong,
                    claimed: all.claimed + ours.claimed,
                };
            }
            assert!(100 * all.wrong < all.claimed, "{all:?}");
            tried += 1;
        }
    }
    if tried == 0 {
        eprintln!("SKIPPED: no sequence with poses and a table of pairs");
    }
}

/// The sequences with poses below a folder. Reports if there are none.
fn sequences(data: &Path) -> Vec<Sequence> {
    let files = golden_data::files_below(data);
    let found: Vec<Sequence> =
        files.iter().filter(|file| file.ends_with("calib.txt")).filter_map(|file| Sequence::open(file)).collect();
    if found.is_empty() {
        eprintln!("SKIPPED: no sequence with poses in {}", data.display());
    }
    found
}

/// Inliers of pairs of frames that show the same place (at most 4 m apart by true poses), and of pairs that do not (at
/// least 10 m).
fn right_and_wrong(sequence: &Sequence, frames: &[StereoFrame], params: &VerifyParams) -> [Vec<usize>; 2] {
    let pairs: Vec<(usize, usize)> =
        (0..frames.len()).flat_map(|i| (0..frames.len()).map(move |j| (i, j))).filter(|(i, j)| i != j).collect();
    let count = |&(i, j): &(usize, usize)| {
        let apart_m = sequence.poses[i].inverse().compose(&sequence.poses[j]).distance_m();
        let wanted = apart_m <= 4.0 || apart_m >= 10.0;
        let inliers = || verify(&frames[i], frames[j].left(), &sequence.rig, params).inliers;
        wanted.then(|| (apart_m, inliers()))
    };
    let counts: Vec<(f64, usize)> = pairs.par_iter().filter_map(count).collect();
    let select = |right: bool| counts.iter().filter(|c| (c.0 <= 4.0) == right).map(|c| c.1).collect();
    [select(true), select(false)]
}

#[test]
fn golden_street_confirmed_matches_separate_right_from_wrong_places_better_than_all_matches() {
    let Some(data) = golden_data::data() else { return };
    for sequence in sequences(&data) {
        let frames = prepared(&sequence);
        let confirmed = VerifyParams::default();
        let all = VerifyParams { min_correlation: -1.0, ..confirmed.clone() };
        let [of_confirmed, of_all] = [confirmed, all].map(|params| {
            let [right, mut wrong] = right_and_wrong(&sequence, &frames, &params);
            assert!(wrong.len() >= 1000 && !right.is_empty(), "{} wrong pairs, {} right", wrong.len(), right.len());
            wrong.sort_unstable();
            let limit = wrong[(wrong.len() * 999).div_ceil(1000) - 1];
            let above = right.iter().filter(|&&inliers| inliers > limit).count();
            eprintln!(
                "99.9 % of {} wrong pairs have at most {limit} inliers; {above} of {} right pairs have more",
                wrong.len(),
                right.len()
            );
            (limit, above)
        });
        assert!(of_confirmed.0 < of_all.0 && of_confirmed.1 >= of_all.1, "{of_confirmed:?} {of_all:?}");
    }
}

#[test]
fn golden_street_errors_have_the_size_that_covariances_predict() {
    let Some(data) = golden_data::data() else { return };
    let params = OdometryParams::default();
    for sequence in sequences(&data) {
        let frames = prepared(&sequence);
        for gap in [1, 2, 3] {
            let normalised_error = |i: usize| {
                let motion = estimate(&frames[i], &frames[i + gap], &sequence.rig, &params).ok()?;
                let truth = sequence.poses[i].inverse().compose(&sequence.poses[i + gap]);
                let error = motion.previous_from_current.inverse().compose(&truth).translation_m;
                Some([0, 1, 2].map(|k| error[k].abs() / motion.covariance[k + 3][k + 3].sqrt()))
            };
            let errors: Vec<[f64; 3]> = (0..frames.len() - gap).into_par_iter().filter_map(normalised_error).collect();
            assert!(2 * errors.len() > frames.len(), "gap {gap}: {} pairs of {} frames", errors.len(), frames.len());
            for axis in 0..3 {
                let mut normalised: Vec<f64> = errors.iter().map(|error| error[axis]).collect();
                normalised.sort_by(f64::total_cmp);
                let median = normalised[normalised.len() / 2];
                eprintln!("gap {gap}, axis {axis}: the median error is {median:.2} standard deviations");
                // For normally distributed errors it is 0.67. A factor of three leaves room for the errors of the
                // truth.
                assert!((0.22..2.0).contains(&median), "gap {gap}, axis {axis}: {median} standard deviations");
            }
        }
    }
}
