//! A bag: its topics, and the chunks that its messages are read from.

use super::decode::{ChunkDecoder, unknown_connection};
use super::walk::{IndexedChunk, read_bag_header, read_index, walk_chunks};
use crate::recording::container::{Blocks, Container};
use crate::recording::error::{DAMAGED, ReadError};
use crate::recording::file::{SharedFile, Source};
use crate::recording::read_ahead::ReadAhead;
use crate::recording::topic::{self, Encoding, Topic};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The first bytes of a bag.
pub(crate) const MAGIC: &[u8] = b"#ROSBAG V2.0\n";

/// A bag whose structure was found sound.
#[derive(Debug)]
pub(crate) struct Bag {
    path: PathBuf,
    bytes: u64,
    /// When its first and last message were received, nanoseconds.
    span_ns: Option<(i64, i64)>,
    topics: Vec<Topic>,
    /// The topic of each connection.
    connections: BTreeMap<u32, usize>,
    chunks: Vec<IndexedChunk>,
}

impl Bag {
    /// Walks the bag: header, chunks with their indices, connections, chunk summaries. Nothing is decompressed.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let mut source = Source::open(path)?;
        source.skip(MAGIC.len() as u64, "the bag's first line")?;
        let header = read_bag_header(&mut source)?;
        let chunks = walk_chunks(&mut source, header.index_offset)?;
        let (connections, span_ns) = read_index(&mut source, &header)?;
        if chunks.len() as u64 != u64::from(header.chunks) {
            let (expected, found) = (format!("{} chunks", header.chunks), format!("{} chunks", chunks.len()));
            return Err(ReadError::unexpected(path, source.at(), expected, found, DAMAGED));
        }
        let mut bag = Bag {
            path: path.to_owned(),
            bytes: source.len(),
            span_ns,
            topics: Vec::new(),
            connections: BTreeMap::new(),
            chunks,
        };
        for connection in connections {
            let place = topic::find_or_add(&mut bag.topics, &connection.topic, &connection.type_name, Encoding::Ros1);
            bag.connections.insert(connection.id, place);
        }
        for chunk in &bag.chunks {
            for (id, messages) in &chunk.messages {
                let Some(&place) = bag.connections.get(id) else {
                    return Err(unknown_connection(path, chunk.at.offset, *id));
                };
                topic::add_messages(&mut bag.topics[place], Some(*messages));
            }
        }
        Ok(bag)
    }
}

impl Container for Bag {
    fn topics(&self) -> &[Topic] {
        &self.topics
    }

    fn bytes(&self) -> u64 {
        self.bytes
    }

    fn first_ns(&self) -> Option<i64> {
        self.span_ns.map(|span| span.0)
    }

    fn last_ns(&self) -> Option<i64> {
        self.span_ns.map(|span| span.1)
    }

    /// Chunks without any wanted message are passed over.
    fn blocks(&self, wanted: &[bool]) -> Result<Box<dyn Blocks>, ReadError> {
        let want = |id: &u32| self.connections.get(id).is_some_and(|&place| wanted[place]);
        let connections = self.connections.iter().map(|(&id, &place)| (id, wanted[place].then_some(place))).collect();
        // A chunk without index data is decoded too: messages that its index lacks are an error rather than lost.
        let is_useful = |chunk: &&IndexedChunk| chunk.messages.is_empty() || chunk.messages.keys().any(want);
        let chunks: Vec<&IndexedChunk> = self.chunks.iter().filter(is_useful).collect();
        let counts = chunks.iter().map(|chunk| (chunk.at.offset, chunk.messages.clone())).collect();
        let decoder = ChunkDecoder { path: self.path.clone(), connections, counts };
        let chunks = chunks.into_iter().map(|chunk| chunk.at.clone()).collect();
        Ok(Box::new(ReadAhead::new(SharedFile::open(&self.path)?, chunks, decoder)))
    }
}
