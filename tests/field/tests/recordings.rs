//! What is recorded reads back: MCAP through the mcap crate, bags by their own index.

use furrow_field::{RecordError, Site, Summary, Traversal, record};
use std::collections::BTreeMap;
use std::io::Read;
use std::path::Path;

fn traversal() -> Traversal {
    Traversal { size: (96, 54), length_m: 1.5, ..Traversal::new(Site::Backsburg, "08:00".parse().expect("a slot")) }
}

fn recorded(path: &Path) -> (Summary, Vec<u8>) {
    let mut heard = (0, 0);
    let summary = record(&traversal(), path, &mut |done, total| heard = (done, total)).expect("a recording");
    assert_eq!(heard, (summary.frames, summary.frames));
    assert_eq!(summary.pairs, summary.frames, "nothing is lost unless asked for");
    let bytes = std::fs::read(path).expect("the recording");
    assert_eq!(bytes.len() as u64, summary.bytes);
    (summary, bytes)
}

fn u32_at(bytes: &[u8], at: usize) -> u32 {
    u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes"))
}

fn f64_at(bytes: &[u8], at: usize) -> f64 {
    f64::from_le_bytes(bytes[at..at + 8].try_into().expect("eight bytes"))
}

#[test]
fn an_mcap_file_holds_every_pair_with_its_stamps_and_calibration() {
    let folder = tempfile::tempdir().expect("a folder");
    let (summary, bytes) = recorded(&folder.path().join("a.mcap"));
    let (mut counts, mut last) = (BTreeMap::<String, u64>::new(), 0);
    let mut stamps = BTreeMap::<String, Vec<u64>>::new();
    for message in mcap::MessageStream::new(&bytes).expect("an MCAP file") {
        let message = message.expect("a message");
        assert!(message.log_time >= last);
        last = message.log_time;
        let topic = message.channel.topic.clone();
        let stamp = u64::from(u32_at(&message.data, 4)) * 1_000_000_000 + u64::from(u32_at(&message.data, 8));
        assert_eq!(stamp, message.publish_time);
        *counts.entry(topic.clone()).or_default() += 1;
        stamps.entry(topic.clone()).or_default().push(stamp);
        // CDR: head 4, stamp 8, frame id of 31 or 32 characters and its zero, padding to 4.
        let frame_id = u32_at(&message.data, 12) as usize;
        let body = (16 + frame_id - 4).div_ceil(4) * 4 + 4;
        if topic.ends_with("image_rect_color") {
            assert_eq!((u32_at(&message.data, body), u32_at(&message.data, body + 4)), (54, 96));
            assert_eq!(&message.data[body + 12..body + 16], b"bgr8");
            assert!(message.data.len() > 3 * 96 * 54);
        }
        if topic.ends_with("camera_info") {
            // The last 12 doubles before binning and region (25 bytes) are P, aligned to 8.
            let p = message.data.len() - 25 - 96;
            let shift = f64_at(&message.data, p + 24);
            let focal = f64_at(&message.data, p);
            assert!((focal - 264.0 * 96.0 / 640.0).abs() < 1e-9);
            let expected = if topic.contains("right") { -focal * 0.12 } else { 0.0 };
            assert!((shift - expected).abs() < 1e-9, "{topic}: {shift}");
        }
    }
    for topic in ["left/image_rect_color", "right/image_rect_color", "left/camera_info", "right/camera_info"] {
        assert_eq!(counts[&format!("/zed2i/zed_node/{topic}")], summary.pairs);
    }
    assert!(counts["/imu/data"] > 10 * summary.pairs && counts["/gps/fix"] > summary.pairs / 2);
    assert_eq!(stamps["/zed2i/zed_node/left/image_rect_color"], stamps["/zed2i/zed_node/right/image_rect_color"]);

    let truth = std::fs::read_to_string(folder.path().join("a.groundtruth.tum")).expect("ground truth");
    assert_eq!(truth.lines().count() as u64, summary.pairs + 1);
    let table = std::fs::read_to_string(folder.path().join("a.frames.csv")).expect("a table");
    assert_eq!(table.lines().count() as u64, summary.pairs + 1);
    let names: Vec<String> = std::fs::read_dir(folder.path())
        .expect("a folder")
        .map(|f| f.expect("a file").file_name().to_string_lossy().into_owned())
        .collect();
    assert_eq!(names.len(), 4, "no part is left over: {names:?}");
}

