//! MCAP files: the walk over a file's structure, and its chunks.

use super::block::{Block, Blocks, DecodeChunk, Entry, ReadAhead};
use super::chunk::{ChunkAt, MOST_CHUNK_BYTES, Packing, unpack_message};
use super::error::{COPY_OR_SALVAGE, DAMAGED, ReadError};
use super::file::Source;
use super::mcap_record::{Channels, MessageHead, RECORD_HEADER_BYTES, header, records};
use super::topic::{self, Encoding, Topic};
use mcap::records::{Record, op};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The first and last bytes of a file.
pub(crate) const MAGIC: &[u8] = mcap::MAGIC;
/// Messages outside chunks are read in runs of about this length.
const RUN_BYTES: u64 = 1 << 22;

/// A file whose structure was found sound.
#[derive(Debug)]
pub(crate) struct Mcap {
    path: PathBuf,
    pub(crate) bytes: u64,
    pub(crate) first_ns: Option<i64>,
    pub(crate) topics: Vec<Topic>,
    /// Topic of each channel.
    channels: BTreeMap<u16, usize>,
    chunks: Vec<ChunkAt>,
}

/// What the walk gathers.
#[derive(Default)]
struct Walk {
    channels: Channels,
    chunks: Vec<ChunkAt>,
    /// Messages by channel, from message indices and bare messages.
    counts: BTreeMap<u16, u64>,
    /// Chunks, without runs.
    real_chunks: u64,
    /// Chunks that no message index follows, but for the last one.
    unindexed_chunks: usize,
    /// Whether the last chunk still lacks its message index.
    index_is_due: bool,
    statistics: Option<mcap::records::Statistics>,
    first_ns: Option<i64>,
    /// Whether the data section is over.
    in_summary: bool,
    /// Whether the last record belongs to the run of bare records that is the last chunk.
    in_run: bool,
}

impl Mcap {
    /// Walks the file from magic to magic. Chunks are decompressed only where nothing else tells the channels.
    pub(crate) fn open(path: &Path) -> Result<Self, ReadError> {
        let mut source = Source::open(path)?;
        source.skip(MAGIC.len() as u64, "the file's magic")?;
        let mut walk = Walk::default();
        while walk.step(&mut source)? {}
        let magic: [u8; 8] = source.array("the closing magic")?;
        if magic[..] != *MAGIC || source.at() != source.len() {
            let found = format!("{magic:02x?} and {} bytes more", source.len() - source.at());
            return Err(ReadError::bad(path, source.at() - 8, "the closing magic at the end", found, DAMAGED));
        }
        walk.check_statistics(&source)?;
        let counts = walk.settle(&source)?;
        let mut file = Mcap {
            path: path.to_owned(),
            bytes: source.len(),
            first_ns: walk.first_ns,
            topics: Vec::new(),
            channels: BTreeMap::new(),
            chunks: walk.chunks,
        };
        for (id, name, type_name, encoding) in walk.channels.iter() {
            let place = topic::place(&mut file.topics, name, type_name, encoding);
            topic::count(&mut file.topics[place], counts.as_ref().map(|counts| counts.get(&id).copied().unwrap_or(0)));
            file.channels.insert(id, place);
        }
        Ok(file)
    }

    /// The messages of the topics that are `wanted`.
    pub(crate) fn blocks(&self, wanted: &[bool]) -> Result<Box<dyn Blocks>, ReadError> {
        let topic = |place: usize| (wanted[place].then_some(place), self.topics[place].encoding);
        let channels = self.channels.iter().map(|(&id, &place)| (id, topic(place))).collect();
        let decoder = ChunkDecoder { path: self.path.clone(), channels };
        Ok(Box::new(ReadAhead::new(Source::open(&self.path)?, self.chunks.clone(), decoder)))
    }
}

