//! ROS1 bags, format 2.0: the walk over a bag's structure, and its chunks.

use super::block::{Block, Blocks, DecodeChunk, Entry, ReadAhead};
use super::chunk::{ChunkAt, Packing};
use super::error::{COPY_OR_SALVAGE, DAMAGED, ReadError};
use super::file::Source;
use super::ros1_record::{Connection, Fields, counted, op};
use super::topic::{self, Encoding, Topic};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// The first bytes of a bag.
pub(crate) const MAGIC: &[u8] = b"#ROSBAG V2.0\n";
/// A header has a handful of short fields.
const MOST_HEADER_BYTES: u32 = 1 << 20;

/// A bag whose structure was found sound.
#[derive(Debug)]
pub(crate) struct Bag {
    path: PathBuf,
    pub(crate) bytes: u64,
    pub(crate) first_ns: Option<i64>,
    pub(crate) topics: Vec<Topic>,
    /// Topic of each connection.
    connections: BTreeMap<u32, usize>,
    chunks: Vec<IndexedChunk>,
}

#[derive(Debug)]
struct IndexedChunk {
    at: ChunkAt,
    /// Messages by connection, as the index behind the chunk says.
    messages: BTreeMap<u32, u64>,
}

struct BagHeader {
    index_offset: u64,
    connections: u32,
    chunks: u32,
}

impl Bag {
    /// Walks the bag: header, chunks with their indices, connections, chunk summaries. Nothing is decompressed.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let mut source = Source::open(path)?;
        source.skip(MAGIC.len() as u64, "the bag's first line")?;
        let header = bag_header(&mut source)?;
        let chunks = chunks(&mut source, header.index_offset)?;
        let (connections, first_ns) = index(&mut source, &header)?;
        if chunks.len() as u64 != u64::from(header.chunks) {
            let (expected, found) = (format!("{} chunks", header.chunks), format!("{}", chunks.len()));
            return Err(ReadError::bad(path, source.at(), expected, found, DAMAGED));
        }
        let mut bag = Bag {
            path: path.to_owned(),
            bytes: source.len(),
            first_ns,
            topics: Vec::new(),
            connections: BTreeMap::new(),
            chunks,
        };
        for connection in connections {
            let place = topic::place(&mut bag.topics, &connection.topic, &connection.type_name, Encoding::Ros1);
            bag.connections.insert(connection.id, place);
        }
        for chunk in &bag.chunks {
            for (id, messages) in &chunk.messages {
                let Some(&place) = bag.connections.get(id) else {
                    return Err(unknown_connection(path, chunk.at.offset, *id));
                };
                topic::count(&mut bag.topics[place], Some(*messages));
            }
        }
        Ok(bag)
    }

    /// The messages of the topics that are `wanted`; chunks without any are passed over.
    pub(crate) fn blocks(&self, wanted: &[bool]) -> Result<Box<dyn Blocks>, ReadError> {
        let want = |id: &u32| self.connections.get(id).is_some_and(|&place| wanted[place]);
        let connections = self.connections.iter().map(|(&id, &place)| (id, wanted[place].then_some(place))).collect();
        // A chunk without index data is decoded too, so that messages that the index leaves out are an error rather than lost.
        let useful = |chunk: &&IndexedChunk| chunk.messages.is_empty() || chunk.messages.keys().any(want);
        let chunks: Vec<&IndexedChunk> = self.chunks.iter().filter(useful).collect();
        let counts = chunks.iter().map(|chunk| (chunk.at.offset, chunk.messages.clone())).collect();
        let decoder = ChunkDecoder { path: self.path.clone(), connections, counts };
        let chunks = chunks.into_iter().map(|chunk| chunk.at.clone()).collect();
        Ok(Box::new(ReadAhead::new(Source::open(&self.path)?, chunks, decoder)))
    }
}

