//! Rates, clocks and losses as they are found in a recording and beside it.

use furrow_field::{CameraSettings, Simulation, Site, Summary, Traversal, record};
use std::collections::BTreeMap;
use std::path::Path;

const LEFT: &str = "/zed2i/zed_node/left/image_rect_color";
const RIGHT: &str = "/zed2i/zed_node/right/image_rect_color";

fn traversal(length_m: f64, camera: CameraSettings) -> Traversal {
    Traversal { size: (64, 36), length_m, camera, ..Traversal::new(Site::Backsburg, "08:00".parse().expect("a slot")) }
}

/// What `traversal` is recorded as: the summary, and of every topic (header stamp, receive time), nanoseconds.
fn recorded(traversal: &Traversal, folder: &Path) -> (Summary, BTreeMap<String, Vec<(i64, i64)>>) {
    let path = folder.join("a.mcap");
    let summary = record(traversal, &path, &mut |_, _| ()).expect("a recording");
    let bytes = std::fs::read(path).expect("the recording");
    let mut stamps = BTreeMap::<String, Vec<(i64, i64)>>::new();
    for message in mcap::MessageStream::new(&bytes).expect("an MCAP file") {
        let message = message.expect("a message");
        let number = |at: usize| u32::from_le_bytes(message.data[at..at + 4].try_into().expect("four bytes"));
        let stamp_ns = i64::from(number(4)) * 1_000_000_000 + i64::from(number(8));
        stamps.entry(message.channel.topic.clone()).or_default().push((stamp_ns, message.log_time as i64));
    }
    (summary, stamps)
}

/// The columns of a table by their names.
fn table(path: &Path) -> BTreeMap<String, Vec<String>> {
    let text = std::fs::read_to_string(path).expect("a table");
    let mut lines = text.lines().map(|line| line.split(',').map(str::to_owned).collect::<Vec<String>>());
    let head = lines.next().expect("a head");
    let rows: Vec<Vec<String>> = lines.collect();
    assert!(rows.iter().all(|row| row.len() == head.len()));
    head.into_iter().enumerate().map(|(k, name)| (name, rows.iter().map(|row| row[k].clone()).collect())).collect()
}

fn whole(column: &[String]) -> Vec<i64> {
    column.iter().map(|text| text.parse().expect("a whole number")).collect()
}

#[test]
fn lost_images_are_missing_and_the_table_says_which() {
    let folder = tempfile::tempdir().expect("a folder");
    let camera = CameraSettings { dropped: 0.4, rate_hz: 30.0, ..CameraSettings::default() };
    let (summary, stamps) = recorded(&traversal(4.0, camera), folder.path());
    let table = table(&folder.path().join("a.frames.csv"));
    let (left, right, stamp) =
        (whole(&table["left_recorded"]), whole(&table["right_recorded"]), whole(&table["stamp_ns"]));
    assert_eq!(stamp.len() as u64, summary.frames);
    for (topic, kept) in [(LEFT, &left), (RIGHT, &right)] {
        let expected: Vec<i64> =
            stamp.iter().zip(kept).filter(|&(_, &kept)| kept == 1).map(|(&stamp, _)| stamp).collect();
        assert_eq!(stamps[topic].iter().map(|&(stamp, _)| stamp).collect::<Vec<_>>(), expected, "{topic}");
    }
    let count = |wanted: (i64, i64)| left.iter().zip(&right).filter(|&(&l, &r)| (l, r) == wanted).count() as f64;
    let all = stamp.len() as f64;
    assert_eq!(count((1, 1)) as u64, summary.pairs);
    // Over 140 frames, 0.4 of them losing something: deviations of 0.04 and less.
    assert!(all > 140.0 && (0.26..0.54).contains(&(1.0 - count((1, 1)) / all)), "{all} {}", count((1, 1)));
    assert!([(0, 0), (0, 1), (1, 0)].into_iter().all(|kind| count(kind) / all > 0.03));
    assert_eq!((left[0], right[0]), (1, 1), "a recording begins with a pair");
    let truth = std::fs::read_to_string(folder.path().join("a.groundtruth.tum")).expect("ground truth");
    assert_eq!(truth.lines().count(), stamp.len() + 1, "lost frames have a pose too");
    let about: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("a.pass.json")).expect("the description"))
            .expect("JSON");
    assert_eq!(about["left_images"], stamps[LEFT].len() as u64);
    assert_eq!((&about["camera"]["dropped"], &about["camera"]["rate_hz"]), (&0.4.into(), &30.0.into()));
    assert_eq!((&about["length_m"], &about["size"][1]), (&4.0.into(), &36.into()));
}

