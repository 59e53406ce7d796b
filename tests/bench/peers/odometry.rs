//! `make bench`: how true odometry's tracks are beside libviso2's recorded ones, on two real streets.

use crate::command::{furrow, quoted};
use crate::golden_data::golden;
use crate::row::{Row, row};
use furrow_catalog::images::{Rectifier, decode_grey};
use furrow_ingest::folder::StereoFolder;
use furrow_ingest::odometry::compare::{Alignment, Spread, Track, align, associate, position_errors};
use furrow_ingest::odometry::{ChainBuilder, MatcherParams, MatchingScale, Odometry, OdometryParams};
use furrow_model::Se3;
use rayon::prelude::*;
use std::path::Path;

/// Rows of both recordings; what is absent is said and left out.
pub fn tracks(data: &Path, rows: &mut Vec<Row>) {
    let Some(golden) = golden() else { return };
    let peers = golden.join("libviso2");
    let scales = [
        ("odometry, seqA, end error at our default", MatchingScale::Auto, "seqA_default_errors.csv"),
        ("odometry, seqA, end error at full resolution", MatchingScale::Full, "seqA_full_errors.csv"),
    ];
    for (name, scale, peer) in scales {
        let peer = median_of_column(&peers.join(peer), "end_error_m");
        match end_error_m(&data.join("kitti_odo_seqA"), scale) {
            Some(error_m) => rows.push(row(name, error_m, "m", "libviso2, median of seeds", peer)),
            None => eprintln!("SKIPPED: no kitti_odo_seqA with poses in {}", data.display()),
        }
    }
    let peer = median_of_column(&peers.join("driveA_ate.csv"), "ate_rmse_m");
    match drive_ate_m(&data.join("kitti_raw_drive_A.bag"), &peers.join("driveA_trajectory.csv")) {
        Some(error_m) => {
            rows.push(row("odometry, drive A, ATE against its GPS", error_m, "m", "libviso2, median of seeds", peer));
        }
        None => eprintln!("SKIPPED: no kitti_raw_drive_A.bag in {} or no track of the peer's", data.display()),
    }
}

/// The rows of a file of numbers with a header, as columns by name.
fn column(file: &Path, name: &str) -> Option<Vec<f64>> {
    let text = std::fs::read_to_string(file).ok()?;
    let mut lines = text.lines();
    let place = lines.next()?.split(',').position(|column| column == name)?;
    lines.map(|line| line.split(',').nth(place)?.parse().ok()).collect()
}

fn median_of_column(file: &Path, name: &str) -> Option<f64> {
    let mut values = column(file, name)?;
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// How far the end of a sequence's track is from the truth, the first poses laid over each other.
fn end_error_m(folder: &Path, scale: MatchingScale) -> Option<f64> {
    let truth = Track::parse(&std::fs::read_to_string(folder.join("poses.txt")).ok()?).ok()?;
    let folder = StereoFolder::open(folder, &[]).ok()?;
    let rig = Rectifier::from_record(&folder.calibration).ok()?.rig();
    let matcher = MatcherParams { scale, ..MatcherParams::default() };
    let params = OdometryParams { matcher, ..OdometryParams::default() };
    let odometry = Odometry::new(rig, params.clone());
    let grey = |path: &Path| decode_grey(&std::fs::read(path).ok()?, None).ok();
    let frames: Vec<_> = folder
        .pairs
        .par_iter()
        .map(|pair| Some(odometry.prepare(&grey(&pair.left)?, &grey(&pair.right)?)))
        .collect::<Option<_>>()?;
    let mut chain = ChainBuilder::new(rig, params);
    chain.extend((0..).zip(frames).collect());
    let track = Track::of_chain(&chain.finish());
    let (aligned, _) = align(&truth.poses, &track.poses, Alignment::First)?;
    position_errors(&truth.poses, &aligned).translation_m.last().copied()
}

/// Root mean square distance of the recording's ingested track from its GPS track in the plane, after the best rigid
/// motion: the frames, the clock and the GPS positions are those of the peer's table.
fn drive_ate_m(bag: &Path, peer: &Path) -> Option<f64> {
    let track = Track::parse(&ingested_track(bag)?).ok()?;
    let stamps_s = track.stamps_s.as_ref()?;
    let since_start: Vec<f64> = stamps_s.iter().map(|stamp_s| stamp_s - stamps_s[0]).collect();
    let [times_s, used, east, north] =
        ["time_s", "used_in_ate", "gps_east_m", "gps_north_m"].map(|name| column(peer, name));
    let (times_s, used, east, north) = (times_s?, used?, east?, north?);
    let on_the_ground = |x: f64, y: f64| Se3 { translation_m: [x, y, 0.0], ..Se3::IDENTITY };
    let (gps, ours): (Vec<Se3>, Vec<Se3>) = associate(&times_s, &since_start, MOST_APART_S)
        .into_iter()
        .filter(|&(row, _)| used[row] == 1.0)
        .map(|(row, place)| {
            let [x, _, z] = track.poses[place].translation_m;
            (on_the_ground(east[row], north[row]), on_the_ground(x, z))
        })
        .unzip();
    let (aligned, _) = align(&gps, &ours, Alignment::Rigid)?;
    Spread::of(&position_errors(&gps, &aligned).translation_m).map(|errors| errors.rmse)
}

/// Frames of the recording come every 0.1 s.
const MOST_APART_S: f64 = 0.03;

/// The track of a bag as `furrow ingest` and `furrow export trajectory` give it.
fn ingested_track(bag: &Path) -> Option<String> {
    if !bag.is_file() {
        return None;
    }
    let folder = tempfile::tempdir().ok()?;
    let [bag, store, file] = [bag.to_owned(), folder.path().join("store"), folder.path().join("track.tum")].map(quoted);
    furrow(format!("init {store}")).text();
    let place = "--site bench --route street --slot 14:00 --purpose evaluation";
    let summary = furrow(format!("--store {store} ingest {bag} {place}")).json();
    let traversal = summary["traversal"].as_str()?;
    furrow(format!("--store {store} export trajectory {traversal} --format tum -o {file}")).text();
    std::fs::read_to_string(file).ok()
}
