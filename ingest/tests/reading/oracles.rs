//! Our walks against the crates that others read with.

use crate::golden_data::{data, files_below};
use crate::messages_of;
use furrow_ingest::recording::open;
use std::collections::BTreeMap;

/// Messages by topic and time, without regard to the order of equal times.
fn sorted(mut messages: Vec<crate::Message>) -> Vec<crate::Message> {
    messages.sort();
    messages
}

#[test]
fn sound_bags_read_as_the_rosbag_crate_reads_them() {
    let Some(folder) = data() else { return };
    for path in files_below(&folder).iter().filter(|path| path.extension().is_some_and(|kind| kind == "bag")) {
        let Ok(recording) = open(path) else { continue };
        let (ours, None) = messages_of(&recording) else { continue };
        // The crate reads what it maps without checks; the files that come here were found sound.
        let bag = rosbag::RosBag::new(path).unwrap();
        let mut topics = BTreeMap::new();
        for record in bag.index_records() {
            if let rosbag::IndexRecord::Connection(connection) = record.unwrap() {
                topics.insert(connection.id, connection.topic.to_owned());
            }
        }
        let mut theirs = Vec::new();
        for record in bag.chunk_records() {
            let rosbag::ChunkRecord::Chunk(chunk) = record.unwrap() else { continue };
            for message in chunk.messages() {
                if let rosbag::MessageRecord::MessageData(message) = message.unwrap() {
                    theirs.push((topics[&message.conn_id].clone(), message.time as i64, message.data.to_vec()));
                }
            }
        }
        assert_eq!(ours.len(), theirs.len(), "{}", path.display());
        assert!(sorted(ours) == sorted(theirs), "{}", path.display());
    }
}

#[test]
fn sound_mcap_files_read_as_the_mcap_crate_reads_them() {
    let Some(folder) = data() else { return };
    for path in files_below(&folder).iter().filter(|path| path.extension().is_some_and(|kind| kind == "mcap")) {
        let Ok(recording) = open(path) else { continue };
        let (ours, None) = messages_of(&recording) else { continue };
        let bytes = std::fs::read(path).unwrap();
        let stream = mcap::MessageStream::new(&bytes).unwrap();
        let theirs = stream.map(|message| {
            let message = message.unwrap();
            (message.channel.topic.clone(), message.log_time as i64, message.data.to_vec())
        });
        assert!(sorted(ours) == sorted(theirs.collect()), "{}", path.display());
    }
}
