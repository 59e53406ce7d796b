//! Chunks read and decoded ahead of their use on all cores, and handed over in order.

use super::block::Block;
use super::chunk::{ChunkAt, Packing};
use super::container::Blocks;
use super::error::ReadError;
use super::file::SharedFile;
use super::jobs::{ChunkReader, DecodeChunk, Job};
use std::collections::VecDeque;
use std::sync::Arc;

/// How much is read and unpacked ahead, and how much memory is kept to be used again: packed and unpacked bytes. A
/// chunk that is larger is read alone.
const MOST_AHEAD_BYTES: u64 = 1 << 27;
/// Small chunks are read together until they take this much: handing over a job costs some microseconds.
const JOB_BYTES: u64 = 1 << 20;

/// Chunks of a file that is being read.
///
/// Threads of rayon's pool take jobs as they come. Whoever wants the next block does jobs itself until that block is
/// there, so that reading goes on where the pool is busy, and on one thread.
pub(crate) struct ReadAhead<D> {
    reader: Arc<ChunkReader<D>>,
    chunks: VecDeque<ChunkAt>,
    /// Begun or to be begun, in order.
    jobs: VecDeque<Arc<Job>>,
    /// Blocks whose messages have been used.
    spare: Vec<Block>,
    /// What ends reading once the messages before it have been used.
    error: Option<ReadError>,
    bytes_read: u64,
    /// Whether the last block was as it stands in the file: one thread copies those as fast as several, and they are
    /// still in its cache when they are used. Messages may be packed where chunks are not.
    is_copy: bool,
}

impl<D: DecodeChunk> ReadAhead<D> {
    /// Reads `chunks` of `file`.
    pub(crate) fn new(file: SharedFile, chunks: Vec<ChunkAt>, decoder: D) -> Self {
        let reader = Arc::new(ChunkReader::new(file, decoder));
        let (jobs, spare) = (VecDeque::new(), Vec::new());
        let is_copy = chunks.first().is_some_and(|at| at.packing == Packing::None);
        Self { reader, chunks: chunks.into(), jobs, spare, error: None, bytes_read: 0, is_copy }
    }

    /// Hands out jobs while there are few enough.
    fn fill(&mut self) {
        let threads = rayon::current_num_threads();
        let most_jobs = if threads > 1 && !self.is_copy { 2 * threads } else { 1 };
        let mut ahead: u64 = self.jobs.iter().map(|job| job.bytes()).sum();
        while self.jobs.len() < most_jobs {
            let (mut count, mut bytes) = (0, 0);
            while let Some(at) = self.chunks.get(count).filter(|_| bytes < JOB_BYTES) {
                (count, bytes) = (count + 1, bytes + at.bytes_taken());
            }
            ahead += bytes;
            if count == 0 || (ahead > MOST_AHEAD_BYTES && !self.jobs.is_empty()) {
                break;
            }
            let chunks = self.chunks.drain(..count).collect();
            let job = Arc::new(Job::new(chunks, self.spare.pop().unwrap_or_default()));
            if most_jobs > 1 {
                // Jobs that nobody waits for any more are not begun.
                let (job, reader) = (Arc::downgrade(&job), self.reader.clone());
                rayon::spawn_fifo(move || {
                    let _ = job.upgrade().map(|job| job.run(&reader));
                });
            }
            self.jobs.push_back(job);
        }
    }

    /// Keeps the memory of a block, unless enough is kept.
    fn keep(&mut self, used: Block) {
        let kept: usize = self.spare.iter().map(|block| block.bytes.capacity()).sum();
        if (kept + used.bytes.capacity()) as u64 <= MOST_AHEAD_BYTES {
            self.spare.push(used);
        }
    }
}

impl<D: DecodeChunk> Blocks for ReadAhead<D> {
    fn next(&mut self, used: Block) -> Result<Option<Block>, ReadError> {
        if let Some(error) = self.error.take() {
            return Err(error);
        }
        self.keep(used);
        self.fill();
        let Some(next) = self.jobs.pop_front() else { return Ok(None) };
        next.run(&self.reader);
        let (block, read) = loop {
            if let Some(ended) = next.take() {
                break ended;
            }
            if !self.jobs.iter().any(|job| job.run(&self.reader)) {
                next.wait();
            }
        };
        self.bytes_read = next.end();
        self.is_copy = block.bytes.len() as u64 == next.packed_bytes();
        self.error = read.err();
        Ok(Some(block))
    }

    fn bytes_read(&self) -> u64 {
        self.bytes_read
    }
}
