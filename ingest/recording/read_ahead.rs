//! Chunks read in order and decoded a few at a time on all cores.

use super::block::Block;
use super::chunk::{ChunkAt, MOST_AHEAD_BYTES};
use super::container::Blocks;
use super::error::ReadError;
use super::file::Source;
use rayon::prelude::*;
use std::collections::VecDeque;

/// Decodes chunks.
pub(crate) trait DecodeChunk: Sync {
    /// The wanted messages of a chunk, whose bytes are as they stand in the file.
    fn decode(&self, at: &ChunkAt, bytes: Vec<u8>) -> Result<Block, ReadError>;
}

/// Chunks of a file that is being read.
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

    /// Reads and decodes the next few chunks.
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
