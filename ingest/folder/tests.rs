//! Folders written for the test, in every layout and with every part missing.

#[path = "../../tests/support/golden_data.rs"]
mod golden_data;

use super::{FolderError, ImageFile, NOMINAL_INTERVAL_NS, SingleFolder, StereoFolder};
use furrow_catalog::images::{RawImage, Rectifier, Side, store_raw};
use proptest::prelude::*;
use std::fs;
use std::path::Path;

const CALIB: &str = "P0: 60 0 4 0 0 60 3 0 0 0 1 0\nP1: 60 0 4 -7.2 0 60 3 0 0 0 1 0\n\
                     P2: 50 0 4 0 0 50 3 0 0 0 1 0\nP3: 50 0 4 -5 0 50 3 0 0 0 1 0\n";

fn image() -> Vec<u8> {
    let data = [9; 48];
    store_raw(&RawImage { width: 8, height: 6, step: 8, encoding: "mono8", big_endian: false, data: &data })
        .unwrap()
        .bytes
}

/// A folder of images with these names, in subfolders `left` and `right`.
fn write(folder: &Path, left: (&str, &[&str]), right: (&str, &[&str])) {
    for (name, images) in [left, right] {
        fs::create_dir_all(folder.join(name)).unwrap();
        for file in images {
            fs::write(folder.join(name).join(file), image()).unwrap();
        }
    }
}

fn refusal(folder: &Path) -> String {
    StereoFolder::open(folder, &[]).unwrap_err().to_string()
}

#[test]
fn kitti_odometry_with_times_and_missing_partners() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    write(
        path,
        ("image_0", &["000000.png", "000001.png", "000003.png"]),
        ("image_1", &["000000.png", "000002.png", "000003.png"]),
    );
    fs::write(path.join("calib.txt"), CALIB).unwrap();
    fs::write(path.join("times.txt"), "0.000000e+00\n1.036e-01\n2.071e-01\n3.1e-01\n").unwrap();
    let opened = StereoFolder::open(path, &[]).unwrap();
    assert_eq!(opened.pairs.iter().map(|pair| pair.stamp_ns).collect::<Vec<_>>(), [0, 310_000_000]);
    assert!(opened.pairs[1].right.ends_with("image_1/000003.png"));
    let unpaired: Vec<_> = opened.unpaired.iter().map(|image| (image.stamp_ns, image.side)).collect();
    assert_eq!(unpaired, [(103_600_000, Side::Left), (207_100_000, Side::Right)]);
    assert!(opened.stamps_are_recorded);
    let rectifier = Rectifier::from_record(&opened.calibration).unwrap();
    assert!(rectifier.is_identity());
    assert_eq!((rectifier.rig().width, rectifier.rig().height), (8, 6));
    assert!((rectifier.rig().baseline_m - 0.12).abs() < 1e-12);
}

#[test]
fn colour_cameras_take_their_own_matrices_and_nominal_times() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), ("image_2", &["0.png", "1.png"]), ("image_3", &["0.png", "1.png"]));
    fs::write(folder.path().join("calib.txt"), CALIB).unwrap();
    let opened = StereoFolder::open(folder.path(), &[]).unwrap();
    assert_eq!(Rectifier::from_record(&opened.calibration).unwrap().rig().baseline_m, 0.1);
    assert_eq!(opened.pairs[1].stamp_ns, NOMINAL_INTERVAL_NS);
    assert!(!opened.stamps_are_recorded);
}

#[test]
fn images_named_by_stamps_beside_a_json_calibration() {
    let folder = tempfile::tempdir().unwrap();
    let names = ["1768457158612905541.png", "1768457151184334112.png", "notes.txt"];
    write(folder.path(), ("left", &names), ("right", &names));
    let json = r#"{"width": 8, "height": 6, "fx": 60.0, "fy": 60.0, "cx": 3.5, "cy": 2.5, "baseline_m": 0.12,
                   "distortion": [0, 0, 0, 0], "rectified": true, "pass": {"route": "x"}}"#;
    fs::write(folder.path().join("calibration.json"), json).unwrap();
    let opened = StereoFolder::open(folder.path(), &[]).unwrap();
    assert_eq!(opened.pairs[0].stamp_ns, 1_768_457_151_184_334_112);
    assert_eq!(opened.pairs.len(), 2);
    assert_eq!(Rectifier::from_record(&opened.calibration).unwrap().rig().cu_px, 3.5);
    fs::write(folder.path().join("calibration.json"), json.replace("true", "false")).unwrap();
    assert!(refusal(folder.path()).contains("expected rectified images"));
}

