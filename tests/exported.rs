//! A cell of a run as a recording for players: what is in it is what was decided, on the recording's stamps, in types that players know.

mod placed;
mod python;
mod refused;
mod wire;

use crate::command::{field, furrow, json, matrix, store, text};
use crate::evaluation::{Row, frames_of};
use crate::interrupted::{killed_after, moments};
use furrow_catalog::{Catalog, tables};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Output;
use std::sync::OnceLock;
use std::time::Instant;
use wire::{Message, Schemas};

/// A collective's name that would like to be markup, to turn the text around and to be long.
const HOSTILE: &str = "</script>\u{202e}<img src=x onerror=alert(1)>";

/// A store with one run of which every test exports something; made once.
struct Run {
    store: tempfile::TempDir,
    run: Value,
    hostile: String,
}

impl Run {
    fn made() -> &'static Self {
        static RUN: OnceLock<Run> = OnceLock::new();
        RUN.get_or_init(|| {
            let store = store();
            field().ingest(store.path());
            let file = matrix(store.path());
            let hostile = HOSTILE.to_owned() + &"x".repeat(300);
            let plain = std::fs::read_to_string(&file).unwrap();
            let more = format!("[[collective]]\nname = \"{hostile}\"\nof = \"recorded\"\npolicy = {{ slot = 1 }}\n");
            std::fs::write(&file, plain.replace("\"08:00\", \"10:00\"]", "\"08:00\", \"10:00\", \"14:00\"]") + &more)
                .unwrap();
            let run = furrow().arg("--store").arg(store.path()).args(["run", text(&file), "--json"]).output().unwrap();
            // Nothing was recorded at 14:00: that cell is blocked.
            assert_eq!(run.status.code(), Some(3), "{}", String::from_utf8_lossy(&run.stderr));
            Self { store, run: serde_json::from_slice(&run.stdout).unwrap(), hostile }
        })
    }

    /// A cell as `furrow run --json` prints it.
    fn cell(&self, experience: &str) -> &Value {
        let mut cells = self.run["cells"].as_array().unwrap().iter();
        cells.find(|cell| cell["experience"] == experience).unwrap()
    }

    /// Exports a cell.
    fn export(&self, experience: &str, file: &Path) -> Value {
        json(self.store.path(), &["export", "run", "latest", "--experience", experience, "-o", text(file)])
    }

    /// Tries to export, and must not come to anything.
    fn refused(&self, args: &[&str]) -> (Option<i32>, String) {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("refused.mcap");
        let mut command = furrow();
        command.arg("--store").arg(self.store.path()).args(["export", "run"]).args(args).arg("-o").arg(&file);
        let Output { status, stderr, .. } = command.output().unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{args:?} left a file");
        (status.code(), String::from_utf8(stderr).unwrap())
    }
}

/// The exported collective `both` and the rows that it stands on, by live stamp.
fn both() -> (&'static Run, PathBuf, Value, BTreeMap<i64, Vec<Row>>, tempfile::TempDir) {
    let run = Run::made();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("both.mcap");
    let told = run.export("both", &file);
    (run, file, told, frames_of(run.store.path(), run.cell("both")), folder)
}

/// The row that a frame's images show: the localisation, else the first with most inliers.
fn shown(rows: &[Row]) -> Option<&Row> {
    let most = rows.iter().filter_map(|row| row.inliers).max();
    let accepted = rows.iter().find(|row| row.decision == "accepted");
    accepted.or_else(|| rows.iter().find(|row| row.inliers.is_some() && row.inliers == most))
}