#[test]
fn a_fast_clock_and_an_offset_are_in_the_stamps_and_not_in_the_poses() {
    let folder = tempfile::tempdir().expect("a folder");
    let camera =
        CameraSettings { rate_hz: 15.0, clock_skew_ppm: 400.0, clock_offset_ms: 9.0, ..CameraSettings::default() };
    let skewed = traversal(2.0, camera);
    let (summary, stamps) = recorded(&skewed, folder.path());
    let table = table(&folder.path().join("a.frames.csv"));
    let (stamp, truly, right) = (whole(&table["stamp_ns"]), whole(&table["true_ns"]), whole(&table["right_stamp_ns"]));
    let simulation = Simulation::prepare(&skewed).expect("a sound traversal");
    let truth = std::fs::read_to_string(folder.path().join("a.groundtruth.tum")).expect("ground truth");
    let truth: Vec<Vec<f64>> =
        truth.lines().skip(1).map(|line| line.split(' ').map(|n| n.parse().expect("a number")).collect()).collect();
    let mut tremble_ms = (f64::INFINITY, f64::NEG_INFINITY);
    for i in 0..summary.frames as usize {
        let elapsed_ns = i as f64 * 1e9 / 15.0;
        assert!(((truly[i] - skewed.start_ns()) as f64 - elapsed_ns).abs() < 1.0, "true times are whole fifteenths");
        let fast_ns = (stamp[i] - skewed.start_ns()) as f64 - elapsed_ns;
        assert!((fast_ns - 400e-6 * elapsed_ns).abs() < 2.0, "frame {i} is stamped {fast_ns} ns late");
        let later_ms = (right[i] - stamp[i]) as f64 / 1e6 - 9.0;
        tremble_ms = (tremble_ms.0.min(later_ms), tremble_ms.1.max(later_ms));
        assert_eq!((stamps[LEFT][i].0, stamps[RIGHT][i].0), (stamp[i], right[i]));
        // What is received is received in true time: 14 ms after the exposure.
        assert!((stamps[LEFT][i].1 - truly[i] - 14_000_000).abs() < 1_000_000);
        let [x, y, z] = simulation.world_from_left(i as f64 / 15.0).translation_m;
        assert!((truth[i][0] - stamp[i] as f64 / 1e9).abs() < 1e-6);
        assert!([x, y, z].iter().zip(&truth[i][1..4]).all(|(a, b)| (a - b).abs() < 1e-8), "frame {i}");
    }
    assert!(tremble_ms.0 > -0.71 && tremble_ms.1 < 0.71 && tremble_ms.1 - tremble_ms.0 > 0.2, "{tremble_ms:?}");
    // IMU and camera part: the IMU keeps the true time.
    assert!(stamps["/imu/data"].iter().all(|(stamp, _)| (stamp - skewed.start_ns()) % 10_000_000 == 0));
}

#[test]
fn the_rate_changes_how_often_but_not_where() {
    let at = |rate_hz: f64| {
        Simulation::prepare(&traversal(3.0, CameraSettings { rate_hz, ..CameraSettings::default() }))
            .expect("a sound traversal")
    };
    let (slow, fast) = (at(5.0), at(15.0));
    let ratio = (fast.frames() - 1) as f64 / (slow.frames() - 1) as f64;
    assert!((2.8..3.2).contains(&ratio), "{ratio}");
    assert_eq!(slow.world_from_left(slow.time_s(4)), fast.world_from_left(fast.time_s(12)));
}

#[test]
fn raw_images_have_topics_and_calibrations_of_their_own() {
    let folder = tempfile::tempdir().expect("a folder");
    let camera = CameraSettings { distorted: true, rate_hz: 2.0, ..CameraSettings::default() };
    let (summary, stamps) = recorded(&traversal(1.0, camera), folder.path());
    let topics: Vec<&str> = stamps.keys().map(String::as_str).collect();
    let expected = [
        "/gps/fix",
        "/imu/data",
        "/zed2i/zed_node/left_raw/camera_info",
        "/zed2i/zed_node/left_raw/image_raw_color",
        "/zed2i/zed_node/right_raw/camera_info",
        "/zed2i/zed_node/right_raw/image_raw_color",
    ];
    assert_eq!(topics, expected);
    assert!(expected[2..].iter().all(|topic| stamps[*topic].len() as u64 == summary.pairs));
    let truth = std::fs::read_to_string(folder.path().join("a.groundtruth.tum")).expect("ground truth");
    assert!(
        truth
            .lines()
            .next()
            .is_some_and(|head| head.contains("rectified left camera") && head.contains("camera's own clock"))
    );
    let bytes = std::fs::read(folder.path().join("a.mcap")).expect("the recording");
    for message in mcap::MessageStream::new(&bytes).expect("an MCAP file").map(|message| message.expect("a message")) {
        if message.channel.topic.ends_with("camera_info") {
            // From the end: P, R, K, D of 12, 9, 9, 5 doubles, behind them binning and region in 25 bytes.
            let end = message.data.len() - 25;
            let number = |back: usize| {
                f64::from_le_bytes(message.data[end - 8 * back..end - 8 * back + 8].try_into().expect("a double"))
            };
            let (k1, fx, r01, p_fx) = (number(35), number(30), number(20), number(12));
            assert!((k1 + 0.17).abs() < 0.01 && r01 != 0.0 && r01.abs() < 0.01, "{k1} {r01}");
            assert!((fx / 64.0 - 0.418).abs() < 0.002 && (p_fx - 26.4).abs() < 1e-9, "{fx} {p_fx}");
        }
    }
}

#[test]
fn two_frames_of_720p_are_recorded() {
    let folder = tempfile::tempdir().expect("a folder");
    let camera = CameraSettings { rate_hz: 1.0, ..CameraSettings::default() };
    let (summary, stamps) = recorded(&Traversal { size: (1280, 720), ..traversal(1.0, camera) }, folder.path());
    assert_eq!((summary.pairs, stamps[LEFT].len(), stamps[RIGHT].len()), (2, 2, 2));
    assert!(summary.bytes > 1_000_000, "{}", summary.bytes);
}
