//! Reading recordings: real ones of other tools, ones written here, and damaged ones.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

#[path = "../../../tests/support/golden_data.rs"]
mod golden_data;

mod bag_writer;
mod damage;
mod fixtures;
mod libraries;
mod memory;
mod messages;
mod oracles;
mod pairs;
mod sensor_parts;
mod stereo_recording;
mod stereo_topics;
mod threads;
mod whole_ingests;
mod written;

use furrow_ingest::recording::{Encoding, ReadError, Recording};
use std::ops::ControlFlow;

/// A message as compared: topic, receive time, bytes.
type Message = (String, i64, Vec<u8>);

/// All messages of a recording, or those before its first error.
fn messages_of(recording: &Recording) -> (Vec<Message>, Option<ReadError>) {
    let mut messages = Vec::new();
    let error = each_message(recording, &mut |topic, ns, bytes| messages.push((topic.to_owned(), ns, bytes.to_vec())));
    (messages, error)
}

/// Hands over every message that can be decoded; returns the error that ended reading.
fn each_message(recording: &Recording, each: &mut dyn FnMut(&str, i64, &[u8])) -> Option<ReadError> {
    let known = recording.topics().iter().filter(|topic| topic.encoding != Encoding::Unknown);
    let names: Vec<&str> = known.map(|topic| topic.name.as_str()).collect();
    let mut last = 0;
    let mut progress = |progress: furrow_ingest::recording::Progress| {
        assert!(
            progress.bytes_read >= last && progress.bytes_read <= progress.bytes_total,
            "{progress:?} after {last}"
        );
        last = progress.bytes_read;
    };
    let read = recording.read::<()>(&names, &mut progress, &mut |message| {
        each(&message.topic.name, message.receive_ns, message.bytes);
        ControlFlow::Continue(())
    });
    read.err()
}
