//! The ROS 1 bag, format 2.0: lz4 chunks, an index behind each, connections and chunk infos at the end.

use super::container::Container;
use super::error::RecordError;
use super::fresh::FreshFile;
use super::messages::{Message, Topic};
use super::wire::Layout;
use lz4_flex::frame::{BlockMode, BlockSize, FrameEncoder, FrameInfo};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::Path;

const MAGIC: &[u8] = b"#ROSBAG V2.0\n";
/// The bag header's record is padded to this length.
const HEADER_BYTES: usize = 4096;
/// A chunk is closed once it holds this many bytes.
const CHUNK_BYTES: usize = 3 << 20;
const OP_MESSAGE: u8 = 2;
const OP_BAG: u8 = 3;
const OP_INDEX: u8 = 4;
const OP_CHUNK: u8 = 5;
const OP_CHUNK_INFO: u8 = 6;
const OP_CONNECTION: u8 = 7;

/// A bag in the making.
pub struct BagFile {
    file: FreshFile,
    position: u64,
    chunk: Vec<u8>,
    /// For every connection, the times and offsets of its messages in the chunk.
    index: Vec<Vec<(i64, u32)>>,
    /// The records of all connections.
    connections: Vec<u8>,
    announced: bool,
    infos: Vec<Vec<u8>>,
}

impl BagFile {
    /// Begins the recording that will be `path`, of distorted or rectified images.
    pub fn create(path: &Path, distorted: bool) -> Result<BagFile, RecordError> {
        let file = FreshFile::create(path)?;
        let index = vec![Vec::new(); Topic::ALL.len()];
        let connections = Topic::ALL.into_iter().flat_map(|topic| connection(topic, distorted)).collect();
        let (chunk, infos) = (Vec::new(), Vec::new());
        let mut bag = BagFile { file, position: 0, chunk, index, connections, announced: false, infos };
        bag.begin().map_err(|source| bag.wrong(source))?;
        Ok(bag)
    }

    fn begin(&mut self) -> io::Result<()> {
        self.file.write_all(MAGIC)?;
        self.file.write_all(&bag_header(0, 0))?;
        self.position = (MAGIC.len() + HEADER_BYTES) as u64;
        Ok(())
    }

    fn wrong(&self, source: io::Error) -> RecordError {
        RecordError::Write { path: self.file.path().to_owned(), source }
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.position += bytes.len() as u64;
        self.file.write_all(bytes)
    }

    fn close_chunk(&mut self) -> io::Result<()> {
        let used: Vec<usize> = (0..self.index.len()).filter(|&c| !self.index[c].is_empty()).collect();
        if used.is_empty() {
            return Ok(());
        }
        let chunk_position = self.position;
        let plain = std::mem::take(&mut self.chunk);
        let frame = FrameInfo::new().block_mode(BlockMode::Independent).block_size(BlockSize::Max4MB);
        let mut encoder = FrameEncoder::with_frame_info(frame, Vec::new());
        encoder.write_all(&plain)?;
        let packed = encoder.finish().map_err(io::Error::other)?;
        let size = (plain.len() as u32).to_le_bytes();
        self.write(&record(&[("op", &[OP_CHUNK]), ("compression", b"lz4"), ("size", &size)], &packed))?;
        let index = std::mem::replace(&mut self.index, vec![Vec::new(); Topic::ALL.len()]);
        let (mut counts, mut times) = (Vec::new(), Vec::new());
        for connection in used {
            let entries = &index[connection];
            let number = (connection as u32).to_le_bytes();
            let count = (entries.len() as u32).to_le_bytes();
            let version = 1_u32.to_le_bytes();
            let data: Vec<u8> =
                entries.iter().flat_map(|(t, offset)| [&time(*t)[..], &offset.to_le_bytes()].concat()).collect();
            self.write(&record(
                &[("op", &[OP_INDEX]), ("ver", &version), ("conn", &number), ("count", &count)],
                &data,
            ))?;
            counts.extend([number, count].concat());
            times.extend(entries.iter().map(|(t, _)| *t));
        }
        let (start, end) = (times.iter().min().copied().unwrap_or(0), times.iter().max().copied().unwrap_or(0));
        let connections = (counts.len() as u32 / 8).to_le_bytes();
        let fields: [(&str, &[u8]); 6] = [
            ("op", &[OP_CHUNK_INFO]),
            ("ver", &1_u32.to_le_bytes()),
            ("chunk_pos", &chunk_position.to_le_bytes()),
            ("start_time", &time(start)),
            ("end_time", &time(end)),
            ("count", &connections),
        ];
        self.infos.push(record(&fields, &counts));
        Ok(())
    }

