//! Clocks, rates and parts.

use super::case::{Case, read, refused};

pub const CASES: &[Case] = &[
    refused("21-stamp-zero/a", &["stamp", "0"]),
    refused("22-clock-step/back-0.55s.bag", &["back", "--frames"]),
    refused("22-clock-step/back-5s.bag", &["back", "--frames"]),
    read("22-clock-step/forward-1h.bag", 24, 27.451).noting(&["3600", "clock"]),
    read("23-rates/right-5hz.bag", 12, 26.252),
    read("23-rates/right-late.bag", 15, 16.719),
    read("23-rates/phase-20ms.bag", 24, 27.451),
    read("23-rates/phase-49ms.bag", 24, 27.451),
    refused("23-rates/offset-3-frames.bag", &["0.3"]),
    read("26-duplicate-stamps/two-frames-one-stamp.bag", 12, 26.252).noting(&["24", "stamp"]),
    read("26-duplicate-stamps/every-frame-twice.bag", 12, 13.116).noting(&["24", "stamp"]),
    read("36-split/row_0.bag;36-split/row_1.bag;36-split/row_2.bag;36-split/row_10.bag", 30, 34.627),
    read("36-split/row_10.bag;36-split/row_2.bag;36-split/row_0.bag;36-split/row_1.bag", 30, 34.627),
    read("36-split/ros2_split", 24, 27.451),
    read("36-split/left_only.bag;36-split/right_only.bag", 12, 13.116),
    read("36-split/right_only.bag;36-split/left_only.bag", 12, 13.116),
    refused("36-split/left_only.bag", &["/stereo/left"]),
    refused("36-split/row_1.bag", &["CameraInfo"]),
    // They follow each other: frames 0 to 11 and 16 to 23 of one drive.
    read("00-baseline/a.bag;36-split/row_2.bag", 20, 27.451),
    refused("00-baseline/a.bag;64-odd-stamps/since-boot.bag", &["--parts", "furrow ingest"]),
    refused("00-baseline/a.bag;00-baseline/a.bag", &["once"]),
    read("64-odd-stamps/since-boot.bag", 12, 13.116),
    read("64-odd-stamps/year-2038.bag", 12, 13.116),
    read("65-drops/a.bag", 18, 26.252),
];