#[test]
fn the_same_pass_is_recorded_in_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a folder");
    for ending in ["mcap", "bag"] {
        let [a, b] = ["a", "b"].map(|stem| recorded(&folder.path().join(format!("{stem}.{ending}"))).1);
        assert!(a == b, "{ending}");
    }
}

/// The fields of a bag record's header, its data, and where the next record begins.
fn bag_record(bytes: &[u8], at: usize) -> (BTreeMap<String, Vec<u8>>, &[u8], usize) {
    let header = &bytes[at + 4..at + 4 + u32_at(bytes, at) as usize];
    let (mut fields, mut i) = (BTreeMap::new(), 0);
    while i < header.len() {
        let length = u32_at(header, i) as usize;
        let field = &header[i + 4..i + 4 + length];
        let equals = field.iter().position(|&b| b == b'=').expect("name=value");
        fields.insert(String::from_utf8_lossy(&field[..equals]).into_owned(), field[equals + 1..].to_vec());
        i += 4 + length;
    }
    let data = at + 4 + header.len();
    let end = data + 4 + u32_at(bytes, data) as usize;
    (fields, &bytes[data + 4..end], end)
}

#[test]
fn a_bag_s_index_leads_to_every_message() {
    let folder = tempfile::tempdir().expect("a folder");
    let (summary, bytes) = recorded(&folder.path().join("a.bag"));
    assert!(bytes.starts_with(b"#ROSBAG V2.0\n"));
    let (head, _, first) = bag_record(&bytes, 13);
    assert_eq!(first, 13 + 4096);
    let mut at = u64::from_le_bytes(head["index_pos"][..].try_into().expect("eight bytes")) as usize;
    let (mut topics, mut chunks) = (BTreeMap::new(), Vec::new());
    while at < bytes.len() {
        let (fields, data, next) = bag_record(&bytes, at);
        match fields["op"][0] {
            7 => {
                drop(topics.insert(u32_at(&fields["conn"], 0), String::from_utf8_lossy(&fields["topic"]).into_owned()))
            }
            6 => chunks.push((
                u64::from_le_bytes(fields["chunk_pos"][..].try_into().expect("eight bytes")) as usize,
                data.to_vec(),
            )),
            op => panic!("record {op} in the index"),
        }
        at = next;
    }
    assert_eq!(
        (topics.len() as u32, chunks.len() as u32),
        (u32_at(&head["conn_count"], 0), u32_at(&head["chunk_count"], 0))
    );
    let mut counts = BTreeMap::<String, u64>::new();
    for (position, promised) in chunks {
        let (fields, packed, mut at) = bag_record(&bytes, position);
        let mut plain = Vec::new();
        lz4_flex::frame::FrameDecoder::new(packed).read_to_end(&mut plain).expect("lz4");
        assert_eq!((fields["op"][0], plain.len()), (5, u32_at(&fields["size"], 0) as usize));
        for promise in promised.chunks(8) {
            let (index, entries, next) = bag_record(&bytes, at);
            at = next;
            assert_eq!(
                (index["op"][0], u32_at(&index["conn"], 0), u32_at(&index["count"], 0)),
                (4, u32_at(promise, 0), u32_at(promise, 4))
            );
            for entry in entries.chunks(12) {
                let (message, _, _) = bag_record(&plain, u32_at(entry, 8) as usize);
                assert_eq!(
                    (message["op"][0], &message["time"][..], &message["conn"]),
                    (2, &entry[..8], &index["conn"])
                );
                *counts.entry(topics[&u32_at(&index["conn"], 0)].clone()).or_default() += 1;
            }
        }
    }
    assert_eq!(counts["/zed2i/zed_node/left/image_rect_color"], summary.pairs);
    assert_eq!(counts["/zed2i/zed_node/right/camera_info"], summary.pairs);
}

#[test]
fn other_endings_are_refused_before_anything_is_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let error = record(&traversal(), &folder.path().join("a.avi"), &mut |_, _| ()).expect_err("no such container");
    assert!(matches!(error, RecordError::Extension(_)) && error.to_string().contains(".mcap"));
    assert_eq!(std::fs::read_dir(folder.path()).expect("a folder").count(), 0);
}
