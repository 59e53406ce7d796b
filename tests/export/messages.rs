//! Every message is what the events say, on the recording's stamps.

use super::run::{Both, both, shown};
use super::wire::{Message, Schemas};
use furrow_catalog::{Catalog, tables};
use furrow_model::ObjectId;
use serde_json::Value;
use std::collections::BTreeMap;

#[test]
fn every_message_is_what_the_events_say_on_the_recordings_stamps() {
    let Both { run, file, summary, frames, folder: _folder } = both();
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
    assert_eq!(summary["messages"], serde_json::to_value(&counts).unwrap(), "the command says what is there");

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
fn images(catalog: &Catalog, cell: &Value) -> BTreeMap<i64, [Option<ObjectId>; 2]> {
    let id = cell["events"].as_str().unwrap().parse().unwrap();
    let table = tables::from_parquet("events", catalog.objects().read(id).unwrap()).unwrap();
    let ids = |name: &str| -> Vec<Option<ObjectId>> {
        table.column(name).unwrap().str().unwrap().iter().map(|id| id.map(|id| id.parse().unwrap())).collect()
    };
    let (live, node) = (ids("live_image"), ids("node_image"));
    let inliers = tables::optional_u32s(&table, "inliers").unwrap();
    let decisions = table.column("decision").unwrap().str().unwrap().iter();
    let accepted: Vec<bool> = decisions.map(|decision| decision == Some("accepted")).collect();
    let mut shown: BTreeMap<i64, (i64, [Option<ObjectId>; 2])> = BTreeMap::new();
    for (i, stamp) in tables::i64s(&table, "live_stamp_ns").unwrap().into_iter().enumerate() {
        let rank = inliers[i].map_or(-1, i64::from) + if accepted[i] { 1 << 32 } else { 0 };
        let best = shown.entry(stamp).or_insert((-2, [None, None]));
        if rank > best.0 {
            *best = (rank, [live[i], node[i]]);
        }
    }
    shown.into_iter().map(|(stamp, (_, images))| (stamp, images)).collect()
}