impl Walk {
    /// Reads or passes over one record; false after the footer.
    fn step(&mut self, source: &mut Source) -> Result<bool, ReadError> {
        let offset = source.at();
        let (opcode, bytes) = header(source.array("a record's opcode and length")?);
        source.check(bytes, &format!("a record of opcode {opcode:#04x}"))?;
        let end = source.at() + bytes;
        let bad = |source: &Source, expected: &str, found: String| {
            ReadError::bad(source.path(), offset, expected, found, DAMAGED)
        };
        let bare = matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE) && !self.in_summary;
        if bare {
            self.extend_run(offset, RECORD_HEADER_BYTES + bytes, source.path())?;
        }
        self.in_run = bare;
        match opcode {
            0 => return Err(bad(source, "a record", "opcode 0".to_owned())),
            op::SCHEMA | op::CHANNEL | op::STATISTICS if bytes > MOST_CHUNK_BYTES => {
                return Err(bad(source, "a record of at most a gibibyte", format!("{bytes} bytes")));
            }
            op::SCHEMA | op::CHANNEL => {
                let noted = self.channels.note(opcode, &source.take(bytes, "a record")?);
                noted.map_err(|found| bad(source, "a schema or channel", found))?;
            }
            op::MESSAGE if bytes < MessageHead::BYTES as u64 => {
                return Err(bad(source, "a message of at least 22 bytes", format!("{bytes}")));
            }
            op::MESSAGE => {
                let head = MessageHead::read(&source.take(MessageHead::BYTES as u64, "a message")?);
                if let Some(head) = head {
                    *self.counts.entry(head.channel).or_default() += 1;
                    self.note_time(head.log_time_ns);
                }
            }
            op::CHUNK => self.chunk(source, end)?,
            op::MESSAGE_INDEX if bytes >= 6 => {
                let [low, high, len @ ..] = source.array::<6>("a message index")?;
                let messages = u64::from(u32::from_le_bytes(len)) / 16;
                *self.counts.entry(u16::from_le_bytes([low, high])).or_default() += messages;
                self.index_is_due = false;
            }
            op::STATISTICS => {
                match mcap::parse_record(opcode, &source.take(bytes, "statistics")?) {
                    Ok(Record::Statistics(statistics)) => self.statistics = Some(statistics),
                    other => return Err(bad(source, "statistics", format!("{:?}", other.err()))),
                };
            }
            op::DATA_END => self.in_summary = true,
            op::FOOTER if bytes == 20 => check_summary(source, offset)?,
            _ => {}
        }
        source.skip(end - source.at(), "the rest of a record")?;
        Ok(opcode != op::FOOTER)
    }

    fn note_time(&mut self, ns: i64) {
        self.first_ns = Some(self.first_ns.map_or(ns, |first| first.min(ns)));
    }

    /// Adds a bare record to the run that it continues, or begins one.
    fn extend_run(&mut self, offset: u64, bytes: u64, path: &Path) -> Result<(), ReadError> {
        match self.chunks.last_mut().filter(|run| self.in_run && run.bytes < RUN_BYTES) {
            Some(run) => {
                run.bytes += bytes;
                run.uncompressed_bytes = run.bytes;
                run.check(path)
            }
            None => {
                let run = ChunkAt { offset, bytes, uncompressed_bytes: bytes, packing: Packing::None, crc: 0 };
                run.check(path)?;
                self.chunks.push(run);
                Ok(())
            }
        }
    }

    fn chunk(&mut self, source: &mut Source, end: u64) -> Result<(), ReadError> {
        let offset = source.at();
        let bad = |source: &Source, expected: &str, found: String| {
            ReadError::bad(source.path(), offset, expected, found, DAMAGED)
        };
        let u64_field = |source: &mut Source| source.array("a chunk's head").map(u64::from_le_bytes);
        let (start_ns, end_ns, uncompressed_bytes) = (u64_field(source)?, u64_field(source)?, u64_field(source)?);
        let crc = u32::from_le_bytes(source.array("a chunk's CRC")?);
        let name_bytes = u32::from_le_bytes(source.array("a chunk's compression")?);
        if name_bytes > 64 {
            return Err(bad(
                source,
                "a chunk's compression, none, lz4 or zstd",
                format!("a name of {name_bytes} bytes"),
            ));
        }
        let name = source.take(u64::from(name_bytes), "a chunk's compression")?;
        let bytes = u64_field(source)?;
        let Some(packing) = Packing::named(&name).filter(|packing| *packing != Packing::Bz2) else {
            let found = format!("'{}'", String::from_utf8_lossy(&name));
            return Err(bad(source, "a chunk's compression, none, lz4 or zstd", found));
        };
        if source.at().checked_add(bytes).is_none_or(|data_end| data_end > end) {
            return Err(bad(source, "a chunk's data inside its record", format!("{bytes} bytes")));
        }
        let at = ChunkAt { offset: source.at(), bytes, uncompressed_bytes, packing, crc };
        at.check(source.path())?;
        self.real_chunks += 1;
        self.unindexed_chunks += usize::from(self.index_is_due);
        self.index_is_due = true;
        self.chunks.push(at);
        if (start_ns, end_ns) != (0, 0) {
            self.note_time(i64::try_from(start_ns).unwrap_or(i64::MAX));
        }
        Ok(())
    }

    /// Records of unknown opcodes are passed over, as the format demands; so a damaged opcode shows only in the statistics.
    fn check_statistics(&self, source: &Source) -> Result<(), ReadError> {
        let Some(statistics) = &self.statistics else { return Ok(()) };
        let indexed = self.unindexed_chunks == 0 && !self.index_is_due;
        let messages: u64 = self.counts.values().sum();
        let sound =
            u64::from(statistics.chunk_count) == self.real_chunks && (!indexed || statistics.message_count == messages);
        if sound {
            return Ok(());
        }
        let expected = format!(
            "{} chunks and {} messages, as its statistics say",
            statistics.chunk_count, statistics.message_count
        );
        let found = format!("{} chunks and {messages} messages in indices or bare", self.real_chunks);
        Err(ReadError::bad(source.path(), source.at(), expected, found, DAMAGED))
    }

    /// The count of messages by channel, if the file tells it; decodes every chunk where the channels are not all known.
    fn settle(&mut self, source: &Source) -> Result<Option<BTreeMap<u16, u64>>, ReadError> {
        let told = self.statistics.as_ref().map(|statistics| statistics.channel_count as usize);
        let indexed = self.unindexed_chunks == 0 && !self.index_is_due;
        let all_known = self.counts.keys().all(|&channel| self.channels.knows(channel));
        if all_known && indexed {
            return Ok(Some(std::mem::take(&mut self.counts)));
        }
        if all_known && told == Some(self.channels.len()) {
            return Ok(self.statistics.take().map(|statistics| statistics.channel_message_counts));
        }
        let mut source = Source::open(source.path())?;
        let mut counts = BTreeMap::new();
        for at in &self.chunks {
            source.seek(at.offset, "the way to a chunk")?;
            let packed = source.take(at.bytes, "a chunk")?;
            let data = at.unpack(source.path(), packed)?;
            for record in records(&data) {
                let (opcode, body) = record.map_err(|inside| cut_record(source.path(), at, inside))?;
                let body = &data[body];
                let noted = self.channels.note(opcode, body);
                noted.map_err(|f| ReadError::bad(source.path(), at.offset, "a schema or channel", f, DAMAGED))?;
                if let Some(head) = (opcode == op::MESSAGE).then(|| MessageHead::read(body)).flatten() {
                    *counts.entry(head.channel).or_default() += 1;
                }
            }
        }
        Ok(Some(counts))
    }
}

