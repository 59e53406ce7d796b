//! Names that people really have.

use super::{Named, read_names};
use proptest::prelude::*;

fn frames(names: &[&str]) -> Vec<u64> {
    match read_names(names) {
        Ok(Named::Frames(frames)) => frames,
        other => panic!("{names:?}: {other:?}"),
    }
}

fn stamps(names: &[&str]) -> Vec<i64> {
    match read_names(names) {
        Ok(Named::Stamps(stamps)) => stamps,
        other => panic!("{names:?}: {other:?}"),
    }
}

fn fault(names: &[&str]) -> String {
    read_names(names).expect_err(&format!("{names:?}")).fault
}

const DATE_NS: i64 = 1_718_187_330_000_000_000;

#[test]
fn frame_numbers_with_letters_around_them() {
    assert_eq!(frames(&["000000", "000012"]), [0, 12]);
    assert_eq!(frames(&["0000000000", "0000000123"]), [0, 123]);
    assert_eq!(frames(&["left0000", "left0011"]), [0, 11]);
    assert_eq!(frames(&["frame1", "frame2", "frame10"]), [1, 2, 10]);
    assert_eq!(frames(&["img_0001.left", "img_0002.left"]), [1, 2]);
    assert_eq!(frames(&["cam0_000007", "cam0_000008"]), [7, 8]);
    assert_eq!(frames(&["cam0.000007", "cam0.000008"]), [7, 8]);
    assert_eq!(frames(&["000003_10", "000004_10"]), [3, 4]);
    assert_eq!(frames(&["20240612_000001", "20240612_000002"]), [1, 2]);
    assert_eq!(frames(&["left7"]), [7]);
}

#[test]
fn stamps_of_every_kind() {
    let second = 1_000_000_000;
    assert_eq!(
        stamps(&["1700000000.100000000", "1700000001.000000000"]),
        [17 * 10_i64.pow(17) + second / 10, 1_700_000_001 * second]
    );
    assert_eq!(
        stamps(&["1305031102.175304", "1305031102.211214"]),
        [1_305_031_102_175_304_000, 1_305_031_102_211_214_000]
    );
    assert_eq!(stamps(&["1700000000.5", "1700000000.25", "1700000001.0"])[1], 1_700_000_000_250_000_000);
    assert_eq!(stamps(&["1700000000_000000001", "1700000000_100000001"])[1], 1_700_000_000_100_000_001);
    assert_eq!(stamps(&["0.100000", "12.345000"]), [100_000_000, 12_345_000_000]);
    assert_eq!(stamps(&["cam0_1700000000123", "cam0_1700000000223"])[0], 1_700_000_000_123_000_000);
    assert_eq!(stamps(&["0001-1700000000123", "0002-1700000000223"])[1], 1_700_000_000_223_000_000);
    for name in [
        "20240612101530",
        "20240612_101530",
        "IMG_20240612_101530",
        "2024-06-12-10-15-30",
        "2024-06-12T10:15:30",
        "20240612101530000",
        "20240612_101530000",
        "2024-06-12_10-15-30.000000",
        "20240612101530000000",
        "left_2024-06-12 10.15.30.000_raw",
    ] {
        assert_eq!(stamps(&[name]), [DATE_NS], "{name}");
    }
}

#[test]
fn what_nobody_can_tell_is_refused() {
    assert!(fault(&["1700000000.5", "1700000000.123456789"]).contains("uneven"));
    assert!(fault(&["1700000000.10", "1700000000.2"]).contains("uneven"));
    assert!(fault(&["1700000000_1", "1700000001_2"]).contains("change from name to name"));
    assert!(fault(&["20240630", "20240701"]).contains("date without a time"));
    assert!(fault(&["2024061210", "2024061211"]).contains("may be a date"));
    assert!(fault(&["left0", "right1"]).contains("expected a name like 'left0'"));
    assert!(fault(&["first"]).contains("no number"));
    assert!(fault(&["000001", "1768457151184334112"]).contains("1768457151184334112 is a stamp"));
    assert!(fault(&["1768457151184334112", "000001"]).contains("1768457151184334112 is a stamp"));
    assert!(fault(&["20240612101530", "20241332101530"]).contains("no date"));
    assert!(fault(&["99999999999999999999999999"]).contains("26 digits"));
}

proptest! {
    /// Any names whatever give an answer, one number an image.
    #[test]
    fn no_name_is_too_odd(names in prop::collection::vec("[a-z_.0-9é-]{0,24}", 0..6)) {
        let stems: Vec<&str> = names.iter().map(String::as_str).collect();
        match read_names(&stems) {
            Ok(Named::Frames(frames)) => prop_assert_eq!(frames.len(), names.len()),
            Ok(Named::Stamps(stamps)) => prop_assert!(stamps.len() == names.len() && stamps.iter().all(|s| *s >= 0)),
            Err(fault) => prop_assert!(fault.at < names.len()),
        }
    }

    /// A moment comes back from every way of writing it, as exactly as it was written.
    #[test]
    fn moments_come_back(start_ns in 1_400_000_000_000_000_000_i64..1_900_000_000_000_000_000, step_ns in 1_000_000_000_i64..9_000_000_000) {
        let moments: Vec<i64> = (0..5).map(|i| start_ns + i * step_ns).collect();
        let written = |unit: i64| moments.iter().map(|ns| (ns / unit).to_string()).collect::<Vec<_>>();
        for unit in [1, 1_000, 1_000_000, 1_000_000_000] {
            let names = written(unit);
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            let expected: Vec<i64> = moments.iter().map(|ns| ns / unit * unit).collect();
            prop_assert_eq!(stamps(&names), expected);
        }
        let split: Vec<String> = moments.iter().map(|ns| format!("{}.{:09}", ns / 1_000_000_000, ns % 1_000_000_000)).collect();
        prop_assert_eq!(stamps(&split.iter().map(String::as_str).collect::<Vec<_>>()), moments);
    }
}
