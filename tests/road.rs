//! The whole road on real recordings. Folders come from FURROW_DATA; what is absent is skipped and said so.

use crate::command::{json, run, store, text};
use crate::golden_data::{data, files_below};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The real drive: a bag with a stereo pair of compressed images and a GPS track of known accuracy, and its loose files beside it.
fn drive() -> Option<(PathBuf, PathBuf)> {
    let data = data()?;
    let (bag, folder) = (data.join("kitti_raw_drive_A.bag"), data.join("kitti_raw_drive_A"));
    if bag.is_file() && folder.join("gps_track.csv").is_file() {
        return Some((bag, folder));
    }
    eprintln!("SKIPPED: no kitti_raw_drive_A in {}", data.display());
    None
}

fn ingest(store: &Path, file: &Path, route: &str, purpose: &str, frames: &str) -> Value {
    json(
        store,
        &[
            "ingest",
            text(file),
            "--site",
            "karlsruhe",
            "--route",
            route,
            "--slot",
            "14:00",
            "--pass",
            purpose,
            "--frames",
            frames,
        ],
    )
}

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

/// `2011-09-26 14:05:35.500923136` on the clock that the bag's stamps count on.
fn nanoseconds(text: &str) -> i64 {
    let (date, time) = text.split_once(' ').unwrap();
    let date: Vec<i64> = date.split('-').map(|part| part.parse().unwrap()).collect();
    let (clock, fraction) = time.split_once('.').unwrap();
    let clock: Vec<i64> = clock.split(':').map(|part| part.parse().unwrap()).collect();
    // Days since 1970 by the civil calendar (Fliegel and Van Flandern 1968).
    let (y, m, d) = (date[0], date[1], date[2]);
    let julian = (1461 * (y + 4800 + (m - 14) / 12)) / 4 + (367 * (m - 2 - 12 * ((m - 14) / 12))) / 12
        - (3 * ((y + 4900 + (m - 14) / 12) / 100)) / 4
        + d
        - 32075;
    let seconds = (julian - 2_440_588) * 86_400 + clock[0] * 3600 + clock[1] * 60 + clock[2];
    seconds * 1_000_000_000 + format!("{fraction:0<9}").parse::<i64>().unwrap()
}

/// Root mean square distance after the best rigid motion in the plane (Horn's closed form in two dimensions).
fn aligned_rmse(a: &[(f64, f64)], b: &[(f64, f64)]) -> f64 {
    let n = a.len() as f64;
    let mean = |p: &[(f64, f64)]| (p.iter().map(|v| v.0).sum::<f64>() / n, p.iter().map(|v| v.1).sum::<f64>() / n);
    let (ma, mb) = (mean(a), mean(b));
    let (mut dot, mut cross) = (0.0, 0.0);
    for (p, q) in a.iter().zip(b) {
        let (p, q) = ((p.0 - ma.0, p.1 - ma.1), (q.0 - mb.0, q.1 - mb.1));
        dot += p.0 * q.0 + p.1 * q.1;
        cross += p.0 * q.1 - p.1 * q.0;
    }
    let angle = cross.atan2(dot);
    let error = |(p, q): (&(f64, f64), &(f64, f64))| {
        let (x, y) = (p.0 - ma.0, p.1 - ma.1);
        let moved = (x * angle.cos() - y * angle.sin() + mb.0, x * angle.sin() + y * angle.cos() + mb.1);
        (moved.0 - q.0).powi(2) + (moved.1 - q.1).powi(2)
    };
    (a.iter().zip(b).map(error).sum::<f64>() / n).sqrt()
}

/// East and north of the GPS track at `time_s` after frame 0, linearly interpolated; `None` outside.
fn gps_at(track: &[(f64, f64, f64)], time_s: f64) -> Option<(f64, f64)> {
    let after = track.iter().position(|fix| fix.0 >= time_s)?;
    let (a, b) = (track.get(after.checked_sub(1)?)?, track[after]);
    let share = (time_s - a.0) / (b.0 - a.0);
    Some((a.1 + share * (b.1 - a.1), a.2 + share * (b.2 - a.2)))
}

#[test]
fn a_real_drive_is_ingested_with_its_faults_named_and_a_true_trajectory() {
    let Some((bag, folder)) = drive() else { return };
    let store = store();
    let summary = ingest(store.path(), &bag, "street", "experience", "all");
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

    let tum = store.path().join("drive.tum");
    json(
        store.path(),
        &["export", "trajectory", summary["traversal"].as_str().unwrap(), "--format", "tum", "-o", text(&tum)],
    );
    let track: Vec<(f64, f64, f64)> = std::fs::read_to_string(folder.join("gps_track.csv"))
        .unwrap()
        .lines()
        .skip(1)
        .map(|line| line.split(',').map(|v| v.parse::<f64>().unwrap()).collect::<Vec<_>>())
        .map(|v| (v[1], v[2], v[3]))
        .collect();
    let mut start = None;
    let (mut driven, mut gps) = (Vec::new(), Vec::new());
    for line in std::fs::read_to_string(&tum).unwrap().lines() {
        let (stamp, rest) = line.split_once(' ').unwrap();
        let v: Vec<f64> = rest.split(' ').map(|v| v.parse().unwrap()).collect();
        let stamp_s = stamp.parse::<f64>().unwrap();
        let start_s = *start.get_or_insert(stamp_s);
        if let Some(fix) = gps_at(&track, stamp_s - start_s) {
            // Camera x is to the right and z forward: seen from above, x east and z north.
            driven.push((v[0], v[2]));
            gps.push(fix);
        }
    }
    assert!(driven.len() >= 190, "{} frames inside the GPS track", driven.len());
    let rmse_m = aligned_rmse(&driven, &gps);
    eprintln!("drive A: ATE rmse {rmse_m:.3} m over {length_m:.1} m");
    assert!(rmse_m <= 0.8, "ATE rmse {rmse_m} m");

    let again = ingest(store.path(), &bag, "street", "experience", "all");
    assert_eq!(again["traversal"], summary["traversal"]);
    assert_eq!(again["known"], true);
}

