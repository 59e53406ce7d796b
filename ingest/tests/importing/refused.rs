//! Torn lists, profiles that ask too much, names that are not known: refused with words that help, and nothing is
//! entered.

use crate::trees::{Trees, import, store};
use furrow_ingest::import::builtin::{BUILTIN, parse_profile};
use furrow_ingest::import::find_profile;
use furrow_ingest::traversal::MotionSource;
use std::fs;
use std::path::Path;

#[track_caller]
fn refused(profile: &str, path: &Path, words: &[&str]) {
    let (_folder, catalog) = store();
    let error = import(&catalog, profile, path, MotionSource::Spacing(1.0), Vec::new()).unwrap_err().to_string();
    for word in words {
        assert!(error.contains(word), "expected '{word}' in: {error}");
    }
    assert!(catalog.traversals().unwrap().is_empty() && catalog.recordings().unwrap().is_empty());
}

#[test]
fn torn_files_are_named_with_their_line() {
    let Some(trees) = Trees::written() else { return };
    let damaged = |below: &str, file: &str, damage: &dyn Fn(String) -> String| {
        let copy = trees.copy(below);
        let path = copy.path().join(file);
        fs::write(&path, damage(fs::read_to_string(&path).unwrap())).unwrap();
        copy
    };
    let cut = |bytes: usize| move |text: String| text[..text.len() - bytes].to_owned();
    let list = "mav0/cam0/data.csv";
    // The last line of the list ends within the stamp.
    let copy = damaged("euroc", list, &cut(30));
    refused("euroc", copy.path(), &["data.csv", "line 6", "column 2"]);
    let copy = damaged("euroc", list, &|text| text.replace("1700000000300000000,", "17000000003000000x0,"));
    refused("euroc", copy.path(), &["data.csv", "line 5", "nanoseconds", "17000000003000000x0"]);
    let copy = damaged("euroc", list, &|text| text.replace("1700000000300000000,", "99999999999999999999999999,"));
    refused("euroc", copy.path(), &["line 5", "nanoseconds"]);
    let copy = damaged("euroc", list, &|text| text.replace("1700000000300000000,", "1700000000100000000,"));
    refused("euroc", copy.path(), &["line 5", "after that of the line before"]);
    let copy = damaged("euroc", list, &|text| text.replace(".png", ".bmp"));
    refused("euroc", copy.path(), &["5 of its 5 images are not there", "was the download whole"]);
    let copy =
        damaged("euroc", "mav0/state_groundtruth_estimate0/data.csv", &|text| text.replace(",0.5,-0.5,", ",0.5,-0.x,"));
    refused("euroc", copy.path(), &["state_groundtruth_estimate0", "line 2", "-0.x"]);
    let copy = damaged("kitti/sequences/00", "times.txt", &cut(26));
    refused("kitti-odometry", copy.path(), &["times.txt", "000003.png", "3 stamps", "cut off"]);
    let copy = trees.copy("robotcar");
    let table = copy.path().join("models/stereo_wide_left_distortion_lut.bin");
    fs::write(&table, &fs::read(&table).unwrap()[..1000]).unwrap();
    refused("robotcar", copy.path(), &["distortion_lut.bin", "expected 49152 bytes", "found 1000"]);
    let copy = trees.copy("sync");
    fs::remove_file(copy.path().join("calib_cam_to_cam.txt")).unwrap();
    refused("kitti-raw", &copy.path().join("drive_sync"), &["calib_cam_to_cam.txt", "--calibration"]);
}

#[test]
fn datasets_that_are_not_there_or_others_are_named() {
    let Some(trees) = Trees::written() else { return };
    refused("euroc", &trees.path("kitti"), &["cam0/data/*.png", "mav0/cam0/data/*.png", "--list"]);
    refused("euroc", &trees.path("nothing"), &["nothing", "expected the dataset's folder"]);
    refused("citrusfarm", &trees.path("euroc"), &["zed_*.bag", "mav0"]);
    refused("rover", &trees.path("rover"), &["--calibration FILE"]);
    refused("eurok", &trees.path("euroc"), &["did you mean euroc?", "kitti-raw"]);
    refused("./none.toml", &trees.path("euroc"), &["none.toml"]);
    // A list leads nowhere but to the images of its folder.
    let copy = trees.copy("euroc");
    let list = copy.path().join("mav0/cam0/data.csv");
    let text = fs::read_to_string(&list).unwrap();
    fs::write(copy.path().join("mav0/secret.png"), b"").unwrap();
    fs::write(&list, text.replace(",1700", ",../../secret.png1700")).unwrap();
    refused("euroc", copy.path(), &["not there"]);
}

#[test]
fn profiles_ask_for_nothing_beyond_their_folder() {
    let euroc = BUILTIN.iter().find(|builtin| builtin.name == "euroc").unwrap().text;
    let mono = BUILTIN.iter().find(|builtin| builtin.name == "mono").unwrap().text;
    let error = |text: &str| parse_profile("mine", text).unwrap_err().to_string();
    for (from, to, words) in [
        ("cam0/data.csv", "../cam0/data.csv", "below the dataset's folder"),
        ("cam0/data.csv", "/etc/passwd", "below the dataset's folder"),
        ("cam0/data.csv", "cam0//data.csv", "below the dataset's folder"),
        ("cam0/data.csv", "cam*/data.csv", "in its last part"),
        ("cam0/data/*.png", "C:\\\\data\\\\*.png", "below the dataset's folder"),
        ("\"mav0\"", "\"..\"", "within"),
        ("title =", "titel =", "titel"),
        ("unit = \"ns\"", "unit = \"fortnights\"", "fortnights"),
        ("files = [\"imu0/data.csv\"]", "files = []", "empty list"),
    ] {
        let said = error(&euroc.replace(from, to));
        assert!(said.contains(words) && said.contains("profile mine"), "{to}: {said}");
    }
    for (hertz, is_right) in [("0.5", true), ("0.0", false), ("-1.0", false), ("1e300", false), ("nan", false)] {
        let read = parse_profile("mine", &mono.replace("hertz = 10.0", &format!("hertz = {hertz}")));
        assert_eq!(read.is_ok(), is_right, "{hertz}");
    }
    for text in
        ["", "title = \"x\"", "\u{0}", "title = [[[[[[", &format!("{euroc}\n[recording]\nfiles = [\"a.bag\"]\n")]
    {
        assert!(error(text).contains("profile mine"), "{text}");
    }
    assert!(error(&euroc.replace("[truth.rows]", "[truth.rows]\nbody_from_left = [1.0]")).contains("16 numbers"));
    let above = euroc.replace("[calibration]", "[calibration]\nabove = 200");
    assert!(error(&above).contains("at most 3"));
}

#[test]
fn every_built_in_profile_is_right_and_says_what_it_is() {
    for builtin in BUILTIN {
        let (profile, text) = find_profile(builtin.name).unwrap();
        assert!(!profile.title.is_empty() && text.starts_with('#'), "{}", builtin.name);
        assert!(builtin.name == "mono" || profile.documentation.starts_with("https://"), "{}", builtin.name);
    }
}
