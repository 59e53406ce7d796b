//! A real recording is ingested with its faults named and a true trajectory, and takes its calibration from a file
//! where it has none.

use super::track::{aligned_rmse, gps_at, nanoseconds};
use super::{ingest, street};
use crate::support::command::quoted;
use crate::support::golden_data::data;
use crate::support::store::Store;
use std::path::Path;

/// The frames of `timestamps.csv` whose partner is missing: (stamp, the side that is there).
fn lonely_frames(folder: &Path) -> Vec<(i64, String)> {
    let csv = std::fs::read_to_string(folder.join("timestamps.csv")).unwrap();
    let lonely = csv.lines().skip(1).filter_map(|line| {
        let fields: Vec<&str> = line.split(',').collect();
        match (fields[3], fields[4]) {
            ("1", "0") => Some((nanoseconds(fields[1]), "left".to_owned())),
            ("0", "1") => Some((nanoseconds(fields[2]), "right".to_owned())),
            _ => None,
        }
    });
    lonely.collect()
}

#[test]
fn a_real_recording_is_ingested_with_its_faults_named_and_a_true_trajectory() {
    let Some((bag, folder)) = street() else { return };
    let store = Store::new();
    let summary = ingest(&store, &bag, "street", "experience", "all");
    assert_eq!(summary["pairs"], 198);
    let mut named: Vec<(i64, String)> = summary["unpaired"]
        .as_array()
        .unwrap()
        .iter()
        .map(|frame| (frame["stamp_ns"].as_i64().unwrap(), frame["side"].as_str().unwrap().to_owned()))
        .collect();
    named.sort();
    let mut expected: Vec<(i64, String)> =
        lonely_frames(&folder).into_iter().filter(|frame| frame.0 <= named[1].0 + 1_000_000_000).collect();
    expected.sort();
    assert_eq!(named, expected, "the frames without a partner");
    assert_eq!(summary["trajectory"]["frames"], 198);
    let length_m = summary["trajectory"]["length_m"].as_f64().unwrap();
    assert!((length_m - 165.0).abs() < 5.0, "{length_m} m of 165 m");

    let tum = store.file("drive.tum");
    store.json(format!("export trajectory {} --format tum -o {tum}", summary["traversal"].as_str().unwrap()));
    let track: Vec<(f64, f64, f64)> = std::fs::read_to_string(folder.join("gps_track.csv"))
        .unwrap()
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|v| v.parse::<f64>().unwrap()).collect::<Vec<_>>())
        .map(|v| (v[1], v[2], v[3]))
        .collect();
    let mut start = None;
    let (mut found, mut gps) = (Vec::new(), Vec::new());
    for line in std::fs::read_to_string(&tum).unwrap().lines() {
        let (stamp, rest) = line.split_once(' ').unwrap();
        let v: Vec<f64> = rest.split(' ').map(|v| v.parse().unwrap()).collect();
        let stamp_s = stamp.parse::<f64>().unwrap();
        let start_s = *start.get_or_insert(stamp_s);
        if let Some(fix) = gps_at(&track, stamp_s - start_s) {
            // Camera x is to the right and z forward: seen from above, x east and z north.
            found.push((v[0], v[2]));
            gps.push(fix);
        }
    }
    assert!(found.len() >= 190, "{} frames inside the GPS track", found.len());
    let rmse_m = aligned_rmse(&found, &gps);
    eprintln!("drive A: ATE rmse {rmse_m:.3} m over {length_m:.1} m");
    assert!(rmse_m <= 0.8, "ATE rmse {rmse_m} m");

    let again = ingest(&store, &bag, "street", "experience", "all");
    assert_eq!(again["traversal"], summary["traversal"]);
    assert_eq!(again["known"], true);
}

#[test]
fn a_raw_recording_without_camera_info_takes_a_calibration_file() {
    let Some((_, folder)) = street() else { return };
    let Some(half) =
        data().map(|data| data.join("derived_stereo_containers/stereo_rawimage_half_bz2.bag")).filter(|f| f.is_file())
    else {
        eprintln!("SKIPPED: no half-size recording");
        return;
    };
    let store = Store::new();
    let ingest = format!("ingest {} --site karlsruhe --route street --slot 14:00 --purpose experience", quoted(half));
    store.fails(&ingest, 1, &["--calibration"]);
    let calibration = quoted(folder.join("calib_cam_to_cam.txt"));
    let summary = store.json(format!("{ingest} --calibration {calibration}"));
    assert_eq!((summary["pairs"].as_i64(), summary["trajectory"]["failed_steps"].as_i64()), (Some(5), Some(0)));
}
