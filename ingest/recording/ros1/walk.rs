//! The walk over a bag's structure: bag header, chunks with their index data, connections, chunk infos. Nothing is
//! decompressed.

use super::record::{Connection, Fields, op};
use crate::recording::chunk::{ChunkAt, Packing};
use crate::recording::error::{COPY_OR_SALVAGE, DAMAGED, REINDEX, ReadError};
use crate::recording::file::Source;
use std::collections::{BTreeMap, BTreeSet};

/// A header has a handful of short fields.
const MOST_HEADER_BYTES: u32 = 1 << 20;

/// A chunk with what the index behind it says.
#[derive(Debug)]
pub(super) struct IndexedChunk {
    /// Where it lies.
    pub(super) at: ChunkAt,
    /// Messages by connection.
    pub(super) messages: BTreeMap<u32, u64>,
}

/// What the bag header says.
pub(super) struct BagHeader {
    /// Where the index section begins.
    pub(super) index_offset: u64,
    /// How many connections there are.
    pub(super) connections: u32,
    /// How many chunks there are.
    pub(super) chunks: u32,
}

/// A record's header and the length of its data, which must lie inside the file.
fn read_record(source: &mut Source) -> Result<(Vec<u8>, u64), ReadError> {
    let offset = source.at();
    let len = u32::from_le_bytes(source.array("a record's header length")?);
    if len > MOST_HEADER_BYTES {
        let expected = format!("a record's header of at most {MOST_HEADER_BYTES} bytes");
        return Err(ReadError::unexpected(source.path(), offset, expected, format!("{len} bytes"), DAMAGED));
    }
    let header = source.take(u64::from(len), "a record's header")?;
    let data = u64::from(u32::from_le_bytes(source.array("a record's data length")?));
    source.check(data, "a record's data")?;
    if Fields::new(&header).is_none() {
        let (expected, found) = ("fields name=value of a record", "other bytes");
        return Err(ReadError::unexpected(source.path(), offset, expected, found, DAMAGED));
    }
    Ok((header, data))
}

/// The bag header, which follows the magic.
pub(super) fn read_bag_header(source: &mut Source) -> Result<BagHeader, ReadError> {
    let offset = source.at();
    let (header, padding) = read_record(source)?;
    let fields = Fields(&header);
    let counts = (fields.u8("op"), fields.u64("index_pos"), fields.u32("conn_count"), fields.u32("chunk_count"));
    let (Some(op::BAG_HEADER), Some(index_offset), Some(connections), Some(chunks)) = counts else {
        let expected = "a bag header with index_pos, conn_count and chunk_count";
        return Err(ReadError::unexpected(source.path(), offset, expected, "a record without", DAMAGED));
    };
    if fields.get("encryptor").is_some_and(|name| !name.is_empty()) {
        let advice = "decrypt it first (`rosbag decrypt`)";
        return Err(ReadError::unexpected(
            source.path(),
            offset,
            "a bag that is not encrypted",
            "an encryptor",
            advice,
        ));
    }
    source.skip(padding, "the bag header's padding")?;
    if index_offset == 0 {
        let (expected, found) = ("an index (index_pos of the bag header)", "0: the bag is not indexed");
        return Err(ReadError::unexpected(source.path(), offset, expected, found, REINDEX));
    }
    if index_offset < source.at() || index_offset > source.len() {
        let expected = format!("the index between bytes {} and {}, where the file ends", source.at(), source.len());
        let found = format!("index_pos {index_offset}");
        return Err(ReadError::unexpected(source.path(), offset, expected, found, COPY_OR_SALVAGE));
    }
    Ok(BagHeader { index_offset, connections, chunks })
}