#[test]
fn every_missing_part_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    assert!(matches!(StereoFolder::open(&path.join("absent"), &[]), Err(FolderError::Unreadable { .. })));
    assert!(refusal(path).contains("found nothing"));
    fs::create_dir(path.join("left")).unwrap();
    let message = refusal(path);
    assert!(message.contains("image_0 and image_1") && message.contains("found left"), "{message}");
    fs::create_dir(path.join("right")).unwrap();
    assert!(refusal(path).contains("looked for JPEG, PNG, PGM or PPM images, found nothing"));
    write(path, ("left", &["000000.png"]), ("right", &["000001.png"]));
    assert!(refusal(path).contains("looked for calib.txt or calibration.json"));
    fs::write(path.join("calib.txt"), CALIB).unwrap();
    assert!(refusal(path).contains("same names in left and right"));
    write(path, ("left", &["000001.png"]), ("right", &["000001.png"]));
    assert_eq!(StereoFolder::open(path, &[]).unwrap().unpaired.len(), 1);
    fs::write(path.join("times.txt"), "0.5\n").unwrap();
    assert!(refusal(path).contains("expected a time for frame 1, found 1 lines"));
    fs::remove_file(path.join("times.txt")).unwrap();
    write(path, ("left", &["1.png"]), ("right", &[]));
    assert!(matches!(StereoFolder::open(path, &[]), Err(FolderError::Twice { .. })));
    fs::rename(path.join("left/1.png"), path.join("left/first.png")).unwrap();
    assert!(matches!(StereoFolder::open(path, &[]), Err(FolderError::Name { .. })));
    fs::rename(path.join("left/first.png"), path.join("left/1768457151184334112.png")).unwrap();
    assert!(refusal(path).contains("is a stamp"));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(24) })]

    /// All frames that have a partner get it, and keep their own stamps, whatever the share of equal names: a quarter
    /// of a period apart, neighbours cannot be taken for partners.
    #[test]
    fn frames_named_by_stamps_pair_whatever_the_share_of_equal_names(
        are_equal in prop::collection::vec(any::<bool>(), 51),
        all_equal in prop::option::of(any::<bool>()),
        late_ns in 1_i64..25_000_000,
        lost in 0_usize..51,
    ) {
        let folder = tempfile::tempdir().unwrap();
        let stamp = |i: usize| 1_700_000_000_000_000_000 + i as i64 * 100_000_000;
        let late = |i: usize| if all_equal.unwrap_or(are_equal[i]) { stamp(i) } else { stamp(i) + late_ns };
        let names = |of: &dyn Fn(usize) -> i64, lost: Option<usize>| -> Vec<String> {
            (0..51).filter(|i| Some(*i) != lost).map(|i| format!("{}.png", of(i))).collect()
        };
        let (left, right) = (names(&stamp, None), names(&late, Some(lost)));
        write(
            folder.path(),
            ("Left", &left.iter().map(String::as_str).collect::<Vec<_>>()),
            ("RIGHT", &right.iter().map(String::as_str).collect::<Vec<_>>()),
        );
        fs::write(folder.path().join("Left/._0.png"), "AppleDouble").unwrap();
        fs::write(folder.path().join("Left/Thumbs.db"), "litter").unwrap();
        fs::write(folder.path().join("calib.txt"), CALIB).unwrap();
        let opened = StereoFolder::open(folder.path(), &[]).unwrap();
        let found: Vec<_> = opened.pairs.iter().map(|pair| (pair.stamp_ns, pair.right_stamp_ns)).collect();
        let expected: Vec<_> = (0..51).filter(|i| *i != lost).map(|i| (stamp(i), late(i))).collect();
        prop_assert_eq!(found, expected);
        prop_assert_eq!(opened.unpaired.iter().map(|image| image.stamp_ns).collect::<Vec<_>>(), [stamp(lost)]);
        prop_assert!(opened.stamps_are_recorded);
    }
}

