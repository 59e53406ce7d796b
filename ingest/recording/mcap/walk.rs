//! The walk over a file's data section: chunks, message indices and bare records. Nothing is decompressed.

use super::record::{Channels, MessageHead, RECORD_HEADER_BYTES, read_header};
use crate::recording::chunk::{ChunkAt, MOST_CHUNK_BYTES, Packing};
use crate::recording::error::{DAMAGED, ReadError};
use crate::recording::file::Source;
use mcap::records::op;
use std::collections::BTreeMap;
use std::path::Path;

/// Messages outside chunks are read in runs of about this length.
const RUN_BYTES: u64 = 1 << 22;

/// What the walk over the data section found.
#[derive(Default)]
pub(super) struct Walk {
    /// Channels outside chunks.
    pub(super) channels: Channels,
    /// Chunks and runs of bare records, in order.
    pub(super) chunks: Vec<ChunkAt>,
    /// Messages by channel, from message indices and bare messages.
    pub(super) counts: BTreeMap<u16, u64>,
    /// Chunks without the runs.
    pub(super) real_chunks: u64,
    /// Chunks before the last one that no message index follows.
    unindexed_chunks: usize,
    /// Whether the last chunk still lacks its message index.
    index_is_due: bool,
    /// The earliest and the latest receive time.
    pub(super) span_ns: Option<(i64, i64)>,
    /// Whether the last record belongs to the run of bare records that is the last chunk.
    in_run: bool,
}

impl Walk {
    /// Walks from the magic to the record that ends the data section, at which `source` stands afterwards.
    pub(super) fn of_data_section(source: &mut Source) -> Result<Self, ReadError> {
        let mut walk = Self::default();
        while walk.step(source)? {}
        Ok(walk)
    }

    /// Whether a message index follows every chunk.
    pub(super) fn is_indexed(&self) -> bool {
        self.unindexed_chunks == 0 && !self.index_is_due
    }

    /// Reads or passes over one record; false before the one that ends the data section.
    fn step(&mut self, source: &mut Source) -> Result<bool, ReadError> {
        let offset = source.at();
        let (opcode, bytes) = read_header(source.array("a record's opcode and length")?);
        source.check(bytes, &format!("a record of opcode {opcode:#04x}"))?;
        let end = source.at() + bytes;
        let damaged = |source: &Source, expected: &str, found: String| {
            ReadError::unexpected(source.path(), offset, expected, found, DAMAGED)
        };
        if opcode == op::DATA_END || opcode == op::FOOTER {
            source.seek(offset, "the end of the data section")?;
            return Ok(false);
        }
        let bare = matches!(opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE);
        if bare {
            self.extend_run(offset, RECORD_HEADER_BYTES + bytes, source.path())?;
        }
        self.in_run = bare;
        match opcode {
            0 => return Err(damaged(source, "a record", "opcode 0".to_owned())),
            op::SCHEMA | op::CHANNEL if bytes > MOST_CHUNK_BYTES => {
                return Err(damaged(source, "a record of at most 1 GiB", format!("{bytes} bytes")));
            }
            op::SCHEMA | op::CHANNEL => {
                let read = self.channels.read(opcode, &source.take(bytes, "a record")?);
                read.map_err(|found| damaged(source, "a schema or channel", found))?;
            }
            op::MESSAGE if bytes < MessageHead::BYTES as u64 => {
                return Err(damaged(source, "a message of at least 22 bytes", format!("{bytes} bytes")));
            }
            op::MESSAGE => {
                let head = MessageHead::read(&source.take(MessageHead::BYTES as u64, "a message")?);
                if let Some(head) = head {
                    *self.counts.entry(head.channel).or_default() += 1;
                    self.include_time(head.log_time_ns);
                }
            }
            op::CHUNK => self.read_chunk_head(source, end)?,
            op::MESSAGE_INDEX if bytes >= 6 => {
                let [low, high, len @ ..] = source.array::<6>("a message index")?;
                let messages = u64::from(u32::from_le_bytes(len)) / 16;
                *self.counts.entry(u16::from_le_bytes([low, high])).or_default() += messages;
                self.index_is_due = false;
            }
            _ => {}
        }
        source.skip(end - source.at(), "the rest of a record")?;
        Ok(true)
    }

    fn include_time(&mut self, ns: i64) {
        self.span_ns = Some(self.span_ns.map_or((ns, ns), |(first, last)| (first.min(ns), last.max(ns))));
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

    /// Reads what stands before a chunk's data; the record ends at `end`.
    fn read_chunk_head(&mut self, source: &mut Source, end: u64) -> Result<(), ReadError> {
        let offset = source.at();
        let damaged = |source: &Source, expected: &str, found: String| {
            ReadError::unexpected(source.path(), offset, expected, found, DAMAGED)
        };
        let u64_field = |source: &mut Source| source.array("a chunk's head").map(u64::from_le_bytes);
        let (start_ns, end_ns, uncompressed_bytes) = (u64_field(source)?, u64_field(source)?, u64_field(source)?);
        let crc = u32::from_le_bytes(source.array("a chunk's CRC")?);
        let name_bytes = u32::from_le_bytes(source.array("a chunk's compression")?);
        if name_bytes > 64 {
            return Err(damaged(
                source,
                "a chunk's compression, none, lz4 or zstd",
                format!("a name of {name_bytes} bytes"),
            ));
        }
        let name = source.take(u64::from(name_bytes), "a chunk's compression")?;
        let bytes = u64_field(source)?;
        let Some(packing) = Packing::from_name(&name).filter(|packing| *packing != Packing::Bz2) else {
            return Err(ReadError::unknown_compression(source.path(), offset, &name, "none, lz4 and zstd"));
        };
        if source.at().checked_add(bytes).is_none_or(|data_end| data_end > end) {
            return Err(damaged(source, "a chunk's data inside its record", format!("{bytes} bytes")));
        }
        let at = ChunkAt { offset: source.at(), bytes, uncompressed_bytes, packing, crc };
        at.check(source.path())?;
        self.real_chunks += 1;
        self.unindexed_chunks += usize::from(self.index_is_due);
        self.index_is_due = true;
        self.chunks.push(at);
        if (start_ns, end_ns) != (0, 0) {
            self.include_time(i64::try_from(start_ns).unwrap_or(i64::MAX));
            self.include_time(i64::try_from(end_ns).unwrap_or(i64::MAX));
        }
        Ok(())
    }
}
