//! A small stereo recording, written from the messages' definitions, to split and to tell otherwise.

use std::collections::BTreeMap;
use std::path::Path;

/// Columns, rows, focal length in px and baseline in metres of its rig.
pub const SIZE: [u32; 2] = [64, 48];
pub const FOCAL_PX: f64 = 60.0;
pub const BASELINE_M: f64 = 0.12;

/// From frame to frame, nanoseconds.
const PERIOD_NS: i64 = 100_000_000;

/// A message: topic, type, stamp, bytes in ROS1's form.
pub type Sent = (String, &'static str, i64, Vec<u8>);

/// All messages of `frames` stereo pairs in order of time, with the right camera's P[3] in `p3`; CameraInfos with every
/// pair, or with the first only.
pub fn messages(frames: u8, p3: f64, infos_at_first_only: bool) -> Vec<Sent> {
    let mut sent = Vec::new();
    for frame in 0..frames {
        let stamp_ns = 1_700_000_000_000_000_000 + i64::from(frame) * PERIOD_NS;
        for (side, p3) in [("left", 0.0), ("right", p3)] {
            if frame == 0 || !infos_at_first_only {
                let info = camera_info(stamp_ns, p3);
                sent.push((format!("/stereo/{side}/camera_info"), "sensor_msgs/CameraInfo", stamp_ns, info));
            }
            let seed = usize::from(frame) * 2 + usize::from(side == "right");
            sent.push((format!("/stereo/{side}/image_rect"), "sensor_msgs/Image", stamp_ns, image(stamp_ns, seed)));
        }
    }
    sent
}

/// Writes messages as an MCAP file.
pub fn write(path: &Path, messages: &[Sent]) {
    let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    let mut writer = mcap::WriteOptions::new().profile("ros1").create(file).unwrap();
    let mut channels: BTreeMap<&str, u16> = BTreeMap::new();
    for (topic, kind, ns, data) in messages {
        let id = *channels.entry(topic).or_insert_with(|| {
            let schema = writer.add_schema(kind, "ros1msg", b"").unwrap();
            writer.add_channel(schema, topic, "ros1", &BTreeMap::new()).unwrap()
        });
        let time = ns.cast_unsigned();
        let header = mcap::records::MessageHeader { channel_id: id, sequence: 0, log_time: time, publish_time: time };
        writer.write_to_known_channel(&header, data).unwrap();
    }
    writer.finish().unwrap();
}

fn header(stamp_ns: i64) -> Vec<u8> {
    let (seconds, rest) = ((stamp_ns / 1_000_000_000) as u32, (stamp_ns % 1_000_000_000) as u32);
    let sequence_and_stamp = [[0; 4], seconds.to_le_bytes(), rest.to_le_bytes()].concat();
    [sequence_and_stamp, text("rig")].concat()
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

fn image(stamp_ns: i64, seed: usize) -> Vec<u8> {
    let [width, height] = SIZE;
    let pixels: Vec<u8> =
        (0..(width * height) as usize).map(|i| ((i * 7 + i / 64 * 13 + seed * 29) % 251) as u8).collect();
    [
        header(stamp_ns),
        [height.to_le_bytes(), width.to_le_bytes()].concat(),
        text("mono8"),
        vec![0],
        [width.to_le_bytes(), (pixels.len() as u32).to_le_bytes()].concat(),
        pixels,
    ]
    .concat()
}

fn camera_info(stamp_ns: i64, p3: f64) -> Vec<u8> {
    let [width, height] = SIZE;
    let (f, cx, cy) = (FOCAL_PX, 31.5, 23.5);
    let k = [f, 0.0, cx, 0.0, f, cy, 0.0, 0.0, 1.0];
    let r = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let p = [f, 0.0, cx, p3, 0.0, f, cy, 0.0, 0.0, 0.0, 1.0, 0.0];
    let numbers = k.iter().chain(&r).chain(&p).flat_map(|value: &f64| value.to_le_bytes()).collect::<Vec<u8>>();
    let sizes = [height.to_le_bytes(), width.to_le_bytes()].concat();
    // No coefficients; binning and region of interest as drivers leave them.
    [header(stamp_ns), sizes, text("plumb_bob"), vec![0; 4], numbers, vec![0; 4 * 6 + 1]].concat()
}
