//! A writer of small ROS1 bags, from the format's description, to damage and to split.

use std::io::Write;

/// A field of a record's header.
fn field(name: &str, value: &[u8]) -> Vec<u8> {
    let mut field = (name.len() as u32 + 1 + value.len() as u32).to_le_bytes().to_vec();
    field.extend_from_slice(name.as_bytes());
    field.push(b'=');
    field.extend_from_slice(value);
    field
}

fn record(header: &[(&str, &[u8])], data: &[u8]) -> Vec<u8> {
    let header: Vec<u8> = header.iter().flat_map(|(name, value)| field(name, value)).collect();
    let mut record = (header.len() as u32).to_le_bytes().to_vec();
    record.extend_from_slice(&header);
    record.extend_from_slice(&(data.len() as u32).to_le_bytes());
    record.extend_from_slice(data);
    record
}

fn time(ns: i64) -> [u8; 8] {
    let (seconds, rest) = ((ns / 1_000_000_000) as u32, (ns % 1_000_000_000) as u32);
    let mut bytes = [0; 8];
    bytes[..4].copy_from_slice(&seconds.to_le_bytes());
    bytes[4..].copy_from_slice(&rest.to_le_bytes());
    bytes
}

/// How its chunks are packed: `none`, `bz2` or `lz4`.
fn pack(compression: &str, data: &[u8]) -> Vec<u8> {
    match compression {
        "bz2" => {
            let mut packer = bzip2::write::BzEncoder::new(Vec::new(), bzip2::Compression::best());
            packer.write_all(data).unwrap();
            packer.finish().unwrap()
        }
        "lz4" => {
            let mut packer = lz4_flex::frame::FrameEncoder::new(Vec::new());
            packer.write_all(data).unwrap();
            packer.finish().unwrap()
        }
        _ => data.to_vec(),
    }
}

/// A bag of these messages (topic, time, data), some to a chunk; every topic is a `std_msgs/String`.
pub fn bag(compression: &str, per_chunk: usize, messages: &[crate::Message]) -> Vec<u8> {
    let mut topics: Vec<&str> = messages.iter().map(|(topic, ..)| topic.as_str()).collect();
    topics.sort_unstable();
    topics.dedup();
    let id = |topic: &str| (topics.iter().position(|known| *known == topic).unwrap() as u32).to_le_bytes();
    let connection = |topic: &str| {
        let kind = [field("type", b"std_msgs/String"), field("md5sum", b"992ce8a1687cec8c8bd883ec73ca41d1")].concat();
        let data = [field("topic", topic.as_bytes()), kind, field("message_definition", b"string data\n")].concat();
        record(&[("op", &[7]), ("conn", &id(topic)), ("topic", topic.as_bytes())], &data)
    };
    let (mut body, mut infos) = (Vec::new(), Vec::new());
    let header_bytes = 4096;
    let start = 13 + header_bytes;
    for chunk in messages.chunks(per_chunk) {
        let data: Vec<u8> = chunk
            .iter()
            .flat_map(|(topic, ns, data)| {
                [connection(topic), record(&[("op", &[2]), ("conn", &id(topic)), ("time", &time(*ns))], data)].concat()
            })
            .collect();
        let (first, last) = (chunk.iter().map(|m| m.1).min().unwrap(), chunk.iter().map(|m| m.1).max().unwrap());
        let at = (start + body.len()) as u64;
        let size = (data.len() as u32).to_le_bytes();
        body.extend(record(
            &[("op", &[5]), ("compression", compression.as_bytes()), ("size", &size)],
            &pack(compression, &data),
        ));
        let mut counts = Vec::new();
        for topic in &topics {
            let times: Vec<i64> = chunk.iter().filter(|message| message.0 == *topic).map(|message| message.1).collect();
            if times.is_empty() {
                continue;
            }
            let entries: Vec<u8> = times.iter().flat_map(|ns| [&time(*ns)[..], &[0; 4]].concat()).collect();
            let count = (times.len() as u32).to_le_bytes();
            let ver = 1_u32.to_le_bytes();
            body.extend(record(&[("op", &[4]), ("ver", &ver), ("conn", &id(topic)), ("count", &count)], &entries));
            counts.extend([id(topic), count].concat());
        }
        let info = [
            ("op", &[6][..]),
            ("ver", &1_u32.to_le_bytes()),
            ("chunk_pos", &at.to_le_bytes()),
            ("start_time", &time(first)),
            ("end_time", &time(last)),
            ("count", &(counts.len() as u32 / 8).to_le_bytes()),
        ];
        infos.push(record(&info, &counts));
    }
    let index = ((start + body.len()) as u64).to_le_bytes();
    let (connections, chunks) = ((topics.len() as u32).to_le_bytes(), (infos.len() as u32).to_le_bytes());
    let header = [("op", &[3][..]), ("index_pos", &index), ("conn_count", &connections), ("chunk_count", &chunks)];
    let bare = record(&header, &[]).len();
    let mut bag = b"#ROSBAG V2.0\n".to_vec();
    bag.extend(record(&header, &vec![b' '; header_bytes - bare]));
    bag.extend(body);
    bag.extend(topics.iter().flat_map(|topic| connection(topic)));
    bag.extend(infos.concat());
    bag
}
