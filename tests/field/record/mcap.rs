//! The MCAP container: profile ros2, CDR messages, zstd chunks, CRCs and a full index.

use super::container::Container;
use super::error::RecordError;
use super::fresh::FreshFile;
use super::messages::{Message, Topic};
use super::wire::Layout;
use mcap::records::MessageHeader;
use mcap::{Compression, McapError, WriteOptions, Writer};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// An MCAP file in the making.
pub struct McapFile {
    writer: Writer<FreshFile>,
    channels: Vec<u16>,
    path: PathBuf,
}

impl McapFile {
    /// Begins the recording that will be `path`, of distorted or rectified images.
    pub fn create(path: &Path, distorted: bool) -> Result<McapFile, RecordError> {
        let wrong = |source| RecordError::Mcap { path: path.to_owned(), source };
        // One compression thread and a fixed library name: the bytes depend on the messages alone.
        let mut options = WriteOptions::new().compression(Some(Compression::Zstd)).compression_level(1);
        options = options.compression_threads(0).profile("ros2").library("furrow-field").chunk_size(Some(4 << 20));
        let mut writer = options.create(FreshFile::create(path)?).map_err(wrong)?;
        let mut channels = Vec::new();
        for topic in Topic::ALL {
            let definition = topic.definition();
            let schema = writer
                .add_schema(&definition.ros2_type(), "ros2msg", definition.ros2_text().as_bytes())
                .map_err(wrong)?;
            channels.push(writer.add_channel(schema, topic.name(distorted), "cdr", &BTreeMap::new()).map_err(wrong)?);
        }
        Ok(McapFile { writer, channels, path: path.to_owned() })
    }

    fn wrong(&self) -> impl Fn(McapError) -> RecordError + use<> {
        let path = self.path.clone();
        move |source| RecordError::Mcap { path: path.clone(), source }
    }
}

impl Container for McapFile {
    fn put(&mut self, received_ns: i64, message: &Message) -> Result<(), RecordError> {
        let header = MessageHeader {
            channel_id: self.channels[message.topic.number()],
            sequence: message.sequence,
            log_time: received_ns as u64,
            publish_time: message.stamp_ns as u64,
        };
        let wrong = self.wrong();
        self.writer.write_to_known_channel(&header, &message.encode(Layout::Cdr)).map_err(wrong)
    }

    fn finish(mut self: Box<Self>) -> Result<FreshFile, RecordError> {
        let wrong = self.wrong();
        self.writer.finish().map_err(wrong)?;
        Ok(self.writer.into_inner())
    }
}