/// Checks the CRC of everything from the summary's start to the CRC itself, which ends the footer record at `footer`.
fn check_summary(source: &mut Source, footer: u64) -> Result<(), ReadError> {
    let start = u64::from_le_bytes(source.array("the footer")?);
    let _offset_start: [u8; 8] = source.array("the footer")?;
    let (end, crc) = (source.at(), u32::from_le_bytes(source.array("the footer")?));
    if crc == 0 || start == 0 {
        return Ok(());
    }
    let bad = |found: String| {
        let expected = format!("a summary with CRC-32 {crc:08x} between bytes {start} and {end}");
        Err(ReadError::bad(source.path(), footer, expected, found, DAMAGED))
    };
    if start > footer || end - start > MOST_CHUNK_BYTES {
        return bad("no such stretch".to_owned());
    }
    let mut summary = Source::open(source.path())?;
    summary.seek(start, "the summary")?;
    let found = crc32fast::hash(&summary.take(end - start, "the summary")?);
    if found == crc { Ok(()) } else { bad(format!("{found:08x}")) }
}

fn cut_record(path: &Path, at: &ChunkAt, inside: usize) -> ReadError {
    let expected = format!("a whole record {inside} bytes into the chunk's data");
    ReadError::bad(path, at.offset, expected, "one longer than the chunk", COPY_OR_SALVAGE)
}

struct ChunkDecoder {
    path: PathBuf,
    /// The topic of each channel, `None` where it is not wanted, and its encoding.
    channels: BTreeMap<u16, (Option<usize>, Encoding)>,
}

impl DecodeChunk for ChunkDecoder {
    fn decode(&self, at: &ChunkAt, packed: Vec<u8>) -> Result<Block, ReadError> {
        let bad = |expected: String, found: String| ReadError::bad(&self.path, at.offset, expected, found, DAMAGED);
        let mut bytes = at.unpack(&self.path, packed)?;
        let (mut entries, mut unpacked) = (Vec::new(), Vec::new());
        for record in records(&bytes) {
            let (opcode, body) = record.map_err(|inside| cut_record(&self.path, at, inside))?;
            if opcode != op::MESSAGE {
                continue;
            }
            let head = MessageHead::read(&bytes[body.clone()]);
            let head = head.ok_or_else(|| bad("a message of at least 22 bytes".to_owned(), body.len().to_string()))?;
            let channel = self.channels.get(&head.channel).copied();
            let unknown = || bad("a message of a known channel".to_owned(), format!("channel {}", head.channel));
            let (Some(topic), encoding) = channel.ok_or_else(unknown)? else { continue };
            let data = body.start + MessageHead::BYTES..body.end;
            let most = MOST_CHUNK_BYTES - unpacked.len() as u64;
            let plain = (encoding == Encoding::Cdr).then(|| unpack_message(&bytes[data.clone()], most)).flatten();
            let data = match plain {
                None => data,
                Some(plain) => {
                    let plain = plain.map_err(|error| bad("a zstd message".to_owned(), error.to_string()))?;
                    let start = bytes.len() + unpacked.len();
                    unpacked.extend_from_slice(&plain);
                    start..bytes.len() + unpacked.len()
                }
            };
            entries.push(Entry { topic, receive_ns: head.log_time_ns, bytes: data });
        }
        bytes.extend_from_slice(&unpacked);
        Ok(Block::in_order(bytes, entries))
    }
}