/// A record's header and the length of its data, which must lie inside the file.
fn record(source: &mut Source) -> Result<(Vec<u8>, u64), ReadError> {
    let offset = source.at();
    let len = u32::from_le_bytes(source.array("a record's header length")?);
    if len > MOST_HEADER_BYTES {
        let expected = format!("a record's header of at most {MOST_HEADER_BYTES} bytes");
        return Err(ReadError::bad(source.path(), offset, expected, format!("{len} bytes"), DAMAGED));
    }
    let header = source.take(u64::from(len), "a record's header")?;
    let data = u64::from(u32::from_le_bytes(source.array("a record's data length")?));
    source.check(data, "a record's data")?;
    if Fields::new(&header).is_none() {
        return Err(ReadError::bad(source.path(), offset, "fields name=value of a record", "other bytes", DAMAGED));
    }
    Ok((header, data))
}

fn bag_header(source: &mut Source) -> Result<BagHeader, ReadError> {
    let offset = source.at();
    let (header, padding) = record(source)?;
    let fields = Fields(&header);
    let counts = (fields.u8("op"), fields.u64("index_pos"), fields.u32("conn_count"), fields.u32("chunk_count"));
    let (Some(op::BAG_HEADER), Some(index_offset), Some(connections), Some(chunks)) = counts else {
        let expected = "a bag header with index_pos, conn_count and chunk_count";
        return Err(ReadError::bad(source.path(), offset, expected, "a record without", DAMAGED));
    };
    if fields.get("encryptor").is_some_and(|name| !name.is_empty()) {
        let advice = "decrypt it first (`rosbag decrypt`)";
        return Err(ReadError::bad(source.path(), offset, "a bag that is not encrypted", "an encryptor", advice));
    }
    source.skip(padding, "the bag header's padding")?;
    if index_offset == 0 {
        let (expected, found) = ("an index (index_pos of the bag header)", "0: the bag is not indexed");
        return Err(ReadError::bad(source.path(), offset, expected, found, COPY_OR_SALVAGE));
    }
    if index_offset < source.at() || index_offset > source.len() {
        let expected = format!("the index between bytes {} and {}, where the file ends", source.at(), source.len());
        let found = format!("index_pos {index_offset}");
        return Err(ReadError::bad(source.path(), offset, expected, found, COPY_OR_SALVAGE));
    }
    Ok(BagHeader { index_offset, connections, chunks })
}

fn chunks(source: &mut Source, index_offset: u64) -> Result<Vec<IndexedChunk>, ReadError> {
    let mut chunks: Vec<IndexedChunk> = Vec::new();
    while source.at() < index_offset {
        let offset = source.at();
        let (header, bytes) = record(source)?;
        let fields = Fields(&header);
        match (fields.u8("op"), chunks.last_mut()) {
            (Some(op::CHUNK), _) => {
                let packing = fields.get("compression").and_then(Packing::named);
                let (Some(packing), Some(size)) = (packing, fields.u32("size")) else {
                    let found = format!("{:?}", fields.text("compression"));
                    let expected = "a chunk with a size and compression none, bz2 or lz4";
                    return Err(ReadError::bad(source.path(), offset, expected, found, DAMAGED));
                };
                let uncompressed_bytes = u64::from(size);
                let at = ChunkAt { offset: source.at(), bytes, uncompressed_bytes, packing, crc: 0 };
                at.check(source.path())?;
                chunks.push(IndexedChunk { at, messages: BTreeMap::new() });
            }
            (Some(op::INDEX), Some(chunk)) => {
                let (Some(id), Some(count)) = (fields.u32("conn"), fields.u32("count")) else {
                    let expected = "index data with conn and count";
                    return Err(ReadError::bad(source.path(), offset, expected, "a record without", DAMAGED));
                };
                if count > 0 {
                    *chunk.messages.entry(id).or_default() += u64::from(count);
                }
            }
            (found, _) => {
                let (expected, found) = ("a chunk or the index data behind one", format!("a record of op {found:?}"));
                return Err(ReadError::bad(source.path(), offset, expected, found, DAMAGED));
            }
        }
        source.skip(bytes, "a record's data")?;
    }
    Ok(chunks)
}

