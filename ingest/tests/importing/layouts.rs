//! Every layout: exact counts and stamps, calibration, true poses, sensors.

use crate::trees::{Trees, import, store};
use furrow_catalog::images::decode_colour;
use furrow_catalog::records::TraversalRecord;
use furrow_catalog::{Catalog, tables};
use furrow_ingest::import::builtin::BUILTIN;
use furrow_ingest::traversal::MotionSource;
use furrow_model::TruePoses;
use serde_json::Value;
use std::collections::BTreeSet;

#[test]
fn every_layout_is_read_as_its_documentation_has_it() {
    let Some(trees) = Trees::written() else { return };
    let layouts = trees.right.as_object().unwrap();
    let profiles: BTreeSet<&str> =
        layouts.iter().map(|(name, right)| right["profile"].as_str().unwrap_or(name)).collect();
    assert_eq!(profiles, BUILTIN.iter().map(|builtin| builtin.name).collect(), "a tree for every profile");
    for (name, right) in layouts {
        let profile = right["profile"].as_str().unwrap_or(name);
        let (_folder, catalog) = store();
        let path = trees.path(right["path"].as_str().unwrap());
        let calibration: Vec<_> =
            numbers_or_texts(&right["calibration"]).iter().map(|file| trees.path(file.as_str().unwrap())).collect();
        // Where odometry would be run, the pictures are no place to run it on: the chain is given.
        let motion = match (right["spacing"].as_f64(), right["single"].as_bool()) {
            (Some(metres), _) => MotionSource::Spacing(metres),
            (None, Some(true)) => MotionSource::Odometry,
            _ => MotionSource::Spacing(1.0),
        };
        let enter = || import(&catalog, profile, &path, motion.clone(), calibration.clone());
        let summary = enter().unwrap_or_else(|error| panic!("{name}: {error}"));
        let record = catalog.traversal(summary.traversal).unwrap();
        check(name, right, &catalog, &record);
        let again = enter().unwrap();
        assert!(again.known && again.traversal == summary.traversal && again.differs.is_empty(), "{name}: {again:?}");
    }
}

fn check(name: &str, right: &Value, catalog: &Catalog, record: &TraversalRecord) {
    let frames = tables::frames_from_parquet(catalog.objects().read(record.frames).unwrap()).unwrap();
    let stamps: Vec<Value> = frames.iter().map(|frame| frame.stamp_ns.into()).collect();
    assert_eq!(&stamps, right["stamps"].as_array().unwrap(), "{name}: stamps");
    assert_eq!(u64::from(record.counts.pairs), right["pairs"], "{name}: pairs");
    assert_eq!(record.right_source.is_none(), right["single"] == true, "{name}: cameras");
    let rig = record.rig;
    let told =
        [("fx", rig.focal_px), ("cx", rig.cu_px), ("baseline", rig.baseline_m), ("length", record.counts.length_m)];
    for (what, found) in told {
        if let Some(expected) = right[what].as_f64() {
            // Truth between two poses of four digits is exact to a tenth of a millimetre.
            assert!(
                (found - expected).abs() < 2e-4 * expected.abs().max(1.0),
                "{name}: {what} {found}, not {expected}"
            );
        }
    }
    if let Some(size) = right["size"].as_array() {
        assert_eq!(&vec![Value::from(rig.width), Value::from(rig.height)], size, "{name}: rectified size");
    }
    check_truth(name, right, catalog, record);
    for (what, kind) in [("imu", "imu"), ("fixes", "nav_sat_fix"), ("odometry", "odometry")] {
        let rows: u64 = record.sensors.iter().filter(|table| table.kind == kind).map(|table| table.rows).sum();
        assert_eq!(rows, right[what].as_u64().unwrap_or_default(), "{name}: {what}");
    }
}

