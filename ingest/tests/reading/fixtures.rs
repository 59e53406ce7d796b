//! Real recordings of other tools.

use crate::golden_data::{data, files_below};
use crate::{each_message, messages_of};
use furrow_ingest::recording::{open, open_many};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Messages by topic as Python's `rosbags` 0.11.9 (`AnyReader.messages`) or, for the ROS1 profile, `mcap` 1.6.0 counts
/// them.
const COUNTS: &[(&str, &[(&str, u64)])] = &[
    ("foxglove_example-lz4.bag", TURTLES),
    ("webviz_example-bz2.bag", TURTLES),
    ("webviz_example.bag", TURTLES),
    ("foxglove_no-messages.bag", &[]),
    (
        "kapture_t265_trimmed_locoffice.bag",
        &[
            ("/camera/accel/sample", 6),
            ("/camera/fisheye1/image_raw", 3),
            ("/camera/fisheye2/image_raw", 3),
            ("/camera/gyro/sample", 19),
            ("/camera/odom/sample", 19),
        ],
    ),
    ("kleinkram_test_small.bag", &[("/sensors/imu", 17029)]),
    ("kleinkram_test_small.mcap", &[("/sensors/imu", 17029)]),
    ("robot_localization_test1.bag", &[("/fix", 989), ("/husky_velocity_controller/odom", 3952), ("/imu/data", 11865)]),
    ("evo_nav2_turtlebot.mcap", &[("/amcl_pose", 135), ("/odom", 2639), ("/tf", 5422), ("/tf_static", 1)]),
    (
        "kitti_raw_drive_A.bag",
        &[
            ("/gps/fix", 335),
            ("/stereo/left/camera_info", 199),
            ("/stereo/left/image_raw/compressed", 199),
            ("/stereo/right/camera_info", 199),
            ("/stereo/right/image_raw/compressed", 199),
        ],
    ),
    ("stereo_lz4.bag", TEN_PAIRS),
    ("stereo_ros2_db3.db3", TEN_PAIRS),
    ("stereo_ros2_mcap.mcap", TEN_PAIRS),
    ("stereo_rawimage_half_bz2.bag", &[("/stereo/left/image_raw", 5), ("/stereo/right/image_raw", 5)]),
];

const TURTLES: &[(&str, u64)] = &[
    ("/rosout", 10),
    ("/tf", 2688),
    ("/tf_static", 1),
    ("/turtle1/cmd_vel", 357),
    ("/turtle1/color_sensor", 1351),
    ("/turtle1/pose", 1344),
    ("/turtle2/cmd_vel", 208),
    ("/turtle2/color_sensor", 1344),
    ("/turtle2/pose", 1344),
];

const TEN_PAIRS: &[(&str, u64)] = &[
    ("/gps/fix", 20),
    ("/stereo/left/camera_info", 10),
    ("/stereo/left/image_raw/compressed", 10),
    ("/stereo/right/camera_info", 10),
    ("/stereo/right/image_raw/compressed", 10),
];

/// Files that must be refused, and what the reason must name.
const REFUSED: &[(&str, &str)] = &[
    ("foxglove_empty-file.bag", "an empty file"),
    ("husky_truncated_60pct.bag", "where the file ends"),
    ("husky_unindexed.bag", "not indexed"),
    ("husky_corrupt_64bytes_mid.bag", "a chunk of"),
    ("kleinkram_truncated_70pct.mcap", "to the end of the file"),
];

/// Every recording below the data folder, by the form of its name.
fn recordings() -> Vec<PathBuf> {
    let kinds = ["bag", "mcap", "db3"];
    let is_one = |path: &PathBuf| path.extension().is_some_and(|kind| kinds.iter().any(|known| kind == *known));
    data().map(|folder| files_below(&folder).into_iter().filter(is_one).collect()).unwrap_or_default()
}

fn name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

#[test]
fn every_fixture_is_read_or_refused_with_a_reason() {
    for path in recordings() {
        let mut counts = BTreeMap::<String, u64>::new();
        let opened = open(&path);
        let error = match &opened {
            Ok(recording) => {
                each_message(recording, &mut |topic, _, _| *counts.entry(topic.to_owned()).or_default() += 1)
            }
            Err(_) => None,
        };
        let error = opened.as_ref().err().or(error.as_ref()).map(ToString::to_string);
        eprintln!("{}: {}", path.display(), error.as_deref().unwrap_or("read"));
        let refused = REFUSED.iter().find(|(file, _)| *file == name(&path));
        if let Some(error) = &error {
            assert!(
                error.contains(&*path.to_string_lossy()) && error.contains("byte") && error.contains("; "),
                "{error}"
            );
        }
        if let Some((_, reason)) = refused {
            let error = error.expect("a damaged file was read");
            assert!(error.contains(reason), "{error}");
            continue;
        }
        if let Some((_, expected)) = COUNTS.iter().find(|(file, _)| *file == name(&path)) {
            assert_eq!(error, None, "{}", path.display());
            let expected: BTreeMap<String, u64> = expected.iter().map(|(topic, n)| ((*topic).to_owned(), *n)).collect();
            assert_eq!(counts, expected, "{}", path.display());
        }
        if let (Ok(recording), None) = (&opened, &error) {
            let indexed = recording.topics().iter().filter_map(|topic| topic.messages).sum::<u64>();
            assert_eq!(indexed, counts.values().sum::<u64>(), "the index of {} has another count", path.display());
        }
    }
}

#[test]
fn one_recording_in_two_containers_has_the_same_messages() {
    let recordings = recordings();
    for bag in recordings.iter().filter(|path| path.extension().is_some_and(|kind| kind == "bag")) {
        let mcap = bag.with_extension("mcap");
        if recordings.contains(&mcap) {
            let (bag, mcap) = (open(bag).unwrap(), open(&mcap).unwrap());
            let (bag_messages, mcap_messages) = (messages_of(&bag).0, messages_of(&mcap).0);
            assert!(!bag_messages.is_empty() && bag_messages == mcap_messages, "{bag:?}");
            assert_eq!(bag.topics(), mcap.topics());
        }
    }
}

#[test]
fn a_rosbag2_folder_is_its_parts_in_order() {
    for path in recordings().iter().filter_map(|path| path.parent()).collect::<std::collections::BTreeSet<_>>() {
        let metadata = path.join("metadata.yaml");
        if !metadata.exists() {
            continue;
        }
        let whole = open(path).unwrap();
        let (messages, error) = messages_of(&whole);
        assert!(error.is_none(), "{error:?}");
        // metadata.yaml counts the messages itself.
        let text = std::fs::read_to_string(&metadata).unwrap();
        let line = text.lines().find_map(|line| line.strip_prefix("  message_count: ")).unwrap();
        assert_eq!(messages.len().to_string(), line, "{}", path.display());
        let mut files: Vec<PathBuf> = recordings().into_iter().filter(|file| file.parent() == Some(path)).collect();
        let mut by_part = Vec::new();
        for file in &files {
            by_part.extend(messages_of(&open(file).unwrap()).0);
        }
        assert_eq!(messages, by_part, "{}", path.display());
        files.reverse();
        let mut any_order = messages_of(&open_many(&files).unwrap()).0;
        assert!(any_order.iter().map(|message| message.1).eq(messages.iter().map(|message| message.1)));
        any_order.sort();
        let mut messages = messages;
        messages.sort();
        assert!(messages == any_order, "parts in any order give the same");
    }
}