#[test]
fn three_containers_of_one_outing_give_one_experience() {
    let Some(containers) = data().map(|data| data.join("derived_stereo_containers")).filter(|folder| folder.is_dir())
    else {
        eprintln!("SKIPPED: no derived_stereo_containers");
        return;
    };
    let whole =
        |path: &PathBuf| path.is_dir() || path.extension().is_some_and(|e| e == "bag") && !text(path).contains("half");
    let mut found: Vec<PathBuf> =
        std::fs::read_dir(&containers).unwrap().flatten().map(|entry| entry.path()).filter(whole).collect();
    found.sort();
    assert!(found.len() >= 3, "{found:?}");
    let ids: Vec<(Value, Value)> = found
        .iter()
        .map(|path| {
            let store = store();
            let summary = ingest(store.path(), path, "street", "experience", "all");
            (summary["experience"].clone(), summary["trajectory"].clone())
        })
        .collect();
    assert!(ids[0].0.is_string());
    assert!(ids.iter().all(|id| *id == ids[0]), "{ids:?}");
}

#[test]
fn a_raw_recording_without_camera_info_takes_a_calibration_file() {
    let Some((_, folder)) = drive() else { return };
    let Some(half) =
        data().map(|data| data.join("derived_stereo_containers/stereo_rawimage_half_bz2.bag")).filter(|f| f.is_file())
    else {
        eprintln!("SKIPPED: no half-size recording");
        return;
    };
    let store = store();
    let place = ["--site", "karlsruhe", "--route", "street", "--slot", "14:00", "--pass", "experience"];
    let refused = crate::command::furrow()
        .arg("--store")
        .arg(store.path())
        .arg("ingest")
        .arg(&half)
        .args(place)
        .output()
        .unwrap();
    assert_eq!(refused.status.code(), Some(1));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("--calibration"));
    let calibration = folder.join("calib_cam_to_cam.txt");
    let mut args = vec!["ingest", text(&half)];
    args.extend(place);
    args.extend(["--calibration", text(&calibration)]);
    let summary = json(store.path(), &args);
    assert_eq!((summary["pairs"].as_i64(), summary["trajectory"]["failed_steps"].as_i64()), (Some(5), Some(0)));
}

#[test]
fn odd_frames_of_a_drive_are_found_among_its_even_ones() {
    let Some((bag, _)) = drive() else { return };
    let Some(sequence) = data().map(|data| data.join("kitti_odo_seqA")).filter(|folder| folder.is_dir()) else {
        eprintln!("SKIPPED: no kitti_odo_seqA");
        return;
    };
    let store = store();
    ingest(store.path(), &bag, "street", "experience", "even");
    ingest(store.path(), &bag, "street", "evaluation", "odd");
    ingest(store.path(), &sequence, "vocabulary", "vocabulary", "all");
    let matrix = store.path().join("matrix.toml");
    let written = "name = \"odd against even\"\nsite = \"karlsruhe\"\ncodebook = { words = 6000, route = \"vocabulary\" }\n\
        [axes]\nlive = [\"14:00\"]\nexperience = [\"14:00\"]\n";
    std::fs::write(&matrix, written).unwrap();
    let result = json(store.path(), &["run", text(&matrix)]);
    let cell = &result["cells"][0];
    eprintln!("odd against even: {cell}");
    let (frames, correct) = (cell["frames"].as_f64().unwrap(), cell["correct"].as_f64().unwrap());
    assert_eq!(frames, 99.0);
    assert!(correct / frames >= 0.95, "{correct} of {frames} frames accepted and correct");
    assert!(cell["max_error_m"].as_f64().unwrap() <= 5.0, "accepted wrong by more than 5 m: {cell}");
    let page = store.path().join("report.html");
    json(store.path(), &["report", result["run"].as_str().unwrap(), "-o", text(&page)]);
    assert!(std::fs::read_to_string(&page).unwrap().contains("odd against even"));
}

#[test]
fn every_fixture_is_ingested_or_refused_with_a_reason() {
    let Some(fixtures) = data().map(|data| data.join("bag_fixtures")).filter(|folder| folder.is_dir()) else {
        eprintln!("SKIPPED: no bag_fixtures");
        return;
    };
    let store = store();
    let recordings = files_below(&fixtures).into_iter().filter(|path| {
        path.extension().is_some_and(|extension| ["bag", "mcap", "db3"].iter().any(|known| extension == *known))
    });
    let mut tried = 0;
    for path in recordings {
        let place = ["--site", "s", "--route", "r", "--slot", "12:00", "--pass", "experience"];
        let output = crate::command::furrow()
            .arg("--store")
            .arg(store.path())
            .arg("ingest")
            .arg(&path)
            .args(place)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        match output.status.code() {
            Some(0) => {}
            Some(1) => {
                assert!(said.contains(path.file_name().unwrap().to_str().unwrap()), "{}: {said}", path.display())
            }
            other => panic!("{}: ended with {other:?}: {said}", path.display()),
        }
        assert!(!said.contains("panicked"), "{}: {said}", path.display());
        tried += 1;
    }
    assert!(tried >= 10, "{tried} fixtures");
    let state = json(store.path(), &["fsck"]);
    assert_eq!(state["faults"], serde_json::json!([]));
    assert!(run(&["--store", text(store.path()), "ls"]).status.success());
}
