//! Other people's datasets through the command, on real frames: the drive is as long as it was. And images that leave
//! as a set for place recognition come back with their positions.

mod places;

use crate::support::command::{furrow, quoted};
use crate::support::golden_data::data;
use crate::support::store::Store;
use serde_json::Value;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// How far a length may be from the truth.
const WITHIN: f64 = 0.02;

/// Real frames in the layouts of datasets, and what is right of each; `None`, and a word why, where something lacks.
fn datasets() -> Option<(TempDir, Value)> {
    let data = data()?;
    let sources = ["kitti_odo_seqA", "kitti_raw_drive_A", "stromovka_2season_traverse"];
    if let Some(lacking) = sources.iter().find(|source| !data.join(source).is_dir()) {
        eprintln!("SKIPPED: no {lacking} in {}", data.display());
        return None;
    }
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new("python3");
    match command.args(["-c", include_str!("real.py")]).arg(data).arg(folder.path()).output() {
        Err(error) => {
            eprintln!("SKIPPED: datasets of others are not laid out: python3: {error}");
            None
        }
        Ok(output) => {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            Some((folder, serde_json::from_slice(&output.stdout).unwrap()))
        }
    }
}

fn import(store: &Store, profile: &str, folder: &Path, right: &Value, more: &str) -> Value {
    let path = quoted(folder.join(right["path"].as_str().unwrap()));
    let place = "--site elsewhere --route loop --slot 10:00 --purpose experience";
    store.json(format!("import {profile} {path} {place} {more}"))
}

#[test]
fn real_drives_are_as_long_as_they_were() {
    let Some((folder, right)) = datasets() else { return };
    for (profile, options) in [("kitti-odometry", ""), ("kitti-raw", ""), ("mono", "--spacing-m 5"), ("vpr", "")] {
        let store = Store::new();
        let summary = import(&store, profile, folder.path(), &right[profile], options);
        let (length, expected) =
            (summary["trajectory"]["length_m"].as_f64().unwrap(), right[profile]["length"].as_f64().unwrap());
        assert_eq!(summary["pairs"], right[profile]["pairs"], "{profile}: {summary}");
        assert_eq!(summary["trajectory"]["failed_steps"], 0, "{profile}");
        assert!((length - expected).abs() < WITHIN * expected, "{profile}: {length} m, not {expected} m");
        let again = import(&store, profile, folder.path(), &right[profile], options);
        assert!(again["known"] == true && again["traversal"] == summary["traversal"], "{profile}: {again}");
        if profile == "kitti-raw" {
            let track = driven_by_names(&store, &summary, folder.path());
            assert!((track - expected).abs() < WITHIN * expected, "true poses: {track} m, not {expected} m");
        }
    }
}

/// The length of the way between the positions in the names of the images that leave, in order of time.
fn driven_by_names(store: &Store, summary: &Value, folder: &Path) -> f64 {
    let out = folder.join("by-names");
    store.json(format!("export images {} -o {}", summary["experience"].as_str().unwrap(), quoted(&out)));
    let list = std::fs::read_to_string(out.join("images.txt")).unwrap();
    let mut places: Vec<(String, [f64; 2])> = list
        .lines()
        .map(|line| line.split('@').collect::<Vec<_>>())
        .map(|fields| (fields[14].to_owned(), [fields[1].parse().unwrap(), fields[2].parse().unwrap()]))
        .collect();
    places.sort_by(|a, b| a.0.cmp(&b.0));
    places.windows(2).map(|pair| (pair[1].1[0] - pair[0].1[0]).hypot(pair[1].1[1] - pair[0].1[1])).sum()
}

#[test]
fn profiles_are_listed_shown_and_asked_for() {
    let listed = furrow("import --list").text();
    for name in ["euroc ", "kitti-raw ", "robotcar ", "citrusfarm ", "vpr "] {
        assert!(listed.lines().any(|line| line.starts_with(name)), "{listed}");
    }
    let entries = furrow("import --list").json();
    assert_eq!(entries.as_array().unwrap().len(), listed.lines().count());
    let folder = tempfile::tempdir().unwrap();
    let mine = folder.path().join("mine.toml");
    std::fs::write(&mine, furrow("import --show euroc").text()).unwrap();
    let store = Store::new();
    let labels = "--site s --route r --slot 10:00 --purpose experience";
    store.furrow(format!("import {} {} {labels}", quoted(&mine), quoted(folder.path()))).fails(1, &["cam0/data/*.png"]);
    store.furrow(format!("import eurok {} {labels}", quoted(folder.path()))).fails(1, &["did you mean euroc?"]);
    store.furrow("import euroc").fails(2, &["--site"]);
}