fn check_truth(name: &str, right: &Value, catalog: &Catalog, record: &TraversalRecord) {
    let (Some(file), Some(forward)) = (record.ground_truth, right["forward"].as_array()) else {
        assert!(right["forward"].is_null() && record.ground_truth.is_none(), "{name}: true poses");
        return;
    };
    let truth = TruePoses::parse(&catalog.objects().read(file).unwrap()).unwrap();
    for pose in &truth.world_from_left {
        for (row, expected) in pose.rotation.iter().zip(forward) {
            // Euler angles of the drive are not zero.
            assert!((row[2] - expected.as_f64().unwrap()).abs() < 0.03, "{name}: looks along {:?}", pose.rotation);
        }
    }
    for (pose, expected) in truth.world_from_left.iter().zip(numbers_or_texts(&right["truth"])) {
        for (found, expected) in pose.translation_m.iter().zip(expected.as_array().unwrap()) {
            assert!((found - expected.as_f64().unwrap()).abs() < 1e-6, "{name}: {pose:?}, not {expected}");
        }
    }
    if let Some(step) = right["step"].as_f64() {
        let first = &truth.world_from_left[0].translation_m;
        // Zone 32's middle meridian is 9 degrees east; this drive is half a degree west of it.
        assert!((first[0] - 463_400.0).abs() < 100.0 && (first[1] - 5_427_500.0).abs() < 1_500.0, "{name}: {first:?}");
        assert!((first[2] - right["up"].as_f64().unwrap()).abs() < 0.1, "{name}: {first:?}");
        for pair in truth.world_from_left.windows(2) {
            let moved = pair[0].inverse().compose(&pair[1]).distance_m();
            assert!((moved - step).abs() < 2e-3, "{name}: {moved} m a step, not {step}");
        }
    }
}

fn numbers_or_texts(list: &Value) -> &[Value] {
    list.as_array().map_or(&[], Vec::as_slice)
}

#[test]
fn a_mosaic_is_resolved_and_undistorted_by_its_table() {
    let Some(trees) = Trees::written() else { return };
    let (_folder, catalog) = store();
    let summary =
        import(&catalog, "robotcar", &trees.path("robotcar"), MotionSource::Spacing(1.0), Vec::new()).unwrap();
    let record = catalog.traversal(summary.traversal).unwrap();
    let frames = tables::frames_from_parquet(catalog.objects().read(record.frames).unwrap()).unwrap();
    let image = decode_colour(&catalog.objects().read(frames[0].left).unwrap(), None).unwrap();
    // Red is three times the column, and each pixel shows what the camera saw three columns on.
    for x in 2..image.width - 5 {
        let at = 3 * (10 * image.width + x);
        assert_eq!(image.rgb[at..at + 3], [3 * (x as u8 + 3), 100, 50], "column {x}");
    }
    let last = 3 * (10 * image.width + image.width - 1);
    assert_eq!(image.rgb[last..last + 3], [0, 0, 0], "what the camera did not see");
}

#[test]
fn what_was_unusual_is_noted() {
    let Some(trees) = Trees::written() else { return };
    let (_folder, catalog) = store();
    let summary = import(&catalog, "euroc", &trees.path("euroc"), MotionSource::Spacing(1.0), Vec::new()).unwrap();
    let notes = summary.notes.join("\n");
    for words in ["that are not there: 1, the first 1700000000500000000.png", "left out: 1 of 6"] {
        assert!(notes.contains(words), "{notes}");
    }
}

#[test]
fn the_same_folder_understood_otherwise_is_another_recording() {
    let Some(trees) = Trees::written() else { return };
    let (folder, catalog) = store();
    let text = BUILTIN.iter().find(|builtin| builtin.name == "mono").unwrap().text;
    let slower = folder.path().join("slower.toml");
    std::fs::write(&slower, text.replace("hertz = 10.0", "hertz = 2.0")).unwrap();
    let renamed = folder.path().join("same.toml");
    std::fs::write(&renamed, format!("# mine\n{text}")).unwrap();
    let enter = |profile: &str| import(&catalog, profile, &trees.path("mono"), MotionSource::Spacing(2.0), Vec::new());
    let first = enter("mono").unwrap();
    assert!(enter(renamed.to_str().unwrap()).unwrap().known, "a comment changes nothing");
    let other = enter(slower.to_str().unwrap()).unwrap();
    assert!(!other.known && other.traversal != first.traversal);
}