/// Chunks and the index data behind each, up to the index section.
pub(super) fn walk_chunks(source: &mut Source, index_offset: u64) -> Result<Vec<IndexedChunk>, ReadError> {
    let mut chunks: Vec<IndexedChunk> = Vec::new();
    while source.at() < index_offset {
        let offset = source.at();
        let (header, bytes) = read_record(source)?;
        let fields = Fields(&header);
        match (fields.u8("op"), chunks.last_mut()) {
            (Some(op::CHUNK), _) => {
                let name = fields.get("compression");
                let packing = name.and_then(Packing::from_name);
                if let (Some(name), None) = (name, packing) {
                    return Err(ReadError::unknown_compression(source.path(), offset, name, "none, bz2 and lz4"));
                }
                let (Some(packing), Some(size)) = (packing, fields.u32("size")) else {
                    let found = format!("compression {:?}", fields.text("compression").unwrap_or("missing"));
                    let expected = "a chunk with a size and compression none, bz2 or lz4";
                    return Err(ReadError::unexpected(source.path(), offset, expected, found, DAMAGED));
                };
                let uncompressed_bytes = u64::from(size);
                let at = ChunkAt { offset: source.at(), bytes, uncompressed_bytes, packing, crc: 0 };
                at.check(source.path())?;
                chunks.push(IndexedChunk { at, messages: BTreeMap::new() });
            }
            (Some(op::INDEX), Some(chunk)) => {
                let (Some(id), Some(count)) = (fields.u32("conn"), fields.u32("count")) else {
                    let expected = "index data with conn and count";
                    return Err(ReadError::unexpected(source.path(), offset, expected, "a record without", DAMAGED));
                };
                if count > 0 {
                    *chunk.messages.entry(id).or_default() += u64::from(count);
                }
            }
            (found, _) => {
                let op = found.map_or_else(|| "none".to_owned(), |op| op.to_string());
                let (expected, found) = ("a chunk or the index data behind one", format!("a record of op {op}"));
                return Err(ReadError::unexpected(source.path(), offset, expected, found, DAMAGED));
            }
        }
        source.skip(bytes, "a record's data")?;
    }
    Ok(chunks)
}

/// When the first and the last message were received, nanoseconds.
pub(super) type Span = Option<(i64, i64)>;

/// The index section: connections, and the times of the first and the last message by the chunk infos.
pub(super) fn read_index(source: &mut Source, header: &BagHeader) -> Result<(Vec<Connection>, Span), ReadError> {
    source.seek(header.index_offset, "the index")?;
    let (mut connections, mut ids, mut infos, mut span_ns) = (Vec::new(), BTreeSet::new(), 0_u64, Span::None);
    while source.at() < source.len() {
        let offset = source.at();
        let (record_header, bytes) = read_record(source)?;
        let fields = Fields(&record_header);
        let data = source.take(bytes, "a record's data")?;
        let damaged =
            |expected: &str| ReadError::unexpected(source.path(), offset, expected, "another record", DAMAGED);
        match fields.u8("op") {
            Some(op::CONNECTION) => {
                let connection = Connection::read(&fields, &data);
                let connection = connection.ok_or_else(|| damaged("a connection with conn, topic and type"))?;
                if ids.insert(connection.id) {
                    connections.push(connection);
                }
            }
            Some(op::CHUNK_INFO) => {
                let start_ns = fields.time_ns("start_time").ok_or_else(|| damaged("chunk info with start_time"))?;
                infos += 1;
                let holds_messages = fields.u32("count").is_some_and(|connections| connections > 0);
                if holds_messages {
                    let end_ns = fields.time_ns("end_time").unwrap_or(start_ns);
                    let (first_ns, last_ns) = span_ns.unwrap_or((start_ns, end_ns));
                    span_ns = Some((first_ns.min(start_ns), last_ns.max(end_ns)));
                }
            }
            _ => return Err(damaged("a connection or chunk info in the index")),
        }
    }
    let complete = (connections.len() as u64, infos) == (u64::from(header.connections), u64::from(header.chunks));
    if !complete {
        let expected = format!("an index of {} connections and {} chunks", header.connections, header.chunks);
        let found = format!("{} and {infos}", connections.len());
        return Err(ReadError::unexpected(source.path(), source.at(), expected, found, COPY_OR_SALVAGE));
    }
    Ok((connections, span_ns))
}
