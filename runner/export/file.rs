//! A recording that is written message by message. Channels come into being with their first message.

use super::message;
use crate::RunError;
use foxglove::Encode;
use mcap::records::{MessageHeader, Metadata};
use mcap::{Compression, WriteOptions, Writer};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;

/// A recording in the making.
pub(super) struct Recording<'a> {
    writer: Writer<BufWriter<&'a mut File>>,
    channels: BTreeMap<String, Channel>,
    buffer: Vec<u8>,
}

struct Channel {
    id: u16,
    messages: u32,
}

/// Uncompressed bytes of a chunk: what a reader holds to find one message.
const CHUNK: u64 = 4 << 20;

impl<'a> Recording<'a> {
    /// Begins a recording at the file's start.
    pub fn begin(file: &'a mut File, furrow_version: &str) -> Result<Self, RunError> {
        let options = WriteOptions::new()
            .compression(Some(Compression::Zstd))
            // As many threads as the machine has would give other bytes than one alone.
            .compression_threads(0)
            .chunk_size(Some(CHUNK))
            .library(format!("furrow {furrow_version}"));
        let writer = options.create(BufWriter::new(file)).map_err(refused)?;
        Ok(Self { writer, channels: BTreeMap::new(), buffer: Vec::new() })
    }

    /// What the recording is about and comes from.
    pub fn lineage(&mut self, name: &str, metadata: BTreeMap<String, String>) -> Result<(), RunError> {
        self.writer.write_metadata(&Metadata { name: name.to_owned(), metadata }).map_err(refused)
    }

    /// Adds a message; stamps are never falling.
    pub fn put<M: Encode>(&mut self, topic: &str, stamp_ns: i64, message: &M) -> Result<(), RunError> {
        let (id, sequence) = self.next::<M>(topic)?;
        self.buffer.clear();
        message.encode(&mut self.buffer).map_err(|error| RunError::Recording(format!("{topic}: {error}")))?;
        let time = message::stamp(stamp_ns)?.total_nanos();
        let header = MessageHeader { channel_id: id, sequence, log_time: time, publish_time: time };
        self.writer.write_to_known_channel(&header, &self.buffer).map_err(refused)
    }

    /// The topic's channel and the number of its next message.
    fn next<M: Encode>(&mut self, topic: &str) -> Result<(u16, u32), RunError> {
        if let Some(channel) = self.channels.get_mut(topic) {
            channel.messages += 1;
            return Ok((channel.id, channel.messages - 1));
        }
        let schema = M::get_schema().ok_or_else(|| RunError::Recording(format!("{topic} has no schema")))?;
        let schema = self.writer.add_schema(&schema.name, &schema.encoding, &schema.data).map_err(refused)?;
        let encoding = M::get_message_encoding();
        let id = self.writer.add_channel(schema, topic, &encoding, &BTreeMap::new()).map_err(refused)?;
        self.channels.insert(topic.to_owned(), Channel { id, messages: 1 });
        Ok((id, 0))
    }

    /// Ends the recording; how many messages each topic has.
    pub fn finish(mut self) -> Result<BTreeMap<String, u64>, RunError> {
        self.writer.finish().map_err(refused)?;
        Ok(self.channels.into_iter().map(|(topic, channel)| (topic, u64::from(channel.messages))).collect())
    }
}

fn refused(error: mcap::McapError) -> RunError {
    RunError::Recording(error.to_string())
}