    fn end(&mut self) -> io::Result<()> {
        self.close_chunk()?;
        let index_position = self.position;
        let connections = std::mem::take(&mut self.connections);
        self.write(&connections)?;
        let infos = std::mem::take(&mut self.infos);
        self.write(&infos.concat())?;
        self.file.seek(SeekFrom::Start(MAGIC.len() as u64))?;
        self.file.write_all(&bag_header(index_position, infos.len() as u32))?;
        self.file.seek(SeekFrom::End(0)).map(|_| ())
    }
}

impl Container for BagFile {
    fn put(&mut self, received_ns: i64, message: &Message) -> Result<(), RecordError> {
        if !self.announced {
            self.chunk.extend(&self.connections);
            self.announced = true;
        }
        let number = message.topic.number();
        self.index[number].push((received_ns, self.chunk.len() as u32));
        let fields: [(&str, &[u8]); 3] =
            [("op", &[OP_MESSAGE]), ("conn", &(number as u32).to_le_bytes()), ("time", &time(received_ns))];
        self.chunk.extend(record(&fields, &message.encode(Layout::Ros1)));
        if self.chunk.len() >= CHUNK_BYTES {
            self.close_chunk().map_err(|source| self.wrong(source))?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<FreshFile, RecordError> {
        self.end().map_err(|source| self.wrong(source))?;
        Ok(self.file)
    }
}

/// A record: length and fields of the header, length and bytes of the data.
fn record(fields: &[(&str, &[u8])], data: &[u8]) -> Vec<u8> {
    let header = fields_bytes(fields);
    let mut bytes = Vec::with_capacity(header.len() + data.len() + 8);
    bytes.extend((header.len() as u32).to_le_bytes());
    bytes.extend(header);
    bytes.extend((data.len() as u32).to_le_bytes());
    bytes.extend(data);
    bytes
}

fn fields_bytes(fields: &[(&str, &[u8])]) -> Vec<u8> {
    let field = |(name, value): &(&str, &[u8])| {
        [&((name.len() + 1 + value.len()) as u32).to_le_bytes()[..], name.as_bytes(), b"=", value].concat()
    };
    fields.iter().flat_map(field).collect()
}

fn bag_header(index_position: u64, chunks: u32) -> Vec<u8> {
    let connections = (Topic::ALL.len() as u32).to_le_bytes();
    let (position, chunks) = (index_position.to_le_bytes(), chunks.to_le_bytes());
    let fields: [(&str, &[u8]); 4] =
        [("op", &[OP_BAG]), ("index_pos", &position), ("conn_count", &connections), ("chunk_count", &chunks)];
    let padding = HEADER_BYTES - 8 - fields_bytes(&fields).len();
    record(&fields, &vec![b' '; padding])
}

fn connection(topic: Topic, distorted: bool) -> Vec<u8> {
    let definition = topic.definition();
    let (kind, text) = (definition.ros1_type(), definition.ros1_text());
    let about: [(&str, &[u8]); 4] = [
        ("topic", topic.name(distorted).as_bytes()),
        ("type", kind.as_bytes()),
        ("md5sum", definition.md5.as_bytes()),
        ("message_definition", text.as_bytes()),
    ];
    let number = (topic.number() as u32).to_le_bytes();
    record(
        &[("op", &[OP_CONNECTION]), ("conn", &number), ("topic", topic.name(distorted).as_bytes())],
        &fields_bytes(&about),
    )
}

fn time(ns: i64) -> [u8; 8] {
    let (seconds, rest) = (ns.div_euclid(1_000_000_000) as u32, ns.rem_euclid(1_000_000_000) as u32);
    let mut bytes = [0; 8];
    bytes[..4].copy_from_slice(&seconds.to_le_bytes());
    bytes[4..].copy_from_slice(&rest.to_le_bytes());
    bytes
}