#[test]
fn every_message_is_what_the_events_say_on_the_recordings_stamps() {
    let (run, file, told, frames, _folder) = both();
    let bytes = std::fs::read(&file).unwrap();
    let mut schemas = Schemas::default();
    let mut topics: BTreeMap<String, Vec<(i64, Message)>> = BTreeMap::new();
    let mut last = 0;
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        assert!(message.log_time >= last && message.publish_time == message.log_time, "stamps never fall");
        last = message.log_time;
        let schema = message.channel.schema.as_ref().unwrap();
        assert_eq!((schema.encoding.as_str(), message.channel.message_encoding.as_str()), ("protobuf", "protobuf"));
        let read = schemas.read(&schema.name, &schema.data, &message.data);
        topics.entry(message.channel.topic.clone()).or_default().push((message.log_time as i64, read));
    }
    let counts: BTreeMap<&str, usize> =
        topics.iter().map(|(topic, messages)| (topic.as_str(), messages.len())).collect();
    assert_eq!(told["messages"], serde_json::to_value(&counts).unwrap(), "the command tells what is there");

    let stamps: Vec<i64> = frames.keys().copied().collect();
    for topic in ["/live/left", "/live/calibration", "/live/annotations", "/live/pose", "/tf", "/localisation"] {
        let found: Vec<i64> = topics[topic].iter().map(|(stamp, _)| *stamp).collect();
        assert_eq!(found, stamps, "{topic}");
    }
    let matched: Vec<i64> = frames.iter().filter(|(_, rows)| shown(rows).is_some()).map(|(stamp, _)| *stamp).collect();
    assert!(!matched.is_empty(), "something is matched");
    assert_eq!(topics["/match/left"].iter().map(|(stamp, _)| *stamp).collect::<Vec<_>>(), matched);

    // Fields by their numbers in Foxglove's published schemas: CompressedImage has data 2, format 3, frame_id 4.
    let catalog = Catalog::open(run.store.path()).unwrap();
    let images = images(&catalog, run.cell("both"));
    for (topic, side) in [("/live/left", 0), ("/match/left", 1)] {
        for (stamp, image) in &topics[topic] {
            let recorded = catalog.objects().read(images[stamp][side].unwrap()).unwrap();
            assert_eq!(image.bytes(2), recorded, "{topic} at {stamp} holds the stored bytes");
            let format = if recorded.starts_with(b"\x89PNG") { "png" } else { "jpeg" };
            assert_eq!(image.text(3), format);
            assert_eq!(image.message(1).stamp_ns(), *stamp);
        }
    }
    let mut places = 0;
    for (stamp, localisation) in &topics["/localisation"] {
        let (rows, of) = (&frames[stamp], |name: &str| schemas.number("localisation.Localisation", name));
        let accepted = rows.iter().any(|row| row.decision == "accepted");
        assert_eq!(localisation.number(of("lost")).unwrap_or(0) == 0, accepted, "{stamp}");
        assert_eq!(localisation.number(of("threshold_inliers")), Some(40));
        let inliers = shown(rows).and_then(|row| row.inliers);
        assert_eq!(localisation.number(of("inliers")), inliers.map(u64::from), "{stamp}");
        let found = localisation.messages(of("places"));
        let likelihoods: Vec<f64> = found.iter().map(|place| place.double(6).unwrap_or(0.0)).collect();
        assert_eq!(likelihoods, rows.iter().map(|row| row.log_likelihood).collect::<Vec<_>>());
        places += found.len();
    }
    assert_eq!(places, frames.values().map(Vec::len).sum::<usize>(), "every row of the events is there");
    // ImageAnnotations has points 2; a PointsAnnotation type 2 (points 1, line list 4) and points 3.
    let (mut drawn, mut lines) = (BTreeMap::new(), BTreeMap::new());
    for (stamp, annotations) in &topics["/match/annotations"] {
        for marks in annotations.messages(2) {
            let of = if marks.number(2) == Some(1) { &mut drawn } else { &mut lines };
            of.insert(*stamp, marks.messages(3).len() as u32);
        }
    }
    for (stamp, rows) in &frames {
        let inliers = shown(rows).and_then(|row| row.inliers).unwrap_or(0);
        assert_eq!(drawn.get(stamp).copied().unwrap_or(0), inliers, "a point for every inlier at {stamp}");
        assert_eq!(lines.get(stamp).copied().unwrap_or(0), 2 * inliers, "and a line");
    }
    hang_together(&topics);
}