fn index(source: &mut Source, header: &BagHeader) -> Result<(Vec<Connection>, Option<i64>), ReadError> {
    source.seek(header.index_offset, "the index")?;
    let (mut connections, mut ids, mut summaries, mut first_ns) = (Vec::new(), BTreeSet::new(), 0_u64, None::<i64>);
    while source.at() < source.len() {
        let offset = source.at();
        let (record_header, bytes) = record(source)?;
        let fields = Fields(&record_header);
        let data = source.take(bytes, "a record's data")?;
        let bad = |expected: &str| ReadError::bad(source.path(), offset, expected, "another record", DAMAGED);
        match fields.u8("op") {
            Some(op::CONNECTION) => {
                let connection = Connection::read(&fields, &data);
                let connection = connection.ok_or_else(|| bad("a connection with conn, topic and type"))?;
                if ids.insert(connection.id) {
                    connections.push(connection);
                }
            }
            Some(op::CHUNK_INFO) => {
                let start_ns = fields.time_ns("start_time").ok_or_else(|| bad("chunk info with start_time"))?;
                summaries += 1;
                let holds_messages = fields.u32("count").is_some_and(|connections| connections > 0);
                if holds_messages {
                    first_ns = Some(first_ns.map_or(start_ns, |first| first.min(start_ns)));
                }
            }
            _ => return Err(bad("a connection or chunk info in the index")),
        }
    }
    let complete = (connections.len() as u64, summaries) == (u64::from(header.connections), u64::from(header.chunks));
    if !complete {
        let expected = format!("an index of {} connections and {} chunks", header.connections, header.chunks);
        let found = format!("{} and {summaries}", connections.len());
        return Err(ReadError::bad(source.path(), source.at(), expected, found, COPY_OR_SALVAGE));
    }
    Ok((connections, first_ns))
}

fn unknown_connection(path: &Path, offset: u64, id: u32) -> ReadError {
    let found = format!("connection {id}");
    ReadError::bad(path, offset, "a chunk of connections that the index names", found, DAMAGED)
}

struct ChunkDecoder {
    path: PathBuf,
    /// The topic of each connection, `None` where it is not wanted.
    connections: BTreeMap<u32, Option<usize>>,
    /// Messages by connection, by the chunk's offset.
    counts: BTreeMap<u64, BTreeMap<u32, u64>>,
}

impl DecodeChunk for ChunkDecoder {
    fn decode(&self, at: &ChunkAt, packed: Vec<u8>) -> Result<Block, ReadError> {
        let bad = |expected: String, found: String| ReadError::bad(&self.path, at.offset, expected, found, DAMAGED);
        let bytes = at.unpack(&self.path, packed)?;
        let (mut entries, mut counts, mut rest) = (Vec::new(), BTreeMap::<u32, u64>::new(), &bytes[..]);
        while !rest.is_empty() {
            let start = bytes.len() - rest.len();
            let inside = || bad(format!("a whole record {start} bytes into a chunk"), "one that is not".to_owned());
            let (header, after) = counted(rest).ok_or_else(inside)?;
            let (data, after) = counted(after).ok_or_else(inside)?;
            let fields = Fields::new(header).ok_or_else(inside)?;
            rest = after;
            match fields.u8("op") {
                Some(op::MESSAGE) => {
                    let (id, receive_ns) = fields.u32("conn").zip(fields.time_ns("time")).ok_or_else(inside)?;
                    *counts.entry(id).or_default() += 1;
                    let topic = self.connections.get(&id).copied();
                    let Some(topic) = topic.ok_or_else(|| unknown_connection(&self.path, at.offset, id))? else {
                        continue;
                    };
                    let end = bytes.len() - rest.len();
                    entries.push(Entry { topic, receive_ns, bytes: end - data.len()..end });
                }
                Some(op::CONNECTION) => {}
                _ => return Err(inside()),
            }
        }
        if self.counts.get(&at.offset).is_some_and(|index| *index != counts) {
            let expected = format!("{:?} messages by connection, as the chunk's index says", self.counts[&at.offset]);
            return Err(bad(expected, format!("{counts:?}")));
        }
        Ok(Block::in_order(bytes, entries))
    }
}