#[test]
fn names_of_one_side_are_understood_together() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("calib.txt"), CALIB).unwrap();
    write(folder.path(), ("left", &["left2.png", "left10.png"]), ("right", &["right2.png", "right10.png"]));
    let opened = StereoFolder::open(folder.path(), &[]).unwrap();
    assert_eq!(opened.pairs.iter().map(|pair| pair.stamp_ns).collect::<Vec<_>>(), [200_000_000, 1_000_000_000]);
    fs::rename(folder.path().join("right/right2.png"), folder.path().join("right/right99999999999.png")).unwrap();
    let message = refusal(folder.path());
    assert!(message.contains("right99999999999.png") && message.contains("11 digits"), "{message}");
}

#[test]
fn a_first_image_that_is_none_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), ("left", &["0.png"]), ("right", &["0.png"]));
    fs::write(folder.path().join("calib.txt"), CALIB).unwrap();
    fs::write(folder.path().join("left/0.png"), "no image").unwrap();
    assert!(refusal(folder.path()).contains("expected a JPEG or PNG file"));
}

#[test]
fn names_may_have_bytes_that_are_no_text() {
    use std::os::unix::ffi::OsStrExt;
    let folder = tempfile::tempdir().unwrap();
    for (name, value) in [(&b"a.pgm"[..], 1), (b"b\xff\xfe.pgm", 2), (b"c.pgm", 3)] {
        fs::write(folder.path().join(std::ffi::OsStr::from_bytes(name)), pgm(255, value)).unwrap();
    }
    let opened = SingleFolder::open(folder.path(), None, &[]).unwrap();
    let last = |image: &ImageFile| fs::read(&image.path).unwrap()[11];
    assert_eq!(opened.images.iter().map(last).collect::<Vec<_>>(), [1, 2, 3]);
}

/// A PGM of 4 x 3 pixels with this white level, all of them of one value.
fn pgm(white: u16, value: u16) -> Vec<u8> {
    let value = value.to_be_bytes();
    let pixel = if white > 255 { &value[..] } else { &value[1..] };
    [format!("P5 4 3 {white}\n").as_bytes(), &pixel.repeat(12)].concat()
}

#[test]
fn a_torn_first_image_does_not_tell_the_size_and_the_brightest_pixel_tells_the_depth() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), ("left", &["0.pgm", "1.PGM"]), ("right", &["0.pgm", "1.pgm"]));
    fs::write(folder.path().join("calib.txt"), CALIB).unwrap();
    for (white, brightest, bits) in [(255, 255, 16), (65_535, 1023, 10), (65_535, 4095, 12), (65_535, 60_000, 16)] {
        for (name, value) in [("left/1.PGM", 1), ("right/0.pgm", brightest), ("right/1.pgm", 3)] {
            fs::write(folder.path().join(name), pgm(white, value)).unwrap();
        }
        fs::write(folder.path().join("left/0.pgm"), "P5 4").unwrap();
        let pairs = StereoFolder::open(folder.path(), &[]).unwrap();
        assert_eq!((pairs.calibration.left.width, pairs.calibration.left.height), (4, 3));
        assert_eq!(pairs.depth.bits(), bits, "brightest {brightest} of {white}");
        let single = SingleFolder::open(&folder.path().join("right"), None, &[]).unwrap();
        assert_eq!((single.camera.camera.width, single.depth.bits()), (4, bits));
    }
}

#[test]
fn real_folders_open_completely() {
    let files = golden_data::data().map(|folder| golden_data::files_below(&folder)).unwrap_or_default();
    let is_calibration = |path: &&std::path::PathBuf| path.file_name().is_some_and(|name| name == "calib.txt");
    let folders: Vec<&Path> = files.iter().filter(is_calibration).filter_map(|path| path.parent()).collect();
    for folder in &folders {
        let opened = StereoFolder::open(folder, &[]).unwrap();
        let images = files.iter().filter(|path| path.starts_with(folder));
        let images =
            images.filter(|path| path.extension().is_some_and(|extension| extension == "jpg" || extension == "png"));
        assert_eq!(opened.pairs.len() * 2 + opened.unpaired.len(), images.count(), "{}", folder.display());
        let rig = Rectifier::from_record(&opened.calibration).unwrap().rig();
        assert!(rig.baseline_m > 0.05 && rig.baseline_m < 2.0, "{}: {rig:?}", folder.display());
    }
    if folders.is_empty() {
        eprintln!("SKIPPED: no folder with a calib.txt");
    }
}