/// Every frame of reference that a message names hangs on one root, by the transforms of that very moment.
fn hang_together(topics: &BTreeMap<String, Vec<(i64, Message)>>) {
    let tree = |stamp: i64| -> BTreeMap<String, String> {
        let (_, transforms) = topics["/tf"].iter().find(|(at, _)| *at == stamp).unwrap();
        // FrameTransform has parent 2 and child 3.
        transforms.messages(1).iter().map(|one| (one.text(3), one.text(2))).collect()
    };
    // Where the frame's name stands: CompressedImage 4, CameraCalibration 9, PoseInFrame and PosesInFrame 2.
    let named =
        [("/live/left", 4), ("/match/left", 4), ("/live/calibration", 9), ("/match/pose", 2), ("/live/track", 2)];
    for (topic, number) in named.into_iter().chain([("/experience_1/track", 2), ("/experience_2/track", 2)]) {
        for (stamp, message) in &topics[topic] {
            let (tree, mut at) = (tree(*stamp), message.text(number));
            for _ in 0..5 {
                at = tree.get(&at).cloned().unwrap_or(at);
            }
            assert_eq!(at, "world", "{topic}: {} hangs nowhere", message.text(number));
        }
    }
}

/// By live stamp: the live image, and that of the row that is shown.
fn images(catalog: &Catalog, cell: &Value) -> BTreeMap<i64, [Option<furrow_model::ObjectId>; 2]> {
    let id = cell["events"].as_str().unwrap().parse().unwrap();
    let table = tables::from_parquet("events", catalog.objects().read(id).unwrap()).unwrap();
    let ids = |name: &str| -> Vec<Option<furrow_model::ObjectId>> {
        table.column(name).unwrap().str().unwrap().iter().map(|id| id.map(|id| id.parse().unwrap())).collect()
    };
    let (live, node) = (ids("live_image"), ids("node_image"));
    let inliers = tables::optional_u32s(&table, "inliers").unwrap();
    let decisions = table.column("decision").unwrap().str().unwrap().iter();
    let accepted: Vec<bool> = decisions.map(|decision| decision == Some("accepted")).collect();
    let mut shown: BTreeMap<i64, (i64, [Option<furrow_model::ObjectId>; 2])> = BTreeMap::new();
    for (i, stamp) in tables::i64s(&table, "live_stamp_ns").unwrap().into_iter().enumerate() {
        let rank = inliers[i].map_or(-1, i64::from) + if accepted[i] { 1 << 32 } else { 0 };
        let best = shown.entry(stamp).or_insert((-2, [None, None]));
        if rank > best.0 {
            *best = (rank, [live[i], node[i]]);
        }
    }
    shown.into_iter().map(|(stamp, (_, images))| (stamp, images)).collect()
}

#[test]
fn equal_cells_are_equal_bytes_on_any_number_of_threads() {
    let (run, file, _, _, folder) = both();
    let again = folder.path().join("again.mcap");
    let mut command = furrow();
    command.env("RAYON_NUM_THREADS", "1").arg("--store").arg(run.store.path());
    command.args(["export", "run", "latest", "--experience", "both", "-o", text(&again)]);
    assert!(command.output().unwrap().status.success());
    assert!(std::fs::read(&file).unwrap() == std::fs::read(&again).unwrap(), "the bytes differ");
}

#[test]
fn an_export_killed_at_any_moment_leaves_nothing_of_the_name_or_all() {
    let (run, file, _, _, folder) = both();
    let whole = std::fs::read(&file).unwrap();
    let target = folder.path().join("killed.mcap");
    let args = ["export", "run", "latest", "--experience", "both", "-o", text(&target)];
    let began = Instant::now();
    json(run.store.path(), &args);
    let length = began.elapsed();
    std::fs::remove_file(&target).unwrap();
    let mut killed = 0;
    for delay in moments(length, 10) {
        killed += u32::from(killed_after(run.store.path(), &args, delay));
        // The kill may come between the name and the end.
        if target.exists() {
            assert!(std::fs::read(&target).unwrap() == whole, "half a file after {delay:?}");
            std::fs::remove_file(&target).unwrap();
        }
    }
    assert!(killed >= 1, "no kill came in time");
}
