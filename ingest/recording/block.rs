//! Blocks of messages: what a container hands over at a time.

use super::chunk::{ChunkAt, MOST_AHEAD_BYTES};
use super::error::ReadError;
use super::file::Source;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::ops::Range;

/// One message of a block.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    /// The topic's place among its part's topics.
    pub(crate) topic: usize,
    /// When the recorder got it, nanoseconds.
    pub(crate) receive_ns: i64,
    /// Its bytes in the block.
    pub(crate) bytes: Range<usize>,
}

/// The messages of a chunk, a run of records or a page of rows, in order of receive time.
#[derive(Debug, Default)]
pub(crate) struct Block {
    /// The bytes that entries point into.
    pub(crate) bytes: Vec<u8>,
    /// The messages.
    pub(crate) entries: Vec<Entry>,
}

impl Block {
    /// A block whose entries are put in order of receive time; ties keep their order.
    pub(crate) fn in_order(bytes: Vec<u8>, mut entries: Vec<Entry>) -> Self {
        entries.sort_by_key(|entry| entry.receive_ns);
        Self { bytes, entries }
    }
}

/// A container's messages, block by block.
pub(crate) trait Blocks {
    /// The next block; `None` at the end.
    fn next(&mut self) -> Result<Option<Block>, ReadError>;
    /// How much of the file is behind, in bytes.
    fn bytes_read(&self) -> u64;
}

/// Decodes one chunk's bytes as they stand in the file.
pub(crate) trait DecodeChunk: Sync {
    /// The chunk's wanted messages.
    fn decode(&self, at: &ChunkAt, bytes: Vec<u8>) -> Result<Block, ReadError>;
}

/// Chunks of a file, read in order and decoded a few at a time on all cores.
pub(crate) struct ReadAhead<D> {
    source: Source,
    chunks: VecDeque<ChunkAt>,
    decoder: D,
    ready: VecDeque<Result<Block, ReadError>>,
}

impl<D: DecodeChunk> ReadAhead<D> {
    /// Reads `chunks` of `source`.
    pub(crate) fn new(source: Source, chunks: Vec<ChunkAt>, decoder: D) -> Self {
        Self { source, chunks: chunks.into(), decoder, ready: VecDeque::new() }
    }

    fn fill(&mut self) -> Result<(), ReadError> {
        let (mut batch, mut bytes) = (Vec::new(), 0_u64);
        while batch.len() < rayon::current_num_threads().min(8) {
            let Some(at) = self.chunks.front() else { break };
            bytes = bytes.saturating_add(at.bytes).saturating_add(at.uncompressed_bytes);
            if !batch.is_empty() && bytes > MOST_AHEAD_BYTES {
                break;
            }
            let Some(at) = self.chunks.pop_front() else { break };
            self.source.seek(at.offset, "the way to a chunk")?;
            let data = self.source.take(at.bytes, "a chunk")?;
            batch.push((at, data));
        }
        let decoder = &self.decoder;
        self.ready = batch.into_par_iter().map(|(at, data)| decoder.decode(&at, data)).collect::<Vec<_>>().into();
        Ok(())
    }
}

impl<D: DecodeChunk> Blocks for ReadAhead<D> {
    fn next(&mut self) -> Result<Option<Block>, ReadError> {
        if self.ready.is_empty() {
            self.fill()?;
        }
        self.ready.pop_front().transpose()
    }

    fn bytes_read(&self) -> u64 {
        self.source.at()
    }
}
